#pragma once

#include <optional>
#include <string_view>

#include "ruche/geometry/vectors.hpp"

namespace ruche::svg {

/// x -> linear x + shift.
struct Affine {
    Mat2 linear = Mat2::Identity();
    Vec2 shift = Vec2::Zero();

    Vec2 operator*(const Vec2& point) const { return linear * point + shift; }
    /// First `inner`, then this.
    Affine operator*(const Affine& inner) const {
        return {linear * inner.linear, linear * inner.shift + shift};
    }
    bool finite() const { return linear.allFinite() && shift.allFinite(); }
};

Affine translation(const Vec2& shift);
Affine scaling(double x, double y);

/// The largest and smallest factor by which a linear map changes lengths.
struct Stretches {
    double largest = 1.0;
    double smallest = 1.0;
};
Stretches stretches(const Mat2& linear);

/// The value of a `transform` attribute or property: matrix, translate, scale, rotate, skewX, skewY, any
/// number of them; angles in degrees unless they carry a CSS unit. Empty when it is not a transform.
std::optional<Affine> parse_transform(std::string_view text);

/// A rectangle in user units.
struct Box {
    Vec2 corner = Vec2::Zero();
    Vec2 size = Vec2::Zero();
};

/// The value of a `viewBox` attribute; empty unless it is four numbers.
std::optional<Box> parse_view_box(std::string_view text);

/// Maps a view box into a viewport of the given size at the origin as `preserveAspectRatio` says ("" is
/// xMidYMid meet). Empty when that value cannot be read.
std::optional<Affine> fit_view_box(const Box& view_box, const Vec2& viewport, std::string_view aspect_ratio);

}  // namespace ruche::svg

#pragma once

#include <span>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// A circle in space, described so that a straight line is one too: it passes through `point` and bends
/// towards `inward` with `curvature`.
struct CircleFit {
    double curvature = 0.0;       ///< 1/mm, never negative; 0 for points on a line
    Vec3 point = Vec3::Zero();    ///< on the circle, near the middle one of the points
    Vec3 inward = Vec3::UnitY();  ///< unit vector at `point` towards the centre
    Vec3 normal = Vec3::UnitZ();  ///< of the circle's plane
    double rms = 0.0;             ///< root mean square distance of the points to the circle (in space), mm
    bool valid = false;           ///< false for fewer than three distinct points

    double radius() const;  ///< mm; infinite for a line
    Vec3 centre() const;    ///< not finite for a line
};

/// Least-squares circle through points in space, in any order, on an arc of any length (a full turn and
/// more). The plane is the points' principal plane; in it the geometric distances are minimised
/// (Gauss-Newton from Taubin's algebraic fit, in a parametrisation that is regular for straight lines, after
/// Chernov and Lesort 2005). Points that are not finite make the fit invalid.
CircleFit fit_circle(std::span<const Vec3> points);

/// How a fitted circle changes while its points move.
struct CircleRate {
    double curvature = 0.0;
    Vec3 centre = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
};

/// The exact derivative of `fit` = fit_circle(points) along the points' velocities, from the conditions that
/// plane and circle fulfil (implicit differentiation). For valid fits that are no lines.
CircleRate circle_rate(const CircleFit& fit, std::span<const Vec3> points, std::span<const Vec3> velocities);

}  // namespace ruche

#pragma once

#include <variant>
#include <vector>

#include "ruche/geometry/vectors.hpp"
#include "ruche/pattern/svg_transform.hpp"

namespace ruche::svg {

struct LineTo {
    Vec2 end;
};

struct CubicTo {
    Vec2 control_1, control_2, end;
};

/// A piece of an ellipse: centre + u cos(angle) + v sin(angle), angle from `start` to `start + sweep`
/// (radians). In this form an affine map of an arc is an arc again.
struct ArcTo {
    Vec2 centre, u, v;
    double start, sweep;
    Vec2 end;
};

using Segment = std::variant<LineTo, CubicTo, ArcTo>;

/// One pen-down stretch of a path, in user units.
struct Subpath {
    Vec2 start = Vec2::Zero();
    std::vector<Segment> segments;
    bool closed = false;
};

using Outline = std::vector<Subpath>;

/// SVG's end point form of an elliptical arc (SVG 1.1, appendix F.6): radii that are too small grow, and an
/// arc with a vanishing radius is a line.
struct EndpointArc {
    Vec2 from, radii;
    double rotation_deg = 0.0;
    bool large = false, positive = false;
    Vec2 to;
};
Segment arc_segment(const EndpointArc& arc);

Outline ellipse_outline(const Vec2& centre, const Vec2& radii);
/// `radii` of the corners are cut back to half the size.
Outline rectangle_outline(const Box& box, const Vec2& radii);
Outline polygon_outline(const std::vector<Vec2>& points, bool closed);

struct Flattening {
    double tolerance = 0.01;  ///< largest distance between curve and chords, after the map
    double pen_radius =
        0.0;  ///< half the stroke width, after the map: the stroke's edge keeps the tolerance too
};

/// A chain of points; consecutive ones differ by more than 1e-7, and a closed one does not repeat its first
/// point. One point alone means that the subpath has no length.
struct FlatLine {
    Polyline points;
    /// Those of the points where a smooth curve turns sharply within the tolerance: a pen rounds them
    /// whatever its joins are.
    std::vector<Vec2> tight_turns;
};

FlatLine flatten(const Subpath& subpath, const Affine& map, const Flattening& how);

}  // namespace ruche::svg

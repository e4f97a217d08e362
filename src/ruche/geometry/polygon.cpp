#include "ruche/geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <clipper.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "ruche/core/error.hpp"
#include "ruche/geometry/polyline.hpp"

namespace ruche {

namespace {

constexpr double largest_coordinate = 1e6;  // mm; well inside what Clipper's 64 bits hold exactly

ClipperLib::IntPoint to_grid(const Vec2& p) {
    // Written so that NaN fails too.
    if (!(std::abs(p.x()) <= largest_coordinate && std::abs(p.y()) <= largest_coordinate)) {
        throw InputError({}, fmt::format("the point ({}, {}) mm cannot be drawn", p.x(), p.y()),
                         fmt::format("Coordinates are finite and within {} mm of the origin; check the "
                                     "drawing's units.",
                                     largest_coordinate));
    }
    return {std::llround(p.x() * grid_per_mm), std::llround(p.y() * grid_per_mm)};
}

// Dividing (not multiplying by 1e-6) gives the double nearest to the decimal number.
Vec2 from_grid(const ClipperLib::IntPoint& p) {
    return {static_cast<double>(p.X) / grid_per_mm, static_cast<double>(p.Y) / grid_per_mm};
}

ClipperLib::Path to_path(const Polyline& line) {
    ClipperLib::Path path;
    path.reserve(line.size());
    for (const Vec2& p : line) path.push_back(to_grid(p));
    return path;
}

Polyline from_path(const ClipperLib::Path& path) {
    Polyline line;
    line.reserve(path.size());
    for (const ClipperLib::IntPoint& p : path) line.push_back(from_grid(p));
    return line;
}

ClipperLib::Paths to_paths(const Region& region) {
    ClipperLib::Paths paths;
    for (const Polygon& polygon : region) {
        paths.push_back(to_path(polygon.outer));
        for (const Polyline& hole : polygon.holes) paths.push_back(to_path(hole));
    }
    return paths;
}

// Clipper's tree alternates between outlines and holes; islands inside holes become polygons of their own.
Region to_region(const ClipperLib::PolyTree& tree) {
    Region region;
    std::vector<const ClipperLib::PolyNode*> outlines(tree.Childs.begin(), tree.Childs.end());
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        const ClipperLib::PolyNode& outline = *outlines[i];
        Polygon polygon{from_path(outline.Contour), {}};
        for (const ClipperLib::PolyNode* hole : outline.Childs) {
            if (hole->Contour.size() >= 3) polygon.holes.push_back(from_path(hole->Contour));
            outlines.insert(outlines.end(), hole->Childs.begin(), hole->Childs.end());
        }
        if (polygon.outer.size() >= 3) region.push_back(std::move(polygon));
    }
    return region;
}

Region combine(const ClipperLib::Paths& subject, const ClipperLib::Paths& clip,
               ClipperLib::ClipType operation, ClipperLib::PolyFillType fill = ClipperLib::pftNonZero) {
    ClipperLib::Clipper clipper;
    clipper.StrictlySimple(true);
    clipper.AddPaths(subject, ClipperLib::ptSubject, true);
    clipper.AddPaths(clip, ClipperLib::ptClip, true);
    ClipperLib::PolyTree tree;
    clipper.Execute(operation, tree, fill, fill);
    return to_region(tree);
}

Vec2 left_of(const Vec2& direction) { return {-direction.y(), direction.x()}; }

// Points strictly between `from` and `to` on the circle around `centre`, turning counter-clockwise by `angle`
// (negative: clockwise).
void append_arc(Polyline& out, const Vec2& centre, const Vec2& from, double angle, double tolerance) {
    const double radius = from.norm();
    const double reach = std::clamp(tolerance / radius, 1e-6, 0.5);
    const int pieces = static_cast<int>(std::ceil(std::abs(angle) / (2.0 * std::acos(1.0 - reach)) - 1e-9));
    for (int i = 1; i < pieces; ++i) {
        const double a = angle * i / pieces;
        out.emplace_back(centre + Vec2(std::cos(a) * from.x() - std::sin(a) * from.y(),
                                       std::sin(a) * from.x() + std::cos(a) * from.y()));
    }
}

/// Follows one side of a line at half the pen's width. Where the line turns towards that side the pen's edge
/// runs through the vertex itself: then every part of the outline winds once around what one segment or join
/// covers, and the union by winding number is exactly what the pen covers.
class Pen {
  public:
    explicit Pen(const StrokeStyle& style) : style_(style), half_(0.5 * style.width) {}

    void join(const Vec2& vertex, const Vec2& before, const Vec2& after) {
        const Vec2 from = -half_ * left_of(before);
        const Vec2 to = -half_ * left_of(after);
        const double sine = before.x() * after.y() - before.y() * after.x();
        const double cosine = before.dot(after);
        if (sine < 0.0 || (sine == 0.0 && cosine > 0.0)) {  // turns right: this, the right side, is inside
            outline_.insert(outline_.end(), {vertex + from, vertex, vertex + to});
            return;
        }
        // 1 / sin(half the angle between the segments) is miter length over width (SVG 2, 13.5.4).
        const double half_angle_sine = std::sqrt(std::max(0.0, 0.5 * (1.0 + cosine)));
        if (style_.join == LineJoin::miter && half_angle_sine * style_.miter_limit >= 1.0) {
            outline_.emplace_back(vertex + (from + to) / (1.0 + cosine));
            return;
        }
        outline_.emplace_back(vertex + from);
        if (style_.join == LineJoin::round) {
            append_arc(outline_, vertex, from, std::atan2(sine, cosine), style_.arc_tolerance);
        }
        outline_.emplace_back(vertex + to);
    }

    /// The end of an open line that arrives along `direction`; goes from its right to its left side.
    void cap(const Vec2& end, const Vec2& direction) {
        const Vec2 side = -half_ * left_of(direction);
        const Vec2 ahead = half_ * direction;
        outline_.emplace_back(end + side);
        if (style_.cap == LineCap::round) {
            append_arc(outline_, end, side, std::numbers::pi, style_.arc_tolerance);
        } else if (style_.cap == LineCap::square) {
            outline_.emplace_back(end + side + ahead);
            outline_.emplace_back(end - side + ahead);
        }
        outline_.emplace_back(end - side);
    }

    Polyline take() { return std::exchange(outline_, {}); }

  private:
    StrokeStyle style_;
    double half_;
    Polyline outline_;
};

// The same points without immediate repetitions; throws where Clipper would have to.
Polyline without_repetitions(const Polyline& line) {
    Polyline clean;
    for (const Vec2& p : line) {
        const Vec2 rounded = from_grid(to_grid(p));
        if (clean.empty() || clean.back() != rounded) clean.push_back(rounded);
    }
    return clean;
}

// A line without length: a dot of the cap's form, as SVG wants it.
Region dot(const Vec2& centre, const StrokeStyle& style) {
    if (style.cap == LineCap::butt) return {};
    Pen pen(style);
    pen.cap(centre, Vec2(1.0, 0.0));
    pen.cap(centre, Vec2(-1.0, 0.0));
    const Polyline outline = pen.take();
    return region_from_loops({&outline, 1}, FillRule::nonzero);
}

double loop_area(const Polyline& loop) {
    double twice = 0.0;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        const Vec2 a = loop[i] - loop[0];
        const Vec2 b = loop[i + 1] - loop[0];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
}

bool crosses_odd(const Polyline& loop, const Vec2& p) {
    bool odd = false;
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
        const Vec2& a = loop[i];
        const Vec2& b = loop[j];
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
    }
    return odd;
}

}  // namespace

Region region_from_loops(std::span<const Polyline> loops, FillRule rule) {
    ClipperLib::Paths paths;
    for (const Polyline& loop : loops) paths.push_back(to_path(loop));
    return combine(paths, {}, ClipperLib::ctUnion,
                   rule == FillRule::nonzero ? ClipperLib::pftNonZero : ClipperLib::pftEvenOdd);
}

Region unite(std::span<const Region> regions) {
    ClipperLib::Paths paths;
    for (const Region& region : regions) {
        for (ClipperLib::Path& path : to_paths(region)) paths.push_back(std::move(path));
    }
    return combine(paths, {}, ClipperLib::ctUnion);
}

Region intersect(const Region& a, const Region& b) {
    return combine(to_paths(a), to_paths(b), ClipperLib::ctIntersection);
}

Region subtract(const Region& a, const Region& b) {
    return combine(to_paths(a), to_paths(b), ClipperLib::ctDifference);
}

Region offset(const Region& region, double distance, double arc_tolerance) {
    if (!(std::abs(distance) <= largest_coordinate)) {
        throw InputError({}, fmt::format("cannot offset by {} mm", distance));
    }
    ClipperLib::ClipperOffset offsetter(2.0, std::max(arc_tolerance, 1e-6) * grid_per_mm);
    offsetter.AddPaths(to_paths(region), ClipperLib::jtRound, ClipperLib::etClosedPolygon);
    ClipperLib::Paths result;
    offsetter.Execute(result, distance * grid_per_mm);
    return combine(result, {}, ClipperLib::ctUnion);
}

Region stroke(const Polyline& line, bool closed, const StrokeStyle& style) {
    // Points much closer than the pen's own arcs are resolved add nothing but crossings inside the stroke.
    Polyline points = simplify(without_repetitions(line), closed, 0.1 * style.arc_tolerance);
    if (points.size() == 2 && points[0] == points[1]) points.pop_back();
    if (points.empty() || !(style.width > 0.0)) return {};
    if (points.size() == 1) return dot(points.front(), style);

    if (closed && points.front() == points.back()) points.pop_back();
    const int count = static_cast<int>(points.size());
    std::vector<Vec2> direction;  // of the segment from i to i + 1
    direction.reserve(points.size());
    for (int i = 0; i < count; ++i)
        direction.emplace_back((points[(i + 1) % count] - points[i]).normalized());

    Pen pen(style);
    std::vector<Polyline> loops;
    if (closed) {
        for (int i = 0; i < count; ++i) pen.join(points[i], direction[(i + count - 1) % count], direction[i]);
        loops.push_back(pen.take());
        for (int i = count - 1; i >= 0; --i) {
            pen.join(points[i], -direction[i], -direction[(i + count - 1) % count]);
        }
        loops.push_back(pen.take());
    } else {
        for (int i = 1; i + 1 < count; ++i) pen.join(points[i], direction[i - 1], direction[i]);
        pen.cap(points.back(), direction[count - 2]);
        for (int i = count - 2; i > 0; --i) pen.join(points[i], -direction[i], -direction[i - 1]);
        pen.cap(points.front(), -direction[0]);
        loops.push_back(pen.take());
    }
    return region_from_loops(loops, FillRule::nonzero);
}

Region simplify(const Region& region, double tolerance) {
    std::vector<Polyline> loops;
    for (const Polygon& polygon : region) {
        loops.push_back(simplify(polygon.outer, true, tolerance));
        for (const Polyline& hole : polygon.holes) loops.push_back(simplify(hole, true, tolerance));
    }
    return region_from_loops(loops, FillRule::nonzero);
}

double area(const Region& region) {
    double sum = 0.0;
    for (const Polygon& polygon : region) {
        sum += loop_area(polygon.outer);
        for (const Polyline& hole : polygon.holes) sum += loop_area(hole);
    }
    return sum;
}

bool contains(const Region& region, const Vec2& point) {
    bool inside = false;
    for (const Polygon& polygon : region) {
        if (crosses_odd(polygon.outer, point)) inside = !inside;
        for (const Polyline& hole : polygon.holes) {
            if (crosses_odd(hole, point)) inside = !inside;
        }
    }
    return inside;
}

double strip_width(const Polygon& polygon) {
    double half = 0.5 * length(polygon.outer, true);
    for (const Polyline& hole : polygon.holes) half += 0.5 * length(hole, true);
    // a + b = half, a b = area
    const double square = half * half - 4.0 * area({polygon});
    return 0.5 * (half - std::sqrt(std::max(0.0, square)));
}

Box bounding_box(const Region& region) {
    Box box;
    bool first = true;
    for (const Polygon& polygon : region) {
        for (const Vec2& p : polygon.outer) {
            box.low = first ? p : Vec2(box.low.cwiseMin(p));
            box.high = first ? p : Vec2(box.high.cwiseMax(p));
            first = false;
        }
    }
    return box;
}

}  // namespace ruche

#pragma once

#include <span>
#include <vector>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// A polygon with holes, mm: `outer` counter-clockwise, `holes` clockwise, none repeats its first point.
struct Polygon {
    Polyline outer;
    std::vector<Polyline> holes;
};

/// A set of polygons with disjoint interiors.
using Region = std::vector<Polygon>;

enum class FillRule { nonzero, evenodd };
enum class LineCap { butt, round, square };
enum class LineJoin { miter, round, bevel };

struct StrokeStyle {
    double width = 1.0;
    LineCap cap = LineCap::butt;
    LineJoin join = LineJoin::miter;
    double miter_limit = 4.0;
    double arc_tolerance = 0.01;  ///< largest distance between a round cap or join and its chords, mm
};

/// Boolean operations on a 1 nm grid (Clipper); results are simple polygons without slivers below the grid.
/// All throw InputError for a coordinate that is not a number or beyond 1e6 mm.
Region region_from_loops(std::span<const Polyline> loops, FillRule rule);
Region unite(std::span<const Region> regions);
Region intersect(const Region& a, const Region& b);
Region subtract(const Region& a, const Region& b);

/// Grows (distance > 0) or shrinks a region, round corners within `arc_tolerance`.
Region offset(const Region& region, double distance, double arc_tolerance = 0.01);

/// What a pen of the given style covers when it follows `line` (SVG's rules; a miter beyond the limit becomes
/// a bevel; a line without length is a dot of the cap's form). The pen follows the line within a tenth of the
/// style's arc tolerance.
Region stroke(const Polyline& line, bool closed, const StrokeStyle& style);

/// Leaves out points within `tolerance` of the remaining borders (see `simplify` of a line).
Region simplify(const Region& region, double tolerance);

double area(const Region& region);

/// Whether the point lies inside (even-odd); on a border either answer is possible.
bool contains(const Region& region, const Vec2& point);

/// Width of a strip: the shorter side of the rectangle that has the polygon's area and perimeter, or a
/// quarter of the perimeter when the polygon is too compact for one.
double strip_width(const Polygon& polygon);

/// Smallest box around all outlines.
struct Box {
    Vec2 low = {0, 0};
    Vec2 high = {0, 0};

    bool overlaps(const Box& other) const {
        return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
    }
};
Box bounding_box(const Region& region);

}  // namespace ruche

#pragma once

#include <optional>
#include <vector>

#include "ruche/geometry/polygon.hpp"

namespace ruche::svg {

/// A pen in the user units in which a stroke is defined.
struct SvgPen {
    StrokeStyle style;           ///< width in user units; arc_tolerance in mm
    std::vector<double> dashes;  ///< user units; even count, or empty: solid
    double dash_offset = 0.0;
};

/// Lines in mm and whether each is closed.
struct Lines {
    std::vector<Polyline> points;
    std::vector<bool> closed;
    std::vector<Vec2> tight_turns = {};  ///< points of the lines where every pen is round (see FlatLine)
};

/// What a pen covers, in mm.
struct Covered {
    Region region;
    bool solid_instead = false;  ///< a line has more than `most_dashes` dashes and gaps: drawn without gaps
};
inline constexpr int most_dashes = 20000;

/// What the pen covers when it follows the lines (given after the map from user units to mm whose linear part
/// is `map`, as SVG defines it: the stroke is outlined in user units and the outline is mapped). A map that
/// squashes the plane flat gives nothing.
Covered pen_cover(const Lines& lines, const Mat2& map, const SvgPen& pen);

/// The pieces of a line on which a dash pattern is on; a piece of zero length is a point twice, a hair's
/// breadth apart, to show its direction. All lengths in one unit. Empty when they are more than
/// `most_dashes`.
std::optional<Lines> dashed(const Polyline& line, bool closed, const std::vector<double>& dashes,
                            double offset);

}  // namespace ruche::svg

#pragma once

#include <vector>

#include "ruche/geometry/polygon.hpp"

namespace ruche {

/// A line along the middle of a printed region. Of an elongated one, straight or curved, it runs from end to
/// end half way between its two long sides; of a ring half way between its borders (first point repeated); of
/// a compact one through the middle. It may leave a region that is not convex: see `cut_to_region`.
Polyline midline(const Polygon& polygon);

/// The parts of lines that lie inside a region, in order; parts shorter than `shortest` (mm) are dropped.
std::vector<Polyline> cut_to_region(const std::vector<Polyline>& lines, const Region& region,
                                    double shortest = 0.05);

}  // namespace ruche

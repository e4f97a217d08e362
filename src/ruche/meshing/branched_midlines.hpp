#pragma once

#include <vector>

#include "ruche/geometry/polygon.hpp"

namespace ruche {

/// Lines along the middle of a printed region that branches: a star, a cross, a tiling. Empty when it does
/// not branch; then `midline` is the better tool.
///
/// They are the chordal axis (Prasad 1997): the midpoints of the edges inside a constrained Delaunay
/// triangulation of the border's points, which between parallel sides lie exactly half way. Branches that
/// reach less than two radii of the largest disc out of a junction are corners and left out. At junctions the
/// axis bends: there, and at the ends, lines go straight on. Two branches that go on in each other within 20
/// degrees are one line; the others run up to the middle of the junction.
std::vector<Polyline> branched_midlines(const Polygon& polygon);

/// The lines along the middle of a region whose lines nobody drew: branches where it branches, else the
/// midline of each polygon; all cut to it.
std::vector<Polyline> middle_lines(const Region& region);

}  // namespace ruche

#pragma once

#include <vector>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// Centres of the cells of a hexagonal tiling (a cell at the origin, corners along +x) within `radius`,
/// nearest first, then by angle from +x. `edge` is the tiling's edge length.
std::vector<Vec2> hexagon_centres(double edge, double radius);

/// A vertex of the tiling: its three edges run along `first_angle` and 120 and 240 degrees on.
struct TilingVertex {
    Vec2 at;
    double first_angle;  ///< radians
};
std::vector<TilingVertex> hexagon_vertices(double edge, double radius);

/// A circle as a polygon, counter-clockwise, chords within `tolerance` of it.
Polyline circle_polygon(double radius, double tolerance = 0.01);

}  // namespace ruche

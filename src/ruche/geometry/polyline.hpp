#pragma once

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// Outlines are united and cut on a grid of whole 1e-6 mm.
inline constexpr double grid_per_mm = 1e6;

double length(const Polyline& line, bool closed = false);

double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b);

/// Leaves out points so that no point is farther than `tolerance` from the chain that remains (Douglas and
/// Peucker, 1973). The ends of an open chain stay; a closed chain keeps its first point and the one farthest
/// from it, so that the same chain gives the same result.
Polyline simplify(const Polyline& line, bool closed, double tolerance);

/// `count` >= 2 points at equal distances along the chain, both ends included; of a closed chain `count`
/// points that start with the first and do not repeat it.
Polyline resample(const Polyline& line, bool closed, int count);

}  // namespace ruche

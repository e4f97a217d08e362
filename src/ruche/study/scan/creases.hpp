#pragma once

#include <vector>

#include "ruche/geometry/surface_search.hpp"

namespace ruche {

/// The edges at which a surface ends, bends by more than the angle (radians) or branches, each as a triangle
/// without width. Triangles are neighbours where their corners are the same numbers.
std::vector<Corners> creases_of(const std::vector<Corners>& surface, double angle);

}  // namespace ruche

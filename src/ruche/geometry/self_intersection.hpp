#pragma once

#include <array>
#include <span>
#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// Two triangles that pass through each other, and a point where they do.
struct Intersection {
    std::array<int, 2> triangles;  ///< the smaller number first
    Vec3 place;                    ///< mm
};

/// All pairs of triangles that pass through each other, ordered by triangle numbers: their insides meet along
/// more than a point. Pairs that share an edge are not looked at; pairs that only touch, or overlap within
/// one plane, do not count. Decided by exact arithmetic on coordinates rounded to 4e-12 of the shape's size,
/// so the answer does not depend on threads. Positions that are not finite intersect nothing.
std::vector<Intersection> find_self_intersections(std::span<const Vec3> positions,
                                                  std::span<const Triangle> triangles);

}  // namespace ruche

#pragma once

#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"

namespace ruche {

/// Principal curvatures at a vertex, 1/mm, `max >= min`. Positive when the concave side is the back (-n): an
/// outward-oriented sphere of radius R has 1/R twice.
struct VertexCurvature {
    double max = 0.0;
    double min = 0.0;

    double mean() const { return 0.5 * (max + min); }
    double gauss() const { return max * min; }
};

/// Angle-weighted unit normals per vertex; zero where no triangle of positive area meets.
std::vector<Vec3> vertex_normals(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions);

/// Curvature of a surface given by a mesh, from a quadric z = g.u + u.H.u/2 fitted by weighted least squares
/// to the second ring of neighbours in the frame of the vertex normal (the third ring and beyond where that
/// leaves fewer than eight points). The gradient is fitted too, so that an inexact normal does no harm; on
/// irregular meshes the error falls with the element size (Meek and Walton 2000, Cazals and Pouget 2005).
/// Isolated vertices and those with neighbours that are not finite get 0.
std::vector<VertexCurvature> vertex_curvatures(const std::vector<Triangle>& triangles,
                                               const std::vector<Vec3>& positions,
                                               const std::vector<Vec3>& normals);

}  // namespace ruche

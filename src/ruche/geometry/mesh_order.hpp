#pragma once

#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"

namespace ruche {

/// Order of the triangles along a Hilbert curve through their centroids: neighbours on the sheet become
/// neighbours in memory. Entry k is the old number of the triangle that becomes number k.
std::vector<int> spatial_order(const TriangleMesh& mesh);

/// The mesh with its triangles in the given order and its vertices numbered as they first appear; vertices
/// that no triangle uses are left out.
TriangleMesh reordered(const TriangleMesh& mesh, const std::vector<int>& order);

}  // namespace ruche

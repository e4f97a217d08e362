#pragma once

#include <array>
#include <functional>
#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"

namespace ruche {

/// Straight segments that meet only at their end points.
struct SegmentGraph {
    std::vector<Vec2> points;
    std::vector<std::array<int, 2>> segments;
    std::vector<bool> outline;  ///< per segment: it bounds the domain (crossing it goes in or out)
};

struct Triangulation {
    TriangleMesh mesh;       ///< of the domain; all triangles counter-clockwise, every vertex is used
    std::vector<int> piece;  ///< per triangle: the piece of the plane between segments that it is part of
    int piece_count = 0;     ///< with pieces outside the domain; piece 0 is the unbounded one
    std::vector<std::array<int, 2>> beside;  ///< per segment: the pieces on its left and on its right
};

/// Constrained Delaunay triangulation of the domain, refined (Ruppert's and Shewchuk's algorithm, by CGAL)
/// until no angle is below 20.6 degrees, except near input angles below 60 degrees, and no edge longer than
/// 1.45 `size`. Segments are only divided, never moved. Deterministic. Throws InputError when that would take
/// more than `most_triangles`; its text says where.
Triangulation triangulate(const SegmentGraph& graph, const std::function<double(const Vec2&)>& size,
                          int most_triangles);

/// The same without refinement: no further points, angles as they come.
Triangulation triangulate_coarsely(const SegmentGraph& graph);

}  // namespace ruche

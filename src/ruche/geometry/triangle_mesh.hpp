#pragma once

#include <array>
#include <vector>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

using Triangle = std::array<int, 3>;

/// The layout's triangle mesh, mm: flat, every triangle counter-clockwise seen from the front (+z, the
/// printed side).
struct TriangleMesh {
    std::vector<Vec2> vertices;
    std::vector<Triangle> triangles;

    int vertex_count() const { return static_cast<int>(vertices.size()); }
    int triangle_count() const { return static_cast<int>(triangles.size()); }
};

/// An edge and the one or two triangles on it. Seen from `triangle[0]` it runs counter-clockwise from
/// `vertex[0]` to `vertex[1]`; `local[k]` is its local index in `triangle[k]` (edge i lies opposite vertex
/// i). On the boundary `triangle[1]` and `local[1]` are -1.
struct Edge {
    std::array<int, 2> vertex;
    std::array<int, 2> triangle;
    std::array<int, 2> local;

    bool on_boundary() const { return triangle[1] < 0; }
};

/// Edges of a mesh, ordered by their first appearance, and for each triangle its three edges.
struct MeshEdges {
    std::vector<Edge> edges;
    std::vector<std::array<int, 3>> of_triangle;
};

/// Throws InputError when an edge has more than two triangles or two neighbours are oriented differently.
MeshEdges find_edges(const TriangleMesh& mesh);

/// Number of connected pieces (triangles that share a vertex belong together) and each vertex's piece; -1 for
/// a vertex that no triangle uses.
struct MeshPieces {
    int count = 0;
    std::vector<int> of_vertex;
};
MeshPieces find_pieces(const TriangleMesh& mesh);

/// Signed area of a triangle of the layout, mm^2; positive when counter-clockwise.
double layout_area(const TriangleMesh& mesh, int triangle);

/// Gradients of the three hat functions of a triangle of the layout, 1/mm; one column per corner.
Eigen::Matrix<double, 2, 3> hat_gradients(const TriangleMesh& mesh, int triangle);

}  // namespace ruche

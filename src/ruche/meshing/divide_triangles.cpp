#include "ruche/meshing/divide_triangles.hpp"

namespace ruche {

Triangulation divided(Triangulation triangulation) {
    TriangleMesh& mesh = triangulation.mesh;
    const MeshEdges edges = find_edges(mesh);
    const int vertices = mesh.vertex_count();
    for (const Edge& edge : edges.edges)
        mesh.vertices.emplace_back(0.5 * (mesh.vertices[edge.vertex[0]] + mesh.vertices[edge.vertex[1]]));
    const int triangles = mesh.triangle_count();
    for (int t = 0; t < triangles; ++t) {
        const Triangle corner = mesh.triangles[t];
        Triangle middle;  // of the edge opposite each corner
        for (int k = 0; k < 3; ++k) middle[k] = vertices + edges.of_triangle[t][k];
        mesh.triangles[t] = middle;
        for (int k = 0; k < 3; ++k) {
            mesh.triangles.push_back({corner[k], middle[(k + 2) % 3], middle[(k + 1) % 3]});
            triangulation.piece.push_back(triangulation.piece[t]);
        }
    }
    return triangulation;
}

}  // namespace ruche

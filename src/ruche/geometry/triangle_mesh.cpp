#include "ruche/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include "ruche/core/error.hpp"

namespace ruche {

MeshEdges find_edges(const TriangleMesh& mesh) {
    MeshEdges result;
    result.of_triangle.resize(mesh.triangles.size());
    result.edges.reserve(mesh.triangles.size() * 3 / 2 + 16);
    std::unordered_map<std::uint64_t, int> known;
    known.reserve(mesh.triangles.size() * 2);
    const auto fail = [](int a, int b, const char* what) {
        throw InputError(
            {.key = "mesh edge " + std::to_string(a) + "-" + std::to_string(b)}, what,
            "A printed sheet is an oriented surface: at most two triangles meet at an edge, both "
            "counter-clockwise.");
    };
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& tri = mesh.triangles[t];
        for (int i = 0; i < 3; ++i) {
            const int a = tri[(i + 1) % 3];
            const int b = tri[(i + 2) % 3];
            const auto key = static_cast<std::uint64_t>(std::min(a, b)) << 32U |
                             static_cast<std::uint64_t>(std::max(a, b));
            const auto [entry, is_new] = known.try_emplace(key, static_cast<int>(result.edges.size()));
            if (is_new) {
                result.edges.push_back({{a, b}, {t, -1}, {i, -1}});
            } else {
                Edge& edge = result.edges[entry->second];
                if (!edge.on_boundary()) fail(a, b, "more than two triangles share this edge");
                if (edge.vertex[0] != b) fail(a, b, "its two triangles are oriented differently");
                edge.triangle[1] = t;
                edge.local[1] = i;
            }
            result.of_triangle[t][i] = entry->second;
        }
    }
    return result;
}

MeshPieces find_pieces(const TriangleMesh& mesh) {
    std::vector<int> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    std::vector<char> used(mesh.vertices.size(), 0);
    for (const Triangle& tri : mesh.triangles) {
        for (const int v : tri) used[v] = 1;
        parent[root(tri[1])] = root(tri[0]);
        parent[root(tri[2])] = root(tri[0]);
    }
    MeshPieces pieces;
    pieces.of_vertex.assign(mesh.vertices.size(), -1);
    std::vector<int> number(mesh.vertices.size(), -1);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (!used[v]) continue;
        int& piece = number[root(v)];
        if (piece < 0) piece = pieces.count++;
        pieces.of_vertex[v] = piece;
    }
    return pieces;
}

double layout_area(const TriangleMesh& mesh, int triangle) {
    const Triangle& tri = mesh.triangles[triangle];
    const Vec2 e1 = mesh.vertices[tri[1]] - mesh.vertices[tri[0]];
    const Vec2 e2 = mesh.vertices[tri[2]] - mesh.vertices[tri[0]];
    return 0.5 * (e1.x() * e2.y() - e1.y() * e2.x());
}

Eigen::Matrix<double, 2, 3> hat_gradients(const TriangleMesh& mesh, int triangle) {
    const Triangle& tri = mesh.triangles[triangle];
    const double twice_area = 2.0 * layout_area(mesh, triangle);
    Eigen::Matrix<double, 2, 3> gradients;
    for (int i = 0; i < 3; ++i) {
        // The opposite edge, turned by a quarter to the left.
        const Vec2 edge = mesh.vertices[tri[(i + 2) % 3]] - mesh.vertices[tri[(i + 1) % 3]];
        gradients.col(i) = Vec2(-edge.y(), edge.x()) / twice_area;
    }
    return gradients;
}

}  // namespace ruche

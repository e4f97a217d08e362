#include "ruche/statics/bending_places.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ruche {
namespace {

/// An edge between two triangles, and by how much a step turns them against each other (squared, rad^2).
struct BentEdge {
    double bend;
    int edge;
};

/// The edges that take nearly all of the bending, when few do.
std::vector<BentEdge> most_bent(const MeshEdges& mesh, std::span<const Vec3> spins) {
    constexpr double few = 0.005;       // of all edges
    constexpr double nearly_all = 0.8;  // of the sum of squares: on the few
    constexpr double all = 0.99;        // that is enough
    constexpr double hardly = 0.01;     // rad
    std::vector<BentEdge> bent;
    bent.reserve(mesh.edges.size());
    for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e) {
        const Edge& edge = mesh.edges[e];
        if (!edge.on_boundary())
            bent.push_back({(spins[edge.triangle[0]] - spins[edge.triangle[1]]).squaredNorm(), e});
    }
    const auto add = [](double sum, const BentEdge& edge) { return sum + edge.bend; };
    const double total = std::accumulate(bent.begin(), bent.end(), 0.0, add);
    const auto count = static_cast<std::ptrdiff_t>(few * static_cast<double>(bent.size()));
    std::partial_sort(bent.begin(), bent.begin() + count, bent.end(),
                      [](const BentEdge& a, const BentEdge& b) {
                          return a.bend != b.bend ? a.bend > b.bend : a.edge < b.edge;
                      });
    bent.resize(count);
    if (bent.empty() || !(bent.front().bend > hardly * hardly)) return {};
    double sum = 0.0;
    for (std::size_t i = 0; i < bent.size(); ++i) {
        sum += bent[i].bend;
        if (sum > all * total) {
            bent.resize(i + 1);
            break;
        }
    }
    if (!(sum > nearly_all * total)) bent.clear();
    return bent;
}

}  // namespace

std::vector<std::vector<int>> bending_places(const Model& model, std::span<const char> held,
                                             std::span<const Vec3> spins) {
    constexpr int rings = 4;
    constexpr double most = 0.4;  // of the vertices: more is no matter of places
    const TriangleMesh& mesh = model.input().mesh;
    std::vector<char> inside(mesh.vertices.size(), 0);
    for (const BentEdge& bent : most_bent(model.edges(), spins)) {
        for (const int v : model.edges().edges[bent.edge].vertex) inside[v] = 1;
    }
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<char> next = inside;
        for (const Triangle& t : mesh.triangles) {
            if (inside[t[0]] == 0 && inside[t[1]] == 0 && inside[t[2]] == 0) continue;
            for (const int v : t) next[v] = 1;
        }
        inside = std::move(next);
    }
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (held[3 * v] != 0 || held[3 * v + 1] != 0 || held[3 * v + 2] != 0) inside[v] = 0;
    }
    if (static_cast<double>(std::count(inside.begin(), inside.end(), 1)) > most * mesh.vertex_count())
        return {};

    // Vertices of one triangle belong to one place: its energy depends on all of them.
    std::vector<int> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const Triangle& t : mesh.triangles) {
        for (const int v : t) {
            for (const int other : t) {
                if (inside[v] != 0 && inside[other] != 0) parent[root(v)] = root(other);
            }
        }
    }
    std::vector<int> number(mesh.vertices.size(), -1);
    std::vector<std::vector<int>> places;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (inside[v] == 0) continue;
        int& place = number[root(v)];
        if (place < 0) {
            place = static_cast<int>(places.size());
            places.emplace_back();
        }
        places[place].push_back(v);
    }
    return places;
}

}  // namespace ruche

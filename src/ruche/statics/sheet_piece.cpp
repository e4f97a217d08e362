#include "ruche/statics/sheet_piece.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace ruche {
namespace {

/// What is cut out around free vertices. Vertices and triangles keep their order, so that edges keep their
/// directions.
struct Cut {
    std::vector<int> vertices;
    std::vector<int> place;  // per vertex of the whole sheet: among `vertices`, or -1
    std::vector<int> triangles;
    std::vector<char> free;  // per vertex of the whole sheet
};

bool touches(const Triangle& triangle, const std::vector<char>& flags) {
    return std::any_of(triangle.begin(), triangle.end(), [&](int v) { return flags[v] != 0; });
}

/// The triangles at free vertices and all that touch those: an element feels the vertices across its edges.
Cut cut_around(const TriangleMesh& mesh, std::span<const int> vertices) {
    Cut cut;
    cut.free.assign(mesh.vertices.size(), 0);
    for (const int v : vertices) cut.free[v] = 1;
    std::vector<char> near = cut.free;
    for (const Triangle& triangle : mesh.triangles) {
        if (!touches(triangle, cut.free)) continue;
        for (const int v : triangle) near[v] = 1;
    }
    cut.place.assign(mesh.vertices.size(), -1);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        if (!touches(mesh.triangles[t], near)) continue;
        cut.triangles.push_back(t);
        for (const int v : mesh.triangles[t]) cut.place[v] = 0;
    }
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (cut.place[v] < 0) continue;
        cut.place[v] = static_cast<int>(cut.vertices.size());
        cut.vertices.push_back(v);
    }
    return cut;
}

ModelInput part_of(const ModelInput& whole, const Cut& cut, const Eigen::VectorXd& x) {
    ModelInput piece;
    piece.material = whole.material;
    piece.prestretch = whole.prestretch;
    piece.fabric_axis_deg = whole.fabric_axis_deg;
    piece.gravity = whole.gravity;
    piece.table = whole.table;
    piece.options = whole.options;
    for (const int v : cut.vertices) {
        piece.mesh.vertices.push_back(whole.mesh.vertices[v]);
        if (cut.free[v] == 0)
            piece.supports.push_back(
                {.vertex = cut.place[v], .at = x.segment<3>(3 * static_cast<Eigen::Index>(v))});
    }
    for (const int t : cut.triangles) {
        const Triangle& v = whole.mesh.triangles[t];
        piece.mesh.triangles.push_back({cut.place[v[0]], cut.place[v[1]], cut.place[v[2]]});
        if (!whole.print.empty()) piece.print.push_back(whole.print[t]);
    }
    for (const NodalForce& force : whole.forces) {
        if (cut.free[force.vertex] != 0) piece.forces.push_back({cut.place[force.vertex], force.force});
    }
    return piece;
}

}  // namespace

SheetPiece cut_out(const Model& whole, std::span<const int> vertices, const Eigen::VectorXd& x) {
    const Cut cut = cut_around(whole.input().mesh, vertices);
    SheetPiece piece{Model(part_of(whole.input(), cut, x)), {}, {}};
    for (const int v : cut.vertices) {
        for (int c = 0; c < 3; ++c) {
            piece.unknowns.push_back(3 * v + c);
            piece.held.push_back(cut.free[v] != 0 ? 0 : 1);
        }
    }
    std::map<std::pair<int, int>, int> unknown_of_edge;
    const NodePattern& pattern = whole.pattern();
    for (int node = whole.vertex_count(); node < pattern.node_count(); ++node) {
        const std::array<int, 4> around = whole.vertices_of_edge_unknown(node - whole.vertex_count());
        if (cut.place[around[0]] >= 0 && cut.place[around[1]] >= 0)
            unknown_of_edge[std::minmax(around[0], around[1])] = pattern.first_unknown(node);
    }
    const int edge_unknowns = piece.model.pattern().node_count() - piece.model.vertex_count();
    for (int k = 0; k < edge_unknowns; ++k) {
        std::array<int, 4> around = piece.model.vertices_of_edge_unknown(k);
        for (int& v : around) v = cut.vertices[v];
        piece.unknowns.push_back(unknown_of_edge.at(std::minmax(around[0], around[1])));
        const bool feels = std::any_of(around.begin(), around.end(), [&](int v) { return cut.free[v] != 0; });
        piece.held.push_back(feels ? 0 : 1);
    }
    return piece;
}

Eigen::VectorXd SheetPiece::take(const Eigen::VectorXd& whole) const {
    Eigen::VectorXd piece(static_cast<Eigen::Index>(unknowns.size()));
    for (std::size_t i = 0; i < unknowns.size(); ++i)
        piece[static_cast<Eigen::Index>(i)] = whole[unknowns[i]];
    return piece;
}

void SheetPiece::place(const Eigen::VectorXd& piece, Eigen::VectorXd& whole) const {
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
        if (held[i] == 0) whole[unknowns[i]] = piece[static_cast<Eigen::Index>(i)];
    }
}

}  // namespace ruche

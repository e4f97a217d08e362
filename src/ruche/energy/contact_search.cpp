#include "ruche/energy/contact_search.hpp"

#include <algorithm>

#include "ruche/core/parallel.hpp"
#include "ruche/geometry/box_tree.hpp"

namespace ruche {
namespace {

using PairBox = AxisBox<double>;

void add(PairBox& box, const Vec3& p) { box.add(PairBox::Point{p.x(), p.y(), p.z()}); }

void inflate(PairBox& box, double by) {
    for (int k = 0; k < 3; ++k) {
        box.low[k] -= by;
        box.high[k] += by;
    }
}

/// Triangles whose work is done by one thread in one go.
constexpr std::size_t chunk = 256;
std::size_t chunks(std::size_t triangles) { return (triangles + chunk - 1) / chunk; }

bool share(const std::array<int, 4>& vertices, int first, int corners) {
    return std::any_of(vertices.begin(), vertices.begin() + first, [&](int v) {
        return std::find(vertices.begin() + first, vertices.begin() + corners, v) !=
               vertices.begin() + corners;
    });
}

}  // namespace

struct ContactSearch::Parts {
    TriangleMesh mesh;
    MeshEdges edges;
    double distance = 0.0;
    double stretch = 1.0;

    std::vector<Vec3> layout;
    std::vector<double> vertex_area, edge_area;  // mm^2 of layout; each adds up to the sheet's
    std::vector<std::vector<int>> triangles_of_vertex;
    std::vector<char> on_border;                          // per vertex
    std::vector<std::vector<int>> vertices_of, edges_of;  // per triangle: those that are its own, each once

    Parts(const TriangleMesh& of, const MeshEdges& with, double longest_reach, double prestretch);

    template <class Visit>
    void for_each_pair(int t, int u, const Visit& visit) const;
    template <class Use>
    void for_each_neighbour(std::vector<PairBox> boxes, const Use& use) const;

    ContactPair vertex_triangle(int v, int t) const {
        const Triangle& tri = mesh.triangles[t];
        return {PairKind::vertex_triangle, {v, tri[0], tri[1], tri[2]}};
    }
    PairCorners in_layout(const ContactPair& pair) const {
        PairCorners at;
        for (int i = 0; i < corner_count(pair.kind); ++i) at[i] = layout[pair.vertices[i]];
        return at;
    }
    double reach_in_layout(const ContactPair& pair, double longest) const {
        return std::min(longest, ruche::distance(pair.kind, in_layout(pair)) / (4.0 * stretch));
    }
    double vertex_reach(int v, const std::vector<int>& triangles) const;
};

ContactSearch::Parts::Parts(const TriangleMesh& of, const MeshEdges& with, double longest_reach,
                            double prestretch)
    : mesh(of),
      edges(with),
      distance(longest_reach),
      stretch(prestretch),
      vertex_area(of.vertices.size(), 0.0),
      edge_area(with.edges.size(), 0.0),
      triangles_of_vertex(of.vertices.size()),
      on_border(of.vertices.size(), 0),
      vertices_of(of.triangles.size()),
      edges_of(of.triangles.size()) {
    for (const Vec2& p : mesh.vertices) layout.emplace_back(p.x(), p.y(), 0.0);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const double third = layout_area(mesh, t) / 3.0;
        for (int i = 0; i < 3; ++i) {
            const int v = mesh.triangles[t][i];
            if (triangles_of_vertex[v].empty()) vertices_of[t].push_back(v);
            triangles_of_vertex[v].push_back(t);
            vertex_area[v] += third;
            edge_area[edges.of_triangle[t][i]] += third;
        }
    }
    for (int e = 0; e < static_cast<int>(edges.edges.size()); ++e) {
        const Edge& edge = edges.edges[e];
        edges_of[edge.triangle[0]].push_back(e);
        if (edge.on_boundary()) on_border[edge.vertex[0]] = on_border[edge.vertex[1]] = 1;
    }
}

/// The same for an edge or a vertex as for any triangle at it, or nothing would cancel.
double ContactSearch::Parts::vertex_reach(int v, const std::vector<int>& triangles) const {
    double reach = distance;
    for (const int t : triangles) {
        if (std::ranges::find(mesh.triangles[t], v) != mesh.triangles[t].end()) return 0.0;
        reach = std::min(reach, reach_in_layout(vertex_triangle(v, t), distance));
    }
    return reach;
}

/// Calls visit(pair, reach()) for every pair of parts of which one is t's own and the other u's, or u itself.
template <class Visit>
void ContactSearch::Parts::for_each_pair(int t, int u, const Visit& visit) const {
    for (const auto& [own, other] : {std::pair{t, u}, std::pair{u, t}}) {
        for (const int v : vertices_of[own]) {
            ContactPair face = vertex_triangle(v, other);
            face.area = 0.5 * vertex_area[v];
            if (!share(face.vertices, 1, 4)) visit(face, [&] { return reach_in_layout(face, distance); });
            for (const int e : edges_of[other]) {
                const Edge& edge = edges.edges[e];
                if (edge.on_boundary() || edge.vertex[0] == v || edge.vertex[1] == v) continue;
                visit(
                    ContactPair{
                        PairKind::vertex_edge, {v, edge.vertex[0], edge.vertex[1], -1}, 0.0, -face.area},
                    [&] {
                        return vertex_reach(v, {edge.triangle[0], edge.triangle[1]});
                    });
            }
            for (const int w : vertices_of[other]) {
                if (on_border[w]) continue;
                visit(ContactPair{PairKind::vertex_vertex, {v, w, -1, -1}, 0.0, face.area},
                      [&] { return vertex_reach(v, triangles_of_vertex[w]); });
            }
        }
    }
    for (const int e : edges_of[t]) {
        for (const int f : edges_of[u]) {
            const auto& a = edges.edges[e].vertex;
            const auto& b = edges.edges[f].vertex;
            ContactPair pair{PairKind::edge_edge, {a[0], a[1], b[0], b[1]}};
            if (share(pair.vertices, 2, 4)) continue;
            pair.area = 0.25 * (edge_area[e] + edge_area[f]);
            constexpr double nearly = 1e-3;  // squared sine
            pair.parallel = nearly * (layout[a[1]] - layout[a[0]]).squaredNorm() *
                            (layout[b[1]] - layout[b[0]]).squaredNorm();
            visit(pair, [&] { return reach_in_layout(pair, 0.5 * distance); });
        }
    }
}

/// Calls use(chunk, t, u) for all triangles t < u whose boxes meet, in parallel over chunks.
template <class Use>
void ContactSearch::Parts::for_each_neighbour(std::vector<PairBox> boxes, const Use& use) const {
    const BoxTree<double> tree(std::move(boxes));
    const std::vector<int>& order = tree.order();
    parallel_for(chunks(order.size()), [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(order.size(), (c + 1) * chunk); ++i)
            tree.later_neighbours(order[i], [&](int u) { use(c, order[i], u); });
    });
}

ContactSearch::ContactSearch(const TriangleMesh& mesh, const MeshEdges& edges, double distance,
                             double stretch)
    : parts_(std::make_unique<const Parts>(mesh, edges, distance, stretch)) {}
ContactSearch::~ContactSearch() = default;

std::vector<ContactPair> ContactSearch::pairs(const Eigen::VectorXd& x, double margin) const {
    const Parts& p = *parts_;
    const Unknowns at{x.data(), p.mesh.vertex_count()};
    std::vector<PairBox> boxes(p.mesh.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        for (const int v : p.mesh.triangles[t]) add(boxes[t], at.position(v));
        inflate(boxes[t], 0.5 * margin * p.distance);
    }
    std::vector<std::vector<ContactPair>> found(chunks(boxes.size()));
    p.for_each_neighbour(std::move(boxes), [&](std::size_t c, int t, int u) {
        p.for_each_pair(t, u, [&](const ContactPair& pair, const auto& reach) {
            const double d = distance(pair.kind, corners(pair, at));
            if (!(d < margin * p.distance)) return;
            ContactPair near = pair;
            near.reach = reach();
            if (d < margin * near.reach) found[c].push_back(near);
        });
    });
    std::vector<ContactPair> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::ranges::sort(all, in_order);
    return all;
}

double ContactSearch::clear_fraction(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const {
    constexpr double share_left = 0.2;
    const Parts& p = *parts_;
    const Unknowns from{x.data(), p.mesh.vertex_count()};
    const Unknowns to{y.data(), p.mesh.vertex_count()};
    std::vector<PairBox> boxes(p.mesh.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        for (const int v : p.mesh.triangles[t]) {
            add(boxes[t], from.position(v));
            add(boxes[t], to.position(v));
        }
        inflate(boxes[t], 0.5 * share_left * p.distance);
    }
    std::vector<double> fraction(chunks(boxes.size()), 1.0);
    p.for_each_neighbour(std::move(boxes), [&](std::size_t c, int t, int u) {
        p.for_each_pair(t, u, [&](const ContactPair& pair, const auto& reach) {
            // Edges and vertices of a triangle are no obstacles of their own.
            if (pair.kind == PairKind::vertex_edge || pair.kind == PairKind::vertex_vertex) return;
            const PairCorners begin = corners(pair, from);
            const PairCorners end = corners(pair, to);
            const double now = distance(pair.kind, begin);
            const auto fraction_for = [&](double longest) {
                return ruche::clear_fraction(pair.kind, begin, end, share_left * std::min(now, longest));
            };
            // The pair's own reach takes longer to find than what most pairs are told by already.
            if (fraction_for(p.distance) < 1.0) fraction[c] = std::min(fraction[c], fraction_for(reach()));
        });
    });
    return fraction.empty() ? 1.0 : *std::ranges::min_element(fraction);
}

}  // namespace ruche

#include "ruche/output/relief.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ruche/output/curvature.hpp"

namespace ruche {
namespace {

/// The sheet cut apart wherever its height changes: a vertex becomes as many nodes as it has fans of
/// triangles of one height around it.
struct Patches {
    std::vector<Triangle> triangles;      ///< of nodes, only the raised ones; counter-clockwise from `side`
    std::vector<double> height;           ///< per raised triangle
    std::vector<int> source;              ///< per raised triangle: its number in the mesh
    std::vector<int> vertex;              ///< per node
    std::vector<std::array<int, 2>> rim;  ///< border edges of patches, nodes; the patch lies to the left
    std::vector<int> rim_source;          ///< per border edge: the triangle it bounds
};

bool usable(const Triangle& t, const std::vector<Vec3>& shape) {
    const double area = (shape[t[1]] - shape[t[0]]).cross(shape[t[2]] - shape[t[0]]).norm();
    return std::isfinite(area) && area > 0.0;
}

Patches cut_apart(const TriangleMesh& mesh, const std::vector<Vec3>& shape, std::span<const double> height,
                  Side side) {
    const auto raised = [&](int t) { return height[t] > 0.0 && usable(mesh.triangles[t], shape); };
    std::vector<int> parent(mesh.triangles.size() * 3);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int corner) {
        while (parent[corner] != corner) corner = parent[corner] = parent[parent[corner]];
        return corner;
    };
    struct RimEdge {
        int triangle;
        int local;
    };
    std::vector<RimEdge> rim;
    for (const Edge& edge : find_edges(mesh).edges) {
        const auto [t, o] = edge.triangle;
        const auto [i, j] = edge.local;
        const bool here = raised(t);
        const bool there = o >= 0 && raised(o);
        if (here && there && height[t] == height[o]) {
            // The edge runs from corner i+1 to i+2 of one triangle, the other way round in the other.
            parent[root(3 * t + (i + 1) % 3)] = root(3 * o + (j + 2) % 3);
            parent[root(3 * t + (i + 2) % 3)] = root(3 * o + (j + 1) % 3);
        } else {
            if (here) rim.push_back({t, i});
            if (there) rim.push_back({o, j});
        }
    }
    Patches patches;
    std::vector<int> node(parent.size(), -1);
    const auto node_of = [&](int corner, int v) {
        int& n = node[root(corner)];
        if (n < 0) {
            n = static_cast<int>(patches.vertex.size());
            patches.vertex.push_back(v);
        }
        return n;
    };
    const int second = side == Side::front ? 1 : 2;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        if (!raised(t)) continue;
        const Triangle& tri = mesh.triangles[t];
        const Triangle nodes = {node_of(3 * t, tri[0]), node_of(3 * t + 1, tri[1]),
                                node_of(3 * t + 2, tri[2])};
        patches.triangles.push_back({nodes[0], nodes[second], nodes[3 - second]});
        patches.height.push_back(height[t]);
        patches.source.push_back(t);
    }
    for (const RimEdge& e : rim) {
        const int a = node[root(3 * e.triangle + (e.local + second) % 3)];
        const int b = node[root(3 * e.triangle + (e.local + 3 - second) % 3)];
        patches.rim.push_back({a, b});
        patches.rim_source.push_back(e.triangle);
    }
    return patches;
}

/// What the rim needs to know at each node: the way out of the patch, and how far it may be rounded.
struct RimFrame {
    std::vector<Vec3> outwards;  ///< in the tangent plane; zero inside; longer than 1 at corners
    std::vector<double> room;    ///< smallest altitude of the triangles around, mm
    std::vector<double> height;  ///< mm
};

RimFrame rim_frame(const Patches& patches, const std::vector<Vec3>& position,
                   const std::vector<Vec3>& normal) {
    RimFrame frame;
    frame.outwards.assign(position.size(), Vec3::Zero());
    frame.room.assign(position.size(), std::numeric_limits<double>::infinity());
    frame.height.assign(position.size(), 0.0);
    for (std::size_t t = 0; t < patches.triangles.size(); ++t) {
        const Triangle& tri = patches.triangles[t];
        const Vec3 a = position[tri[1]] - position[tri[0]];
        const Vec3 b = position[tri[2]] - position[tri[0]];
        const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
        for (const int n : tri) {
            frame.room[n] = std::min(frame.room[n], a.cross(b).norm() / longest);
            frame.height[n] = patches.height[t];
        }
    }
    for (const auto& [a, b] : patches.rim) {
        const Vec3 along = position[b] - position[a];
        for (const int n : {a, b}) {
            const Vec3 out = along.cross(normal[n]);
            if (out.norm() > 0.0) frame.outwards[n] += out.normalized();
        }
    }
    for (std::size_t n = 0; n < position.size(); ++n) {
        const double length = frame.outwards[n].norm();
        // Two unit vectors at an angle add up to 2 cos(half); the mitre between them is 1/cos(half) long.
        if (length > 1e-6) frame.outwards[n] *= std::min(2.0 / (length * length), 1.5 / length);
    }
    return frame;
}

}  // namespace

Relief raise(const TriangleMesh& mesh, const std::vector<Vec3>& shape, std::span<const double> height,
             const ReliefOptions& options) {
    const Patches patches = cut_apart(mesh, shape, height, options.side);
    const std::size_t nodes = patches.vertex.size();
    std::vector<Vec3> position(nodes);
    for (std::size_t n = 0; n < nodes; ++n) position[n] = shape[patches.vertex[n]];
    const std::vector<Vec3> normal = vertex_normals(patches.triangles, position);
    const RimFrame frame = rim_frame(patches, position, normal);

    Relief relief;
    const auto add = [&](std::size_t n, const Vec3& at, const Vec3& facing) {
        relief.positions.push_back(at);
        relief.normals.push_back(facing);
        relief.layout.push_back(mesh.vertices[patches.vertex[n]]);
        return static_cast<int>(relief.positions.size()) - 1;
    };
    const auto radius = [&](std::size_t n) {
        return std::min({options.rounding, frame.height[n] - options.base, 0.4 * frame.room[n]});
    };
    for (std::size_t n = 0; n < nodes; ++n)
        add(n, position[n] + frame.height[n] * normal[n] - radius(n) * frame.outwards[n], normal[n]);
    relief.triangles = patches.triangles;
    relief.source = patches.source;

    // Each rim node carries a chain of points from the cover down to the base.
    const int segments = std::max(1, options.segments);
    std::vector<int> chain(nodes, -1);
    const auto chain_of = [&](int n) {
        if (chain[n] >= 0) return chain[n];
        const Vec3& out = frame.outwards[n];
        const Vec3 facing = out.norm() > 0.0 ? Vec3(out.normalized()) : normal[n];
        const double r = radius(n);
        chain[n] = static_cast<int>(relief.positions.size());
        for (int k = 0; k <= segments; ++k) {
            const double angle = 1.5707963267948966 * k / segments;
            const double up = frame.height[n] - r + r * std::cos(angle);
            const Vec3 towards =
                options.segments > 0 ? Vec3(std::cos(angle) * normal[n] + std::sin(angle) * facing) : facing;
            add(n, position[n] + up * normal[n] - (r - r * std::sin(angle)) * out, towards);
        }
        add(n, position[n] + options.base * normal[n], facing);
        return chain[n];
    };
    for (std::size_t e = 0; e < patches.rim.size(); ++e) {
        const int from = chain_of(patches.rim[e][0]), to = chain_of(patches.rim[e][1]);
        relief.source.insert(relief.source.end(), 2 * (segments + 1), patches.rim_source[e]);
        for (int k = 0; k <= segments; ++k) {
            relief.triangles.push_back({from + k, from + k + 1, to + k});
            relief.triangles.push_back({to + k, from + k + 1, to + k + 1});
        }
    }
    return relief;
}

}  // namespace ruche

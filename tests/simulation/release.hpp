#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ruche/meshing/structured.hpp"
#include "ruche/output/metrics.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche::test {

/// A sheet that is printed wherever `thickness(x, y)` is not 0 (negative: on the back); one strip id per
/// sheet.
inline PrintMesh printed(TriangleMesh mesh, const std::function<double(const Vec2&)>& thickness) {
    PrintMesh layout;
    layout.mesh = std::move(mesh);
    for (const Triangle& tri : layout.mesh.triangles) {
        const Vec2 centre =
            (layout.mesh.vertices[tri[0]] + layout.mesh.vertices[tri[1]] + layout.mesh.vertices[tri[2]]) /
            3.0;
        const double h = thickness(centre);
        layout.print.push_back({.front = std::max(0.0, h), .back = std::max(0.0, -h)});
        layout.strip.push_back({.front = h > 0.0 ? 0 : -1, .back = h < 0.0 ? 0 : -1});
    }
    return layout;
}

/// Gives the sheet a strip with the centre line from `a` to `b`.
inline void add_strip(PrintMesh& layout, const std::string& id, const Vec2& a, const Vec2& b) {
    layout.strips.push_back({.id = id, .centreline = {points_on_mesh(layout.mesh, {a, b}, 121)}});
}

inline std::vector<Vec3> positions(const Equilibrium& state, const PrintMesh& layout) {
    std::vector<Vec3> shape;
    for (int v = 0; v < layout.mesh.vertex_count(); ++v) shape.emplace_back(state.x.segment<3>(3 * v));
    return shape;
}

inline Equilibrium release(const PrintMesh& layout, ModelInput input = {}, const SolveOptions& options = {}) {
    input.mesh = layout.mesh;
    input.print = layout.print;
    return solve(Model(std::move(input)), options);
}

inline bool certain(const Equilibrium& state) {
    return state.status == SolveStatus::converged && state.stable;
}

}  // namespace ruche::test

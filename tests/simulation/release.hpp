#pragma once

#include <cmath>
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

/// Timoshenko's bimetal for plies of true thickness (van Rees 2017 energy): curvature of a narrow strip,
/// 1/mm.
inline double bimetal_curvature(const Material& m, double s, double tp) {
    const double p = m.plastic_youngs_modulus;
    const double q = m.fabric_youngs_modulus * s * s;
    const double tf = m.fabric_thickness;
    const double e = (s * s - 1.0) / (2.0 * s * s);
    const double b = 6.0 * p * q * tp * tf * (tp + tf) * e /
                     (q * q * std::pow(tf, 4) + p * p * std::pow(tp, 4) +
                      2.0 * p * q * tf * tp * (2.0 * tf * tf + 3.0 * tf * tp + 2.0 * tp * tp));
    // a* minimises the energy for this b: sum of E sqrt(det) (t (a - rest)/rest^2 / ... ) is linear in a.
    const double fabric_rest = 1.0 / (s * s);
    // Membrane equilibrium: P tp (a - 1) - P tp^2 b + q' tf (a - rest) + q' tf^2 b = 0 with q' = E_f s^2.
    const double a =
        (p * tp + q * tf * fabric_rest + p * tp * tp * (-b) - q * tf * tf * (-b)) / (p * tp + q * tf);
    return b / a;
}

}  // namespace ruche::test

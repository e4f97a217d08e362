#include "ruche/study/scan/skin.hpp"

#include <algorithm>

namespace ruche {
namespace {

/// How much of the fabric lies on the front of the reference surface, 0 to 1: the fabric lies behind a print
/// on the front, before one on the back, half and half with one on each.
double fabric_in_front(const Print& print) {
    if (print.front > 0.0 && print.back > 0.0) return 0.5;
    return print.back > 0.0 ? 1.0 : 0.0;
}

double bare_in_front(const std::vector<Print>& prints) {
    const bool front =
        std::any_of(prints.begin(), prints.end(), [](const Print& p) { return p.front > 0.0; });
    const bool back = std::any_of(prints.begin(), prints.end(), [](const Print& p) { return p.back > 0.0; });
    if (front == back) return 0.5;
    return back ? 1.0 : 0.0;
}

template <class Height>
std::vector<Corners> skin(const Result& result, const SurfaceFields& fields, const Height& height) {
    const double bare = bare_in_front(result.layout.print);
    std::vector<Corners> triangles;
    for (std::size_t t = 0; t < result.layout.mesh.triangles.size(); ++t) {
        const Print print = result.layout.print.empty() ? Print{} : result.layout.print[t];
        const double h = height(print, print.bare() ? bare : fabric_in_front(print));
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto v = static_cast<std::size_t>(result.layout.mesh.triangles[t][k]);
            corners[k] = result.shape[v] + h * fields.vertex_normal[v];
        }
        triangles.push_back(corners);
    }
    return triangles;
}

/// Where a skin has a vertex, as one of its triangles sees it.
const Vec3& corner_of(const Result& result, const std::vector<Corners>& skin, int triangle, int vertex) {
    const Triangle& corners = result.layout.mesh.triangles[static_cast<std::size_t>(triangle)];
    std::size_t k = 0;
    while (corners[k] != vertex) ++k;
    return skin[static_cast<std::size_t>(triangle)][k];
}

}  // namespace

std::vector<Corners> front_skin(const Result& result, const SurfaceFields& fields) {
    const double fabric = result.scene.material.fabric_thickness;
    return skin(result, fields,
                [&](const Print& print, double before) { return fabric * before + print.front; });
}

std::vector<Corners> back_skin(const Result& result, const SurfaceFields& fields) {
    const double fabric = result.scene.material.fabric_thickness;
    return skin(result, fields,
                [&](const Print& print, double before) { return -fabric * (1.0 - before) - print.back; });
}

std::vector<Corners> sides_of_print(const Result& result, const std::vector<Corners>& skin) {
    constexpr double step = 1e-9;  // mm
    std::vector<Corners> sides;
    for (const Edge& edge : find_edges(result.layout.mesh).edges) {
        if (edge.on_boundary()) continue;
        const auto [a, b] = edge.vertex;
        const auto [here, there] = edge.triangle;
        const Vec3& a_here = corner_of(result, skin, here, a);
        const Vec3& a_there = corner_of(result, skin, there, a);
        const Vec3& b_here = corner_of(result, skin, here, b);
        const Vec3& b_there = corner_of(result, skin, there, b);
        if ((a_here - a_there).norm() < step || (b_here - b_there).norm() < step) continue;
        sides.push_back({a_here, b_here, b_there});
        sides.push_back({a_here, b_there, a_there});
    }
    return sides;
}

}  // namespace ruche

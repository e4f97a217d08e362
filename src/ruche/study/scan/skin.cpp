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

}  // namespace ruche

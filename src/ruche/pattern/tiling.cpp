#include "ruche/pattern/tiling.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace ruche {

/// Nearest first; equal distances (to rounding) by angle in [0, 2 pi).
static std::pair<long long, double> outward_order(const Vec2& x) {
    double angle = std::atan2(x.y(), x.x());
    if (angle < -1e-9) angle += 2 * M_PI;
    return {std::llround(x.norm() * 1e6), angle};
}

static Vec2 cell_centre(int i, int j, double edge) {
    return {1.5 * edge * i, std::sqrt(3.0) * edge * (j + 0.5 * i)};
}

std::vector<Vec2> hexagon_centres(double edge, double radius) {
    const int reach = static_cast<int>(std::ceil(radius / edge)) + 1;
    std::vector<Vec2> centres;
    for (int i = -reach; i <= reach; ++i) {
        for (int j = -2 * reach; j <= 2 * reach; ++j) {
            const Vec2 centre = cell_centre(i, j, edge);
            if (centre.norm() <= radius) centres.push_back(centre);
        }
    }
    std::ranges::sort(centres, {}, outward_order);
    return centres;
}

std::vector<TilingVertex> hexagon_vertices(double edge, double radius) {
    // Every cell owns its corners at +x and -x; together these are all vertices, each once.
    std::vector<TilingVertex> vertices;
    for (const Vec2& centre : hexagon_centres(edge, radius + 2 * edge)) {
        for (const double side : {1.0, -1.0}) {
            const Vec2 at = centre + Vec2(side * edge, 0.0);
            if (at.norm() <= radius) vertices.push_back({at, side > 0 ? 0.0 : M_PI});
        }
    }
    std::ranges::sort(vertices, {}, [](const TilingVertex& v) { return outward_order(v.at); });
    return vertices;
}

Polyline circle_polygon(double radius, double tolerance) {
    const double step = 2.0 * std::acos(1.0 - std::min(tolerance / radius, 0.5));
    const int count = std::max(12, static_cast<int>(std::ceil(2 * M_PI / step)));
    Polyline points;
    points.reserve(count);
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return points;
}

}  // namespace ruche

#include "ruche/geometry/surface_search.hpp"

#include <limits>

namespace ruche {

/// By the regions in which corners, edges or the inside are nearest (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5).
std::array<double, 3> nearest_weights(const Corners& triangle, const Vec3& p) {
    const auto& [a, b, c] = triangle;
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const double d1 = ab.dot(p - a);
    const double d2 = ac.dot(p - a);
    if (d1 <= 0.0 && d2 <= 0.0) return {1, 0, 0};
    const double d3 = ab.dot(p - b);
    const double d4 = ac.dot(p - b);
    if (d3 >= 0.0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const double d5 = ab.dot(p - c);
    const double d6 = ac.dot(p - c);
    if (d6 >= 0.0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

static Vec3 point_of(const Corners& triangle, const std::array<double, 3>& w) {
    return w[0] * triangle[0] + w[1] * triangle[1] + w[2] * triangle[2];
}

static std::vector<AxisBox<double>> boxes_of(const std::vector<Corners>& triangles) {
    std::vector<AxisBox<double>> boxes(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const Corners& corners = triangles[t];
        if (!corners[0].allFinite() || !corners[1].allFinite() || !corners[2].allFinite()) continue;
        for (const Vec3& p : corners) boxes[t].add(std::array{p.x(), p.y(), p.z()});
    }
    return boxes;
}

SurfaceSearch::SurfaceSearch(std::vector<Corners> triangles)
    : triangles_(std::move(triangles)), tree_(boxes_of(triangles_)) {}

SurfaceHit SurfaceSearch::nearest(const Vec3& p) const {
    const auto squared = [&](int t) {
        const Corners& triangle = triangles_[static_cast<std::size_t>(t)];
        return (point_of(triangle, nearest_weights(triangle, p)) - p).squaredNorm();
    };
    SurfaceHit hit;
    hit.triangle = tree_.nearest({p.x(), p.y(), p.z()}, std::numeric_limits<double>::max(), squared);
    if (hit.triangle < 0) return hit;
    const Corners& triangle = triangles_[static_cast<std::size_t>(hit.triangle)];
    hit.weights = nearest_weights(triangle, p);
    hit.point = point_of(triangle, hit.weights);
    return hit;
}

}  // namespace ruche

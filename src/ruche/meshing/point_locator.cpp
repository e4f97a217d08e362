#include "ruche/meshing/point_locator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ruche {

namespace {

struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    std::array<double, 3> weights = {0, 0, 0};
};

// The point of the triangle nearest to p, and how far away it is (0 inside).
Hit nearest_point(const std::array<Vec2, 3>& corner, const Vec2& p) {
    const auto twice_area = [](const Vec2& a, const Vec2& b, const Vec2& c) {
        return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    };
    const double whole = twice_area(corner[0], corner[1], corner[2]);
    Hit inside{.distance = 0.0};
    bool is_inside = whole > 0.0;
    for (int i = 0; i < 3; ++i) {
        inside.weights[i] = twice_area(p, corner[(i + 1) % 3], corner[(i + 2) % 3]) / whole;
        is_inside = is_inside && inside.weights[i] >= 0.0;
    }
    if (is_inside) return inside;
    Hit best;
    for (int i = 0; i < 3; ++i) {
        const Vec2& a = corner[i];
        const Vec2 along = corner[(i + 1) % 3] - a;
        const double square = along.squaredNorm();
        const double t = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
        const double distance = (p - a - t * along).norm();
        if (distance < best.distance) {
            best.distance = distance;
            best.weights = {0, 0, 0};
            best.weights[i] = 1.0 - t;
            best.weights[(i + 1) % 3] = t;
        }
    }
    return best;
}

}  // namespace

PointLocator::PointLocator(const TriangleMesh& mesh) : mesh_(mesh) {
    Vec2 high = Vec2::Zero();
    if (!mesh.vertices.empty()) low_ = high = mesh.vertices.front();
    for (const Vec2& v : mesh.vertices) {
        low_ = low_.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    const Vec2 extent = high - low_;
    // About one triangle per cell.
    const double count = std::max<double>(1.0, mesh.triangle_count());
    spacing_ = std::max({std::sqrt(extent.prod() / count), extent.maxCoeff() / count, 1e-9});
    columns_ = static_cast<int>(extent.x() / spacing_) + 1;
    rows_ = static_cast<int>(extent.y() / spacing_) + 1;
    cells_.resize(static_cast<std::size_t>(columns_) * rows_);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& tri = mesh.triangles[t];
        const Vec2& a = mesh.vertices[tri[0]];
        const Vec2& b = mesh.vertices[tri[1]];
        const Vec2& c = mesh.vertices[tri[2]];
        for (int j = row(std::min({a.y(), b.y(), c.y()})); j <= row(std::max({a.y(), b.y(), c.y()})); ++j) {
            for (int i = column(std::min({a.x(), b.x(), c.x()}));
                 i <= column(std::max({a.x(), b.x(), c.x()})); ++i) {
                cells_[static_cast<std::size_t>(j) * columns_ + i].push_back(t);
            }
        }
    }
}

int PointLocator::column(double x) const {
    return static_cast<int>(std::clamp((x - low_.x()) / spacing_, 0.0, columns_ - 1.0));
}

int PointLocator::row(double y) const {
    return static_cast<int>(std::clamp((y - low_.y()) / spacing_, 0.0, rows_ - 1.0));
}

std::optional<MeshPoint> PointLocator::find(const Vec2& point, double reach,
                                            const std::function<bool(int)>& accept) const {
    Hit best;
    int found = -1;
    const auto search = [&](double around) {
        for (int j = row(point.y() - around); j <= row(point.y() + around); ++j) {
            for (int i = column(point.x() - around); i <= column(point.x() + around); ++i) {
                for (const int t : cells_[static_cast<std::size_t>(j) * columns_ + i]) {
                    if (!accept(t)) continue;
                    const Triangle& tri = mesh_.triangles[t];
                    const Hit hit = nearest_point(
                        {mesh_.vertices[tri[0]], mesh_.vertices[tri[1]], mesh_.vertices[tri[2]]}, point);
                    if (hit.distance > reach) continue;
                    if (hit.distance < best.distance || (hit.distance == best.distance && t < found)) {
                        best = hit;
                        found = t;
                    }
                }
            }
        }
    };
    search(0.0);
    // In growing boxes: what lies outside one is farther away than it reaches.
    for (double around = 0.0; best.distance > around && around < reach;) {
        around = std::min(reach, around > 0.0 ? 2.0 * around : spacing_);
        search(around);
    }
    if (found < 0) return {};
    return MeshPoint{found, {best.weights[0], best.weights[1], best.weights[2]}};
}

Vec2 position(const TriangleMesh& mesh, const MeshPoint& point) {
    const Triangle& tri = mesh.triangles[point.triangle];
    return point.weights[0] * mesh.vertices[tri[0]] + point.weights[1] * mesh.vertices[tri[1]] +
           point.weights[2] * mesh.vertices[tri[2]];
}

}  // namespace ruche

#include "ruche/output/camera.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

constexpr int patch_grid = 24;  ///< the layout is looked at in so many by so many patches
constexpr int look_grid = 56;   ///< rays per view and direction
constexpr int azimuths = 24;

struct Moments {
    double area = 0.0;
    Vec3 mean = Vec3::Zero();
    Mat3 covariance = Mat3::Zero();
};

/// Area-weighted moments of the triangles that have finite corners.
Moments moments(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
    Moments m;
    for (int pass = 0; pass < 2; ++pass) {
        for (const Triangle& t : triangles) {
            const Vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
            const double area = 0.5 * (b - a).cross(c - a).norm();
            if (!std::isfinite(area)) continue;
            const Vec3 middle = (a + b + c) / 3.0;
            if (pass == 0) {
                m.area += area;
                m.mean += area * middle;
            } else {
                m.covariance += area * (middle - m.mean) * (middle - m.mean).transpose();
            }
        }
        if (!(m.area > 0.0)) return {};
        if (pass == 0) m.mean /= m.area;
    }
    m.covariance /= m.area;
    return m;
}

/// Centre of the bounding box in the rotated frame and the radius around it.
Placement place(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                const Mat3& rotation) {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
    for (const Triangle& t : triangles)
        for (const int v : t) {
            if (!positions[v].allFinite()) continue;
            const Vec3 p = rotation * positions[v];
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    Placement result{.rotation = rotation};
    if (!(low.x() <= high.x())) return result;
    const Vec3 middle = 0.5 * (low + high);
    result.middle = rotation.transpose() * middle;
    const double radius = 0.5 * (high - low).norm();
    if (std::isfinite(radius) && radius > 0.0) result.scale = 1.0 / radius;
    return result;
}

/// A rotation that turns `up` to z and `away` (its part across `up`) to y.
Mat3 upright(const Vec3& up, const Vec3& away) {
    const Vec3 z = up.normalized();
    Vec3 y = away - z * z.dot(away);
    y = y.norm() > 1e-9 ? Vec3(y.normalized()) : z.unitOrthogonal();
    Mat3 rows;
    rows.row(0) = y.cross(z).transpose();
    rows.row(1) = y.transpose();
    rows.row(2) = z.transpose();
    return rows;
}

/// Which patch of the layout a triangle lies in.
std::vector<int> layout_patches(const TriangleMesh& mesh) {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (const Vec2& v : mesh.vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    const double size = std::max((high - low).maxCoeff(), 1e-9) * 1.0001;
    std::vector<int> patch;
    patch.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        const Vec2 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
        const Vec2 cell = (middle - low) * (patch_grid / size);
        patch.push_back(static_cast<int>(cell.y()) * patch_grid + static_cast<int>(cell.x()));
    }
    return patch;
}

/// What one can see of a sheet from different sides.
class Spectator {
  public:
    Spectator(const Result& result, const Placement& start)
        : result_(result), patch_(layout_patches(result.layout.mesh)), scene_({surface(result, start)}) {
        std::vector<char> exists(patch_grid * patch_grid, 0), printed(exists);
        for (std::size_t t = 0; t < patch_.size(); ++t) {
            exists[patch_[t]] = 1;
            if (is_printed(t)) printed[patch_[t]] = 1;
        }
        patches_ = static_cast<double>(std::count(exists.begin(), exists.end(), 1));
        printed_patches_ = static_cast<double>(std::count(printed.begin(), printed.end(), 1));
    }

    /// How telling the view is from direction `eye` (towards the viewer), in the start's coordinates.
    double score(const Vec3f& eye, const Vec3f& up) const {
        const Vec3f right = up.cross(eye).normalized();
        const Vec3f above = eye.cross(right);
        std::vector<char> seen(patch_grid * patch_grid, 0), print_seen(seen);
        int hits = 0;
        int edges = 0;
        float before = 0.0F;
        double slant = 0.0;
        for (int j = 0; j < look_grid; ++j)
            for (int i = 0; i < look_grid; ++i) {
                const float x = 2.0F * (i + 0.5F) / look_grid - 1.0F,
                            y = 2.0F * (j + 0.5F) / look_grid - 1.0F;
                RayHit hit;
                if (!scene_.intersect({.origin = 2.0F * eye + x * right + y * above, .direction = -eye}, hit))
                    continue;
                ++hits;
                if (before > 0.0F && std::abs(hit.distance - before) > 0.15F) ++edges;
                before = hit.distance;
                seen[patch_[hit.triangle]] = 1;
                const Relief& sheet = scene_.parts()[0];
                const Triangle& t = sheet.triangles[hit.triangle];
                const Vec3 normal = (sheet.positions[t[1]] - sheet.positions[t[0]])
                                        .cross(sheet.positions[t[2]] - sheet.positions[t[0]]);
                const double facing = normal.normalized().dot(eye.cast<double>());
                slant += std::abs(facing) > 0.95 ? 0.0 : 1.0;
                const Print& print =
                    result_.layout.print.empty() ? Print{} : result_.layout.print[hit.triangle];
                if ((facing > 0.0 ? print.front : print.back) > 0.0) print_seen[patch_[hit.triangle]] = 1;
            }
        if (hits == 0) return 0.0;
        const auto share = [](const std::vector<char>& set, double all) {
            return all > 0.0 ? static_cast<double>(std::count(set.begin(), set.end(), 1)) / all : 0.0;
        };
        return share(seen, patches_) + 0.7 * share(print_seen, printed_patches_) + 0.35 * slant / hits +
               0.3 * std::min(1.0, 4.0 * edges / hits);
    }

  private:
    static Relief surface(const Result& result, const Placement& start) {
        Relief sheet;
        sheet.triangles = result.layout.mesh.triangles;
        for (const Vec3& p : result.shape) sheet.positions.push_back(start.apply(p));
        return sheet;
    }
    bool is_printed(std::size_t t) const {
        return !result_.layout.print.empty() && !result_.layout.print[t].bare();
    }

    const Result& result_;
    std::vector<int> patch_;
    RayScene scene_;
    double patches_ = 0.0;
    double printed_patches_ = 0.0;
};

std::vector<Vec3> possible_ups(const Result& result, const Moments& m) {
    const auto& g = result.scene.gravity.acceleration_mm_per_s2;
    const Vec3 gravity(g[0], g[1], g[2]);
    if (gravity.norm() > 0.0) return {-gravity.normalized()};
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(m.covariance);
    // An eigenvector's sign is arbitrary: give it one that rounding does not turn around.
    Vec3 shortest = axes.eigenvectors().col(0);
    if (shortest.dot(Vec3(0.1, 0.2, 1.0)) < 0.0) shortest = -shortest;
    return {shortest, -shortest};
}

}  // namespace

Vec3f Camera::direction(const Vec2f& pixel) const {
    return (forward + ((pixel.x() - centre.x()) / focal) * right - ((pixel.y() - centre.y()) / focal) * up)
        .normalized();
}

Vec2f Camera::project(const Vec3f& point) const {
    const Vec3f r = point - position;
    const float depth = r.dot(forward);
    return {centre.x() + focal * r.dot(right) / depth, centre.y() - focal * r.dot(up) / depth};
}

Placement place_flat(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
    return place(positions, triangles, Mat3::Identity());
}

View choose_view(const Result& result) {
    const std::vector<Triangle>& triangles = result.layout.mesh.triangles;
    const Moments m = moments(result.shape, triangles);
    if (!(m.area > 0.0)) return {};
    const Placement start = place(result.shape, triangles, Mat3::Identity());
    const Spectator spectator(result, start);
    struct Candidate {
        Vec3 up;
        Vec3 eye;
        float elevation;
        double score;
    };
    std::vector<Candidate> candidates;
    for (const Vec3& up : possible_ups(result, m))
        for (const float elevation : {20.0F, 28.0F, 36.0F, 44.0F, 54.0F})
            for (int k = 0; k < azimuths; ++k) {
                const double turn = 2.0 * std::numbers::pi * (k + 0.5) / azimuths;
                const double rise = elevation * std::numbers::pi / 180.0;
                const Vec3 x = up.unitOrthogonal();
                const Vec3 across = std::cos(turn) * x + std::sin(turn) * up.cross(x);
                candidates.push_back({up, std::cos(rise) * across + std::sin(rise) * up, elevation, 0.0});
            }
    parallel_for(candidates.size(), [&](std::size_t i) {
        Candidate& c = candidates[i];
        const double usual = (c.elevation - 34.0) / 40.0;
        c.score = spectator.score(c.eye.cast<float>(), c.up.cast<float>()) - 0.4 * usual * usual;
    });
    const Candidate& best =
        *std::max_element(candidates.begin(), candidates.end(),
                          [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
    return {place(result.shape, triangles, upright(best.up, -best.eye)), best.elevation};
}

Camera fit_camera(const std::vector<Vec3f>& points, float elevation_deg, float distance, const Frame& frame) {
    const float rise = elevation_deg * std::numbers::pi_v<float> / 180.0F;
    Camera camera;
    camera.forward = Vec3f(0.0F, std::cos(rise), -std::sin(rise));
    camera.up = Vec3f(0.0F, std::sin(rise), std::cos(rise));
    camera.position = -distance * camera.forward;
    Vec2f low = Vec2f::Constant(1e30F), high = Vec2f::Constant(-1e30F);
    for (const Vec3f& p : points) {
        const Vec2f at = camera.project(p);
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
    }
    if (!(low.x() < high.x() && low.y() < high.y())) return camera;
    camera.focal = std::min((frame.right - frame.left) / (high.x() - low.x()),
                            (frame.bottom - frame.top) / (high.y() - low.y()));
    camera.centre = Vec2f(0.5F * (frame.left + frame.right), 0.5F * (frame.top + frame.bottom)) -
                    camera.focal * 0.5F * (low + high);
    return camera;
}

}  // namespace ruche

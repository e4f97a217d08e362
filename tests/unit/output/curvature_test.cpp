#include "ruche/output/curvature.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "output/sample_results.hpp"

using namespace ruche;

namespace {

struct Expected {
    double max;
    double min;
};

/// Largest difference from the exact principal curvatures over the inner vertices of a jittered grid of n x n
/// cells on [-1, 1]^2.
double worst_error(int n, const std::function<Vec3(double, double)>& surface,
                   const std::function<Expected(double, double)>& exact) {
    const TriangleMesh mesh = sample::grid({.width = 2, .height = 2, .nx = n, .ny = n, .jitter = 0.4});
    std::vector<Vec3> positions;
    for (const Vec2& v : mesh.vertices) positions.push_back(surface(v.x() - 1, v.y() - 1));
    const auto curvature =
        vertex_curvatures(mesh.triangles, positions, vertex_normals(mesh.triangles, positions));
    double worst = 0.0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const double x = mesh.vertices[v].x() - 1, y = mesh.vertices[v].y() - 1;
        if (std::max(std::abs(x), std::abs(y)) > 0.75) continue;
        const Expected e = exact(x, y);
        worst = std::max({worst, std::abs(curvature[v].max - e.max), std::abs(curvature[v].min - e.min)});
    }
    return worst;
}

}  // namespace

TEST_CASE("curvature: an outward sphere has 1/R twice, and the error falls with the element size") {
    const double radius = 3.0;
    const auto sphere = [=](double x, double y) {
        return Vec3(x, y, std::sqrt(radius * radius - x * x - y * y));
    };
    const auto exact = [=](double, double) { return Expected{1 / radius, 1 / radius}; };
    const double coarse = worst_error(12, sphere, exact), fine = worst_error(48, sphere, exact);
    CHECK(coarse < 0.02 / radius);
    CHECK(fine < 0.4 * coarse);
}

TEST_CASE("curvature: a cylinder that is concave at the back has (1/R, 0), mirrored (0, -1/R)") {
    const double radius = 2.0;
    for (const double sign : {1.0, -1.0}) {
        const auto cylinder = [=](double x, double y) {
            return Vec3(radius * std::sin(x / radius), y, sign * radius * std::cos(x / radius));
        };
        const auto exact = [=](double, double) {
            return sign > 0 ? Expected{1 / radius, 0} : Expected{0, -1 / radius};
        };
        const double coarse = worst_error(12, cylinder, exact), fine = worst_error(48, cylinder, exact);
        CHECK(coarse < 0.03 / radius);
        CHECK(fine < 0.4 * coarse);
    }
}

TEST_CASE(
    "curvature: a saddle has the curvatures of its formula, and the error falls with the element size") {
    // z = (x^2 - y^2)/2: K = -1/w^2, H = (y^2 - x^2)/(2 w^1.5) with w = 1 + x^2 + y^2; ours is minus H.
    const auto saddle = [](double x, double y) { return Vec3(x, y, 0.5 * (x * x - y * y)); };
    const auto exact = [](double x, double y) {
        const double w = 1 + x * x + y * y, gauss = -1 / (w * w);
        const double mean = -(y * y - x * x) / (2 * w * std::sqrt(w));
        const double spread = std::sqrt(mean * mean - gauss);
        return Expected{mean + spread, mean - spread};
    };
    const double coarse = worst_error(12, saddle, exact), fine = worst_error(48, saddle, exact);
    CHECK(coarse < 0.03);
    CHECK(fine < 0.4 * coarse);
}

TEST_CASE("curvature: too few points, no area and positions that are not finite give 0, not NaN") {
    const std::vector<Triangle> triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},   {5, 5, 5}, {5, 5, 5},
                                         {5, 5, 5}, {9, 0, 0}, {9, 1, nan}, {8, 0, 0}, {7, 7, 7}};
    const auto curvature = vertex_curvatures(triangles, positions, vertex_normals(triangles, positions));
    REQUIRE(curvature.size() == positions.size());
    for (const VertexCurvature& c : curvature) {
        CHECK(c.max == doctest::Approx(0).epsilon(1e-12));
        CHECK(c.min == doctest::Approx(0).epsilon(1e-12));
    }
}

#include "ruche/geometry/surface_search.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace ruche;

namespace {

std::mt19937 random_numbers(7);

Vec3 anywhere(double size = 1.0) {
    std::uniform_real_distribution<double> roll(-size, size);
    return {roll(random_numbers), roll(random_numbers), roll(random_numbers)};
}

std::vector<Corners> soup(int count) {
    std::vector<Corners> triangles;
    for (int i = 0; i < count; ++i) {
        const Vec3 at = anywhere(3.0);
        triangles.push_back({at, at + anywhere(0.5), at + anywhere(0.5)});
    }
    return triangles;
}

double distance(const Corners& triangle, const Vec3& p) {
    const auto w = nearest_weights(triangle, p);
    return (w[0] * triangle[0] + w[1] * triangle[1] + w[2] * triangle[2] - p).norm();
}

}  // namespace

TEST_CASE("nearest point: no other point of the triangle is nearer, wherever the point lies") {
    for (int trial = 0; trial < 200; ++trial) {
        const Corners triangle = {anywhere(), anywhere(), anywhere()};
        const Vec3 p = anywhere(2.0);
        const auto weights = nearest_weights(triangle, p);
        CHECK(weights[0] + weights[1] + weights[2] == doctest::Approx(1.0).epsilon(1e-12));
        for (const double w : weights) CHECK(w >= 0.0);
        const double least = distance(triangle, p);
        for (int i = 0; i <= 20; ++i)
            for (int k = 0; k + i <= 20; ++k) {
                const Vec3 other = (i * triangle[0] + k * triangle[1] + (20 - i - k) * triangle[2]) / 20.0;
                CHECK((other - p).norm() >= least - 1e-12);
            }
    }
}

TEST_CASE("surface search: finds what comparing with every triangle finds") {
    const SurfaceSearch search(soup(300));
    for (int trial = 0; trial < 300; ++trial) {
        const Vec3 p = anywhere(5.0);
        double least = 1e300;
        for (const Corners& triangle : search.triangles()) least = std::min(least, distance(triangle, p));
        const SurfaceHit hit = search.nearest(p);
        CHECK((hit.point - p).norm() == doctest::Approx(least).epsilon(1e-12));
        CHECK(distance(search.triangles()[static_cast<std::size_t>(hit.triangle)], p) ==
              doctest::Approx(least).epsilon(1e-12));
    }
}

TEST_CASE("surface search: a triangle that is not finite is never the nearest") {
    std::vector<Corners> triangles = soup(5);
    triangles[2][1].x() = std::numeric_limits<double>::quiet_NaN();
    const SurfaceSearch search(triangles);
    for (int trial = 0; trial < 50; ++trial) CHECK(search.nearest(anywhere(4.0)).triangle != 2);
}

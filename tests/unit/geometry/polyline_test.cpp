#include "ruche/geometry/polyline.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace ruche;

static Polyline circle(double radius, int count) {
    Polyline points;
    for (int i = 0; i < count; ++i) {
        const double a = 2.0 * std::numbers::pi * i / count;
        points.emplace_back(radius * std::cos(a), radius * std::sin(a));
    }
    return points;
}

TEST_CASE("simplify: every point stays within the tolerance of what remains") {
    const Polyline fine = circle(10.0, 5000);
    const double tolerance = 0.01;
    const Polyline coarse = simplify(fine, true, tolerance);
    // A chord of sagitta d on a circle of radius r is about sqrt(8 r d) long: 0.894 mm, 70 of them; the
    // halving of the algorithm may need up to twice as many.
    CHECK(coarse.size() >= 70);
    CHECK(coarse.size() <= 140);
    for (const Vec2& p : fine) {
        double nearest = 1e9;
        for (std::size_t i = 0; i < coarse.size(); ++i) {
            nearest = std::min(nearest, distance_to_segment(p, coarse[i], coarse[(i + 1) % coarse.size()]));
        }
        REQUIRE(nearest <= tolerance);
    }
}

TEST_CASE("simplify: points on straight lines go, corners and ends stay") {
    const Polyline line = {Vec2(0, 0), Vec2(1, 0), Vec2(2, 0), Vec2(2, 1), Vec2(2, 5)};
    CHECK(simplify(line, false, 1e-9) == Polyline{Vec2(0, 0), Vec2(2, 0), Vec2(2, 5)});
    CHECK(simplify({Vec2(1, 1)}, true, 1.0).size() == 1);
    CHECK(simplify({}, false, 1.0).empty());
}

TEST_CASE("simplify: a chain that returns to its start does not collapse onto it") {
    const Polyline loop = {Vec2(0, 0), Vec2(5, 1), Vec2(0, 0)};
    CHECK(simplify(loop, false, 0.1) == loop);
}

TEST_CASE("resample: the points are evenly spaced along the chain") {
    const Polyline corner = {Vec2(0, 0), Vec2(3, 0), Vec2(3, 1)};
    CHECK(resample(corner, false, 5) == Polyline{Vec2(0, 0), Vec2(1, 0), Vec2(2, 0), Vec2(3, 0), Vec2(3, 1)});
    const Polyline square = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    CHECK(resample(square, true, 4) == square);
    CHECK(length(square, true) == doctest::Approx(4.0));
    CHECK(length(square) == doctest::Approx(3.0));
}

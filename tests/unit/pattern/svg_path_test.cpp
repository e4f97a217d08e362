#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "ruche/pattern/svg_path.hpp"

using namespace ruche;
using namespace ruche::svg;

static Polyline points(const char* data, double tolerance = 0.001) {
    const PathReading reading = parse_path(data);
    CHECK_MESSAGE(!reading.error, *reading.error);
    REQUIRE(reading.outline.size() == 1);
    return flatten(reading.outline.front(), Affine(), {tolerance, 0.0}).points;
}

static void check_same(const Polyline& a, const Polyline& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK((a[i] - b[i]).norm() < 1e-12);
}

TEST_CASE("svg path: relative, absolute, implicit and one-coordinate commands say the same") {
    const Polyline expected = {{1, 2}, {4, 2}, {4, 6}, {0, 6}};
    check_same(points("M1 2L4 2L4 6L0 6"), expected);
    check_same(points("m1,2 3,0 0,4-4,0"), expected);
    check_same(points("M1 2 4 2 4 6 0 6"), expected);
    check_same(points("M1 2H4V6H0"), expected);
    check_same(points(" M 1 2 h 3 v 4 h -4"), expected);
    check_same(points("M1 2h1 1 1v2 2h-4"), {{1, 2}, {2, 2}, {3, 2}, {4, 2}, {4, 4}, {4, 6}, {0, 6}});
}

TEST_CASE("svg path: after Z the next subpath starts where the closed one did") {
    const PathReading reading = parse_path("m10 10h5v5zl0-5z m1 1h1");
    REQUIRE(reading.outline.size() == 3);
    CHECK(reading.outline[0].closed);
    CHECK(reading.outline[1].start == Vec2(10, 10));
    CHECK(reading.outline[2].start == Vec2(11, 11));
    CHECK_FALSE(reading.outline[2].closed);
}

TEST_CASE("svg path: S and T reflect the control point of their own kind only") {
    check_same(points("M0 0C0 1 1 1 1 0S2-1 2 0"), points("M0 0C0 1 1 1 1 0C1-1 2-1 2 0"));
    check_same(points("M0 0c0 1 1 1 1 0s1-1 1 0"), points("M0 0C0 1 1 1 1 0C1-1 2-1 2 0"));
    check_same(points("M0 0Q1 2 2 0T4 0 6 0"), points("M0 0Q1 2 2 0Q3-2 4 0Q5 2 6 0"));
    // After any other command the control point is where the pen is.
    check_same(points("M0 0Q1 2 2 0S4 3 5 0"), points("M0 0Q1 2 2 0C2 0 4 3 5 0"));
    check_same(points("M0 0C0 1 1 1 1 0T4 0"), points("M0 0C0 1 1 1 1 0Q1 0 4 0"));
}

TEST_CASE("svg path: a quadratic curve keeps the tolerance from its parabola") {
    for (const Vec2& p : points("M0 0Q50 100 100 0", 0.01)) {
        CHECK(p.y() == doctest::Approx(p.x() * (100.0 - p.x()) / 50.0).epsilon(1e-12));
    }
    const Polyline line = points("M0 0Q50 100 100 0", 0.01);
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec2 middle = (line[i] + line[i - 1]) / 2.0;
        // Over a chord of width w the parabola y = x (100 - x) / 50 rises w^2 / 200 above it.
        CHECK(middle.x() * (100.0 - middle.x()) / 50.0 - middle.y() < 0.025);
        CHECK((line[i] - line[i - 1]).norm() > 0.1);
    }
}

TEST_CASE("svg path: an arc lies on its ellipse and goes the way the flags say") {
    struct Case {
        const char* data;
        Vec2 centre;
        double sweep;
    };
    const double pi = std::numbers::pi;
    for (const auto& [data, centre, sweep] : {Case{"M0 0A10 10 0 0 1 10 10", {0, 10}, pi / 2},
                                              {"M0 0A10 10 0 0 0 10 10", {10, 0}, -pi / 2},
                                              {"M0 0A10 10 0 1 1 10 10", {10, 0}, 3 * pi / 2},
                                              {"M0 0A10 10 0 1 0 10 10", {0, 10}, -3 * pi / 2}}) {
        CAPTURE(std::string(data));
        const Polyline line = points(data, 1e-4);
        double turned = 0.0;
        for (std::size_t i = 0; i < line.size(); ++i) {
            CHECK((line[i] - centre).norm() == doctest::Approx(10.0).epsilon(1e-12));
            if (i == 0) continue;
            const Vec2 a = line[i - 1] - centre, b = line[i] - centre;
            turned += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
        }
        CHECK(turned == doctest::Approx(sweep).epsilon(1e-9));
        CHECK(line.back() == Vec2(10, 10));
    }
}

TEST_CASE("svg path: arc flags may touch what follows, small radii grow, a zero radius is a line") {
    check_same(points("M0 0a1,1 0 01.5.5"), points("M0 0A1 1 0 0 1 0.5 0.5"));
    check_same(points("M0 0a1 1 0 10.5.5 1 1 0 00-.5-.5"), points("M0 0A1 1 0 1 0 .5 .5A1 1 0 0 0 0 0"));
    // 1 is too small for a chord of 10: a half circle of radius 5.
    for (const Vec2& p : points("M0 0A1 1 0 0 1 10 0"))
        CHECK((p - Vec2(5, 0)).norm() == doctest::Approx(5.0));
    check_same(points("M0 0A0 5 0 0 1 10 3"), {{0, 0}, {10, 3}});
    check_same(points("M0 0A-5-5 0 0 1 10 0"), points("M0 0A5 5 0 0 1 10 0"));
    check_same(points("M0 0A1e12 1e12 0 0 1 10 3"), {{0, 0}, {10, 3}});
}

TEST_CASE("svg path: a turned ellipse passes through its own axes") {
    // A quarter of an ellipse with half axes 10 and 5, turned by 30 degrees about the origin.
    const double c = std::cos(std::numbers::pi / 6), s = 0.5;
    for (const Vec2& p : points("M8.660254037844386 5A10 5 30 0 1-2.5 4.330127018922193")) {
        const Vec2 local(c * p.x() + s * p.y(), -s * p.x() + c * p.y());
        CHECK(local.cwiseQuotient(Vec2(10, 5)).norm() == doctest::Approx(1.0).epsilon(1e-12));
    }
}

TEST_CASE("svg path: an error keeps what came before it and says where it is") {
    struct Case {
        const char* data;
        std::size_t segments;
        const char* says;
    };
    for (const auto& [data, segments, says] :
         {Case{"M0 0L1 1L2", 1, "a number expected at the end"},
          {"M0 0L1 1 foo", 1, "a command (one of MZLHVCSQTA) expected at 'foo' (character 10)"},
          {"M0 0L1 1C1 2 3 4 5", 1, "a number"},
          {"M0 0h5a1 1 0 2 0 5 5", 1, "an arc flag (0 or 1)"},
          {"M0 0h5 L nan 3", 1, "a number"},
          {"M0 0h5 1e999", 1, "a number"}}) {
        CAPTURE(std::string(data));
        const PathReading reading = parse_path(data);
        REQUIRE(reading.outline.size() == 1);
        CHECK(reading.outline[0].segments.size() == segments);
        REQUIRE(reading.error);
        CHECK(reading.error->find(says) != std::string::npos);
    }
    CHECK(parse_path("L1 1").error->find("M expected") != std::string::npos);
    CHECK(parse_path("L1 1").outline.empty());
    CHECK_FALSE(parse_path("").error);
    CHECK_FALSE(parse_path("none").error);
    CHECK(parse_path("M5 5").outline.empty());
    CHECK(parse_path("M5 5z").outline.size() == 1);
}

TEST_CASE("svg points: an odd coordinate at the end is an error, the pairs before it are drawn") {
    const PathReading reading = parse_points("0,0 10,0 10,10 5", true);
    CHECK(reading.error);
    REQUIRE(reading.outline.size() == 1);
    CHECK(reading.outline[0].segments.size() == 2);
}

TEST_CASE("svg outline: tolerance holds after the map, and for the edge of a wide pen") {
    const Outline circle = ellipse_outline({0, 0}, {10, 10});
    const auto sagitta = [](const Polyline& line, double radius) {
        const Vec2 chord = line[1] - line[0];
        const double angle = 2.0 * std::asin(chord.norm() / 2.0 / line[0].norm());
        return radius * (1.0 - std::cos(angle / 2.0));
    };
    const Polyline plain = flatten(circle[0], scaling(100.0, 100.0), {0.01, 0.0}).points;
    CHECK(sagitta(plain, 1000.0) <= 0.0100001);
    CHECK(sagitta(plain, 1000.0) > 0.008);
    const Polyline wide = flatten(circle[0], Affine(), {0.01, 5.0}).points;
    CHECK(sagitta(wide, 15.0) <= 0.0100001);
    CHECK(sagitta(wide, 10.0) < 0.0075);
}

#include "ruche/pattern/centreline.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "ruche/geometry/polyline.hpp"
#include "sample_shapes.hpp"

using namespace ruche;
using namespace ruche::test;

// Within rounding.
static bool on_border(const Polygon& polygon, const Vec2& p) {
    std::vector<Polyline> loops = polygon.holes;
    loops.push_back(polygon.outer);
    for (const Polyline& loop : loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            if (distance_to_segment(p, loop[i], loop[(i + 1) % loop.size()]) < 1e-9) return true;
        }
    }
    return false;
}

TEST_CASE("midline: of a rectangle it is the axis, from end to end") {
    const Polyline line = midline({box(0, 0, 30, 1), {}});
    REQUIRE(line.size() > 10);
    for (const Vec2& p : line) CHECK(std::abs(p.y() - 0.5) < 1e-3);
    CHECK(std::abs(std::abs(line.front().x() - line.back().x()) - 30.0) < 0.02);
}

TEST_CASE("midline: of a curved strip it follows the middle arc") {
    Polyline arc;
    for (int i = 0; i <= 100; ++i) {
        const double a = 0.045 * i;  // 4.5 radians: more than half a turn
        arc.emplace_back(10 * std::cos(a), 10 * std::sin(a));
    }
    const Region strip = stroke(arc, false, {.width = 1.2, .cap = LineCap::round});
    REQUIRE(strip.size() == 1);
    const Polyline line = midline(strip[0]);
    // The last millimetre or so at each end is straight: 1.2^2 / (2 * 10) = 0.072 off the arc.
    for (const Vec2& p : line) CHECK(std::abs(p.norm() - 10.0) < 0.075);
    // The arc is 45 mm long, round caps add 0.6 at each end.
    CHECK(length(line) == doctest::Approx(46.2).epsilon(0.01));
}

TEST_CASE("midline: of a wave it stays near the line that was stroked") {
    Polyline wave;
    for (int i = 0; i <= 400; ++i) wave.emplace_back(i * 0.1, 1.5 * std::sin(i * 0.1));
    const Region strip = stroke(wave, false, {.width = 1.2, .cap = LineCap::round});
    for (const Vec2& p : midline(strip[0])) {
        double nearest = 1e9;
        for (std::size_t i = 1; i < wave.size(); ++i) {
            nearest = std::min(nearest, distance_to_segment(p, wave[i - 1], wave[i]));
        }
        if (p.x() > 0.0 && p.x() < 40.0) CHECK(nearest < 0.05);
    }
}

TEST_CASE("midline: of a ring it runs half way between the borders, a small hole changes nothing") {
    Polyline hole = circle({0, 0}, 8);
    std::reverse(hole.begin(), hole.end());
    const Polyline ring = midline({circle({0, 0}, 10), {hole}});
    CHECK(ring.front() == ring.back());
    for (const Vec2& p : ring) CHECK(p.norm() == doctest::Approx(9.0).epsilon(2e-3));
    Polyline screw = circle({15, 0.5}, 0.2);
    std::reverse(screw.begin(), screw.end());
    CHECK(midline({box(0, 0, 30, 1), {screw}}) == midline({box(0, 0, 30, 1), {}}));
}

TEST_CASE("midline: every random polygon has one, and its parts inside lie inside") {
    CHECK(rc::check([] {
        Polyline loop;
        const int count = *rc::gen::inRange(3, 12);
        for (int i = 0; i < count; ++i) {
            loop.emplace_back(*rc::gen::inRange(0, 200) / 10.0, *rc::gen::inRange(0, 200) / 10.0);
        }
        for (const Polygon& polygon : region_from_loops({&loop, 1}, FillRule::evenodd)) {
            const Polyline line = midline(polygon);
            for (const Vec2& p : line) RC_ASSERT(p.allFinite());
            for (const Polyline& part : cut_to_region({line}, {polygon})) {
                RC_ASSERT(length(part) >= 0.05);
                for (std::size_t i = 1; i < part.size(); ++i) {
                    if ((part[i] - part[i - 1]).norm() < 1e-6) continue;
                    const Vec2 middle = 0.5 * (part[i - 1] + part[i]);
                    RC_ASSERT(contains({polygon}, middle) || on_border(polygon, middle));
                }
            }
        }
    }));
}

TEST_CASE("cut to region: a line is cut where it leaves, and a closed one is not cut at its start") {
    const Region two = {{box(0, 0, 4, 2), {}}, {box(6, 0, 10, 2), {}}};
    const std::vector<Polyline> parts = cut_to_region({{Vec2(-1, 1), Vec2(3, 1), Vec2(11, 1)}}, two);
    REQUIRE(parts.size() == 2);
    CHECK(parts[0] == Polyline{Vec2(0, 1), Vec2(3, 1), Vec2(4, 1)});
    CHECK(parts[1] == Polyline{Vec2(6, 1), Vec2(10, 1)});
    Polyline loop = circle({0, 0}, 5);
    loop.push_back(loop.front());
    const std::vector<Polyline> arc = cut_to_region({loop}, {{box(-3, -9, 9, 9), {}}});
    REQUIRE(arc.size() == 1);
    CHECK(length(arc[0]) == doctest::Approx(2 * 5 * std::acos(-0.6)).epsilon(1e-3));
    CHECK(cut_to_region({loop}, {{box(20, 20, 21, 21), {}}}).empty());
}

#include "ruche/geometry/polygon.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ruche/core/error.hpp"

using namespace ruche;

namespace {

constexpr double pi = std::numbers::pi;

Polyline box(double x0, double y0, double x1, double y1) {
    return {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)};
}

Region box_region(double x0, double y0, double x1, double y1) { return {{box(x0, y0, x1, y1), {}}}; }

Region from_loops(const std::vector<Polyline>& loops, FillRule rule) {
    return region_from_loops(loops, rule);
}

}  // namespace

TEST_CASE("region from loops: the fill rule decides what a doubly wound square covers") {
    const std::vector<Polyline> nested = {box(0, 0, 10, 10), box(2, 2, 5, 5)};
    CHECK(area(from_loops(nested, FillRule::nonzero)) == doctest::Approx(100.0).epsilon(1e-12));
    const Region ring = from_loops(nested, FillRule::evenodd);
    CHECK(area(ring) == doctest::Approx(91.0).epsilon(1e-12));
    REQUIRE(ring.size() == 1);
    CHECK(ring[0].holes.size() == 1);
    CHECK_FALSE(contains(ring, {3, 3}));
    CHECK(contains(ring, {1, 3}));
}

TEST_CASE("region from loops: a clockwise loop inside is a hole under the nonzero rule") {
    Polyline hole = box(2, 2, 5, 5);
    std::reverse(hole.begin(), hole.end());
    CHECK(area(from_loops({box(0, 0, 10, 10), hole}, FillRule::nonzero)) ==
          doctest::Approx(91.0).epsilon(1e-12));
}

TEST_CASE("region from loops: a figure of eight becomes two counter-clockwise polygons") {
    const Polyline bow = {Vec2(0, 0), Vec2(2, 2), Vec2(2, 0), Vec2(0, 2)};
    const Region region = from_loops({bow}, FillRule::nonzero);
    CHECK(region.size() == 2);
    for (const Polygon& polygon : region) CHECK(area({polygon}) == doctest::Approx(1.0).epsilon(1e-9));
}

TEST_CASE("region: an island in a hole is a polygon of its own") {
    const Region region =
        from_loops({box(0, 0, 10, 10), box(1, 1, 9, 9), box(3, 3, 4, 4)}, FillRule::evenodd);
    CHECK(region.size() == 2);
    CHECK(area(region) == doctest::Approx(100 - 64 + 1).epsilon(1e-12));
    CHECK(contains(region, {3.5, 3.5}));
    CHECK_FALSE(contains(region, {2, 2}));
}

TEST_CASE("booleans: areas of two overlapping squares follow inclusion and exclusion") {
    const Region a = box_region(0, 0, 4, 4);
    const Region b = box_region(3, 3, 6, 6);
    const std::vector<Region> both = {a, b};
    CHECK(area(unite(both)) == doctest::Approx(24.0).epsilon(1e-12));
    CHECK(area(intersect(a, b)) == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(area(subtract(a, b)) == doctest::Approx(15.0).epsilon(1e-12));
    CHECK(intersect(a, box_region(7, 7, 8, 8)).empty());
}

TEST_CASE("booleans: inclusion and exclusion hold for random triangles") {
    CHECK(rc::check([] {
        const auto triangle = [] {
            Polyline loop;
            for (int i = 0; i < 3; ++i) {
                loop.emplace_back(*rc::gen::inRange(-9000, 9000) / 1000.0,
                                  *rc::gen::inRange(-9000, 9000) / 1000.0);
            }
            return region_from_loops({&loop, 1}, FillRule::nonzero);
        };
        const Region a = triangle();
        const Region b = triangle();
        const std::vector<Region> both = {a, b};
        // Crossing points move by up to a grid step of 1e-6 mm, borders are up to 26 mm long.
        RC_ASSERT(std::abs(area(unite(both)) + area(intersect(a, b)) - area(a) - area(b)) < 2e-4);
        RC_ASSERT(std::abs(area(subtract(a, b)) + area(intersect(a, b)) - area(a)) < 2e-4);
    }));
}

TEST_CASE("offset: a square grows by sides and round corners, and shrinks by its rim") {
    const Region square = box_region(0, 0, 10, 10);
    // Chords within 1e-4 of the corner arcs cost less than 2 pi * 1 * 1e-4 of area.
    CHECK(std::abs(area(offset(square, 1.0, 1e-4)) - (100 + 40 + pi)) < 7e-4);
    CHECK(area(offset(square, -1.0)) == doctest::Approx(64.0).epsilon(1e-9));
    CHECK(offset(square, -5.1).empty());
    CHECK(area(offset(square, 0.0)) == doctest::Approx(100.0).epsilon(1e-12));
}

TEST_CASE("offset: a hole shrinks when the region grows") {
    const Region ring = from_loops({box(0, 0, 10, 10), box(2, 2, 8, 8)}, FillRule::evenodd);
    CHECK(std::abs(area(offset(ring, 1.0, 1e-4)) - (100 + 40 + pi - 16)) < 7e-4);
    CHECK(area(offset(ring, -0.5)) == doctest::Approx(81.0 - (36.0 + 12.0 + pi / 4)).epsilon(2e-3));
}

TEST_CASE("stroke: caps add what they should to a straight line") {
    const Polyline line = {Vec2(0, 0), Vec2(10, 0)};
    CHECK(area(stroke(line, false, {.width = 2.0})) == doctest::Approx(20.0).epsilon(1e-12));
    CHECK(area(stroke(line, false, {.width = 2.0, .cap = LineCap::square})) ==
          doctest::Approx(24.0).epsilon(1e-12));
    const Region round = stroke(line, false, {.width = 2.0, .cap = LineCap::round, .arc_tolerance = 1e-4});
    CHECK(std::abs(area(round) - (20 + pi)) < 7e-4);
    CHECK(area(round) < 20 + pi);
}

TEST_CASE("stroke: joins of a right angle differ by the corner") {
    const Polyline corner = {Vec2(0, 0), Vec2(10, 0), Vec2(10, 10)};
    // Two 10 x 2 arms overlap in a 1 x 1 square; outside the corner is a 1 x 1 square.
    const double arms = 40.0 - 1.0;
    const auto with = [&](LineJoin join, double limit) {
        return area(
            stroke(corner, false, {.width = 2.0, .join = join, .miter_limit = limit, .arc_tolerance = 1e-4}));
    };
    CHECK(with(LineJoin::miter, 4.0) == doctest::Approx(arms + 1.0).epsilon(1e-9));
    CHECK(with(LineJoin::miter, 1.4) == doctest::Approx(arms + 0.5).epsilon(1e-9));  // sqrt(2) > 1.4: bevel
    CHECK(with(LineJoin::bevel, 4.0) == doctest::Approx(arms + 0.5).epsilon(1e-9));
    CHECK(std::abs(with(LineJoin::round, 4.0) - (arms + pi / 4)) < 2e-4);
}

TEST_CASE("stroke: a sharp turn is mitred up to the limit and bevelled beyond") {
    // 60 degrees between the segments: miter length is twice the width.
    const Polyline wedge = {Vec2(10, 0), Vec2(0, 0), Vec2(5, 5 * std::sqrt(3.0))};
    const double bevel = area(stroke(wedge, false, {.width = 2.0, .miter_limit = 1.99}));
    const double miter = area(stroke(wedge, false, {.width = 2.0, .miter_limit = 2.01}));
    CHECK(miter - bevel == doctest::Approx(1.5 * std::sqrt(3.0) / 2.0).epsilon(1e-5));
}

TEST_CASE("stroke: a closed square is a frame with its hole") {
    const Region frame = stroke(box(0, 0, 10, 10), true, {.width = 2.0});
    REQUIRE(frame.size() == 1);
    CHECK(frame[0].holes.size() == 1);
    CHECK(area(frame) == doctest::Approx(144.0 - 64.0).epsilon(1e-12));
    Polyline clockwise = box(0, 0, 10, 10);
    std::reverse(clockwise.begin(), clockwise.end());
    CHECK(area(stroke(clockwise, true, {.width = 2.0})) == doctest::Approx(80.0).epsilon(1e-12));
}

TEST_CASE("stroke: a line that crosses itself or turns back is covered once") {
    const Polyline cross = {Vec2(-5, 0), Vec2(5, 0), Vec2(5, 5), Vec2(0, 5), Vec2(0, -5)};
    const double arms = 10 + 5 + 5 + 10;
    // Three mitred corners add nothing to length times width; the crossing is counted twice.
    CHECK(area(stroke(cross, false, {.width = 1.0})) == doctest::Approx(arms - 1.0).epsilon(1e-9));
    const Polyline back = {Vec2(0, 0), Vec2(10, 0), Vec2(3, 0)};
    CHECK(area(stroke(back, false, {.width = 1.0})) == doctest::Approx(10.0).epsilon(1e-9));
    const Region rounded =
        stroke(back, false, {.width = 1.0, .join = LineJoin::round, .arc_tolerance = 1e-5});
    CHECK(area(rounded) == doctest::Approx(10.0 + pi / 8).epsilon(1e-4));
}

TEST_CASE("stroke: a finely divided thick arc has the area of the annular sector") {
    Polyline arc;
    for (int i = 0; i <= 2000; ++i)
        arc.emplace_back(3 * std::cos(i * pi / 2000), 3 * std::sin(i * pi / 2000));
    // The pen follows the arc within a tenth of its arc tolerance: at most 0.001 of a radius of 3.
    const double chords = 0.001 / 3;
    CHECK(area(stroke(arc, false, {.width = 2.0})) == doctest::Approx(pi * 3 * 2).epsilon(chords));
    // A pen wider than the circle fills the half disc and does not fold back at the centre.
    const Region blob = stroke(arc, false, {.width = 7.0});
    CHECK(blob.size() == 1);
    CHECK(contains(blob, {0.1, 0.2}));
}

TEST_CASE("stroke: a line without length is a dot of the cap's form") {
    const Polyline point = {Vec2(1, 2), Vec2(1, 2)};
    CHECK(stroke(point, false, {.width = 2.0}).empty());
    CHECK(area(stroke(point, false, {.width = 2.0, .cap = LineCap::square})) == doctest::Approx(4.0));
    CHECK(area(stroke(point, true, {.width = 2.0, .cap = LineCap::round, .arc_tolerance = 1e-5})) ==
          doctest::Approx(pi).epsilon(1e-4));
    CHECK(stroke({}, false, {.width = 2.0}).empty());
    CHECK(stroke({Vec2(0, 0), Vec2(1, 0)}, false, {.width = 0.0}).empty());
}

TEST_CASE("stroke: every random line is covered on both sides of each segment") {
    CHECK(rc::check([] {
        Polyline line;
        const int count = *rc::gen::inRange(2, 8);
        for (int i = 0; i < count; ++i) {
            line.emplace_back(*rc::gen::inRange(-20, 20), *rc::gen::inRange(-20, 20));
        }
        const bool closed = *rc::gen::arbitrary<bool>();
        const auto join = *rc::gen::element(LineJoin::miter, LineJoin::round, LineJoin::bevel);
        const Region region = stroke(line, closed, {.width = 1.0, .join = join});
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const Vec2 along = line[i + 1] - line[i];
            if (along.norm() == 0.0) continue;
            const Vec2 across = Vec2(-along.y(), along.x()).normalized();
            for (const double t : {0.01, 0.35, 0.99}) {
                for (const double side : {-0.49, 0.01, 0.49}) {
                    RC_ASSERT(contains(region, line[i] + t * along + side * across));
                }
            }
        }
    }));
}

TEST_CASE("polygons: a coordinate that is not a number or absurdly far away is an input error") {
    Polyline loop = box(0, 0, 1, 1);
    loop[2].x() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(from_loops({loop}, FillRule::nonzero), InputError);
    loop[2].x() = 1e9;
    CHECK_THROWS_AS(from_loops({loop}, FillRule::nonzero), InputError);
}

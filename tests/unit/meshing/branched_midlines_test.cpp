#include "ruche/meshing/branched_midlines.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/geometry/polyline.hpp"
#include "ruche/pattern/centreline.hpp"

using namespace ruche;

namespace {

/// What strokes of the given width along lines cover, as one polygon.
Polygon pen(const std::vector<Polyline>& lines, double width, LineCap cap = LineCap::butt) {
    std::vector<Region> parts;
    for (const Polyline& line : lines) parts.push_back(stroke(line, false, {.width = width, .cap = cap}));
    const Region all = unite(parts);
    REQUIRE(all.size() == 1);
    return all.front();
}

/// The lines that are found, cut to the polygon, the longest first.
std::vector<Polyline> middles(const Polygon& polygon) {
    std::vector<Polyline> lines = cut_to_region(branched_midlines(polygon), {polygon});
    std::ranges::stable_sort(lines, {}, [](const Polyline& line) { return -length(line); });
    return lines;
}

double distance(const Vec2& p, const std::vector<Polyline>& lines) {
    double smallest = 1e300;
    for (const Polyline& line : lines)
        for (std::size_t i = 1; i < line.size(); ++i)
            smallest = std::min(smallest, distance_to_segment(p, line[i - 1], line[i]));
    return smallest;
}

/// The largest distance of a line's points from the drawn ones.
double error(const std::vector<Polyline>& found, const std::vector<Polyline>& drawn) {
    double largest = 0.0;
    for (const Polyline& line : found)
        for (const Vec2& p : line) largest = std::max(largest, distance(p, drawn));
    return largest;
}

Vec2 polar(double radius, double degrees) {
    const double a = degrees * std::numbers::pi / 180.0;
    return {radius * std::cos(a), radius * std::sin(a)};
}

// Borders lie on a grid of 1 nm, and what is half way between them is half a nm off.
constexpr double grid = 2e-6;

}  // namespace

TEST_CASE("branched midlines: a star has an arm for every tip, from the middle to the end") {
    for (const double turn : {0.0, 17.0}) {
        CAPTURE(turn);
        std::vector<Polyline> arms;
        for (const double angle : {0.0, 120.0, 240.0})
            arms.push_back({Vec2(1, 2), Vec2(1, 2) + polar(2.9, angle + turn)});
        const std::vector<Polyline> found = middles(pen(arms, 1.2));
        REQUIRE(found.size() == 3);
        for (const Polyline& line : found) CHECK(length(line) == doctest::Approx(2.9).epsilon(1e-5));
        CHECK(error(found, arms) < grid);
    }
}

TEST_CASE("branched midlines: lines that cross go straight through") {
    for (const double angle : {90.0, 60.0}) {
        CAPTURE(angle);
        const std::vector<Polyline> cross = {{Vec2(-10, 0), Vec2(10, 0)},
                                             {polar(-7, angle), polar(7, angle)}};
        const std::vector<Polyline> found = middles(pen(cross, 1.0));
        REQUIRE(found.size() == 2);
        CHECK(length(found[0]) == doctest::Approx(20.0).epsilon(1e-5));
        CHECK(length(found[1]) == doctest::Approx(14.0).epsilon(1e-5));
        CHECK(error(found, cross) < grid);
    }
}

TEST_CASE("branched midlines: a leg ends on the line that it meets") {
    const std::vector<Polyline> tee = {{Vec2(-10, 0), Vec2(10, 0)}, {Vec2(2, 0), Vec2(2, 8)}};
    for (const LineCap cap : {LineCap::butt, LineCap::square}) {
        const std::vector<Polyline> found = middles(pen(tee, 1.0, cap));
        REQUIRE(found.size() == 2);
        const double cap_length = cap == LineCap::butt ? 0.0 : 0.5;
        CHECK(length(found[0]) == doctest::Approx(20.0 + 2 * cap_length).epsilon(1e-5));
        // The middle of the junction is where its largest disc lies: within an eighth of the width of the
        // axis.
        CHECK(std::abs(length(found[1]) - 8.0 - cap_length) < 0.3);
        CHECK(error(found, {{Vec2(-11, 0), Vec2(11, 0)}, {Vec2(2, -1), Vec2(2, 9)}}) < grid);
    }
}

TEST_CASE("branched midlines: curved arms keep to their middle") {
    std::vector<Polyline> arms(3);
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i <= 90; ++i) {
            const double t = i / 90.0;
            arms[k].push_back(polar(1.0, 120.0 * k) * 12.0 * std::sin(t) +
                              polar(1.0, 120.0 * k + 90) * 12.0 * (1 - std::cos(t)));
        }
    const std::vector<Polyline> found = middles(pen(arms, 1.0, LineCap::round));
    REQUIRE(found.size() == 3);
    // An arc of 12 mm and its cap. The chord between points a quarter of the width apart sags by h^2 / 8 R.
    for (const Polyline& line : found) CHECK(length(line) == doctest::Approx(12.5).epsilon(0.02));
    CHECK(error(found, arms) < 0.5 + 0.01);
    for (const Polyline& line : found) {
        Polyline inner;
        for (const Vec2& p : line)
            if (p.norm() > 1.5 && p.norm() < 10.5) inner.push_back(p);
        CHECK(inner.size() > 20);
        CHECK(error({inner}, arms) < 0.01);
    }
}

TEST_CASE("branched midlines: a tiling is a line for every edge") {
    // Two squares of 10 mm beside each other.
    const std::vector<Polyline> frame = {{Vec2(0, 0), Vec2(20, 0), Vec2(20, 10), Vec2(0, 10), Vec2(0, 0)},
                                         {Vec2(10, 0), Vec2(10, 10)}};
    const Region covered =
        unite(std::vector<Region>{stroke({frame[0].begin(), frame[0].end() - 1}, true, {.width = 1.0}),
                                  stroke(frame[1], false, {.width = 1.0})});
    REQUIRE(covered.size() == 1);
    const std::vector<Polyline> found = middles(covered.front());
    double total = 0.0;
    for (const Polyline& line : found) total += length(line);
    // Corners are cut by less than the width each.
    CHECK(total > 70.0 - 4.0);
    CHECK(total < 70.0 + 1.0);
    CHECK(error(found, frame) < 0.5);
}

TEST_CASE("branched midlines: what does not branch has none") {
    const auto none = [](const Polygon& polygon) { return branched_midlines(polygon).empty(); };
    for (const LineCap cap : {LineCap::butt, LineCap::round, LineCap::square}) {
        CHECK(none(pen({{Vec2(0, 0), Vec2(20, 3)}}, 1.0, cap)));
        CHECK(none(pen({{Vec2(0, 0), Vec2(1.6, 0)}}, 1.0, cap)));
        CHECK(none(pen({{Vec2(0, 0), Vec2(10, 0), Vec2(10, 10), Vec2(4, 15)}}, 1.0, cap)));
    }
    Polyline arc;
    for (int i = 0; i <= 100; ++i) arc.push_back(polar(8.0, 2.7 * i));
    CHECK(none(pen({arc}, 1.5)));
    arc.pop_back();
    const Region ring = stroke(arc, true, {.width = 1.0});
    CHECK(none(ring.front()));
    CHECK(none({{Vec2(0, 0), Vec2(10, -1), Vec2(10, 1)}, {}}));
    CHECK(none({{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}, {}}));
}

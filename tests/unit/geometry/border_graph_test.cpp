#include "ruche/geometry/border_graph.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "ruche/geometry/polyline.hpp"

using namespace ruche;

namespace {

Region rectangle(double x0, double y0, double x1, double y1) {
    return {{{Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)}, {}}};
}

// Whether segments meet only at their ends and points keep their distance from all else.
bool is_clean(const BorderGraph& graph, double snap) {
    for (std::size_t i = 0; i < graph.segments.size(); ++i) {
        const auto& s = graph.segments[i].point;
        const Vec2& a = graph.points[s[0]];
        const Vec2& b = graph.points[s[1]];
        for (int p = 0; p < static_cast<int>(graph.points.size()); ++p) {
            if (p != s[0] && p != s[1] && distance_to_segment(graph.points[p], a, b) <= snap) return false;
        }
        for (std::size_t j = i + 1; j < graph.segments.size(); ++j) {
            const auto& t = graph.segments[j].point;
            const Vec2& c = graph.points[t[0]];
            const Vec2& d = graph.points[t[1]];
            if (t[0] == s[0] || t[0] == s[1] || t[1] == s[0] || t[1] == s[1]) continue;
            if (cross(b - a, c - a) * cross(b - a, d - a) < 0 &&
                cross(d - c, a - c) * cross(d - c, b - c) < 0) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

TEST_CASE("border graph: a border that two regions share is there once and knows both") {
    const std::vector<Region> regions = {rectangle(0, 0, 2, 1), rectangle(2, 0, 4, 1)};
    const BorderGraph graph = border_graph(regions, 1e-3);
    CHECK(graph.points.size() == 6);
    CHECK(graph.segments.size() == 7);
    const auto shared = std::count_if(graph.segments.begin(), graph.segments.end(), [](const auto& s) {
        return s.regions == std::vector<int>{0, 1};
    });
    CHECK(shared == 1);
}

TEST_CASE(
    "border graph: open lines come after the regions, cross borders and each other, and bound nothing") {
    const std::vector<Region> regions = {rectangle(0, 0, 4, 2)};
    const std::vector<Polyline> lines = {{Vec2(1, 1), Vec2(5, 1)}, {Vec2(2, 0.5), Vec2(2, 1.5), Vec2(3, 2)}};
    const BorderGraph graph = border_graph(regions, 1e-3, lines);
    CHECK(is_clean(graph, 1e-3));
    // 4 corners, ends and the bend of the lines, where they cross (2, 1), (4, 1); (3, 2) lies on the border.
    CHECK(graph.points.size() == 4 + 2 + 3 + 2);
    const auto of = [&](int number) {
        return std::count_if(graph.segments.begin(), graph.segments.end(), [&](const auto& s) {
            return std::find(s.regions.begin(), s.regions.end(), number) != s.regions.end();
        });
    };
    CHECK(of(0) == 6);
    CHECK(of(1) == 3);
    CHECK(of(2) == 3);
    CHECK(area(region_of(graph, 0)) == doctest::Approx(8.0));
}

TEST_CASE("border graph: crossing borders meet at a point of both") {
    const std::vector<Region> regions = {rectangle(0, 0, 3, 1), rectangle(1, -1, 2, 2)};
    const BorderGraph graph = border_graph(regions, 1e-3);
    CHECK(graph.points.size() == 12);
    CHECK(is_clean(graph, 1e-3));
    CHECK(area(region_of(graph, 0)) == doctest::Approx(3.0).epsilon(1e-12));
    CHECK(area(region_of(graph, 1)) == doctest::Approx(3.0).epsilon(1e-12));
}

TEST_CASE("border graph: borders closer than the snapping distance become one") {
    const std::vector<Region> regions = {rectangle(0, 0, 10, 1), rectangle(3, 1.0001, 7, 2)};
    const BorderGraph graph = border_graph(regions, 1e-3);
    CHECK(is_clean(graph, 1e-3));
    CHECK(area(region_of(graph, 0)) + area(region_of(graph, 1)) == doctest::Approx(14.0).epsilon(1e-4));
    const std::vector<Region> both = {region_of(graph, 0), region_of(graph, 1)};
    CHECK(unite(both).size() == 1);
}

TEST_CASE("border graph: a region's own borders that coincide vanish") {
    const Region twice = {rectangle(0, 0, 1, 1)[0], rectangle(1, 0, 2, 1)[0]};
    const BorderGraph graph = border_graph({&twice, 1}, 1e-3);
    CHECK(graph.segments.size() == 6);
    CHECK(region_of(graph, 0).size() == 1);
}

TEST_CASE("border graph: random overlapping triangles become clean, and a clean graph stays as it is") {
    CHECK(rc::check([] {
        std::vector<Region> regions;
        const int count = *rc::gen::inRange(1, 6);
        for (int i = 0; i < count; ++i) {
            Polyline loop;
            for (int k = 0; k < 3; ++k) {
                loop.emplace_back(*rc::gen::inRange(0, 1000) / 100.0, *rc::gen::inRange(0, 1000) / 100.0);
            }
            regions.push_back(region_from_loops({&loop, 1}, FillRule::nonzero));
        }
        constexpr double snap = 0.005;
        const BorderGraph graph = border_graph(regions, snap);
        RC_ASSERT(is_clean(graph, snap));
        std::vector<Region> cleaned;
        for (int i = 0; i < count; ++i) cleaned.push_back(region_of(graph, i));
        for (int i = 0; i < count; ++i) {
            // Each border, at most 30 mm long, moves by a few snapping distances at most.
            RC_ASSERT(std::abs(area(cleaned[i]) - area(regions[i])) < 30 * 3 * snap);
        }
        const BorderGraph again = border_graph(cleaned, 2e-6);
        for (int i = 0; i < count; ++i) {
            RC_ASSERT(std::abs(area(region_of(again, i)) - area(cleaned[i])) < 1e-12);
        }
    }));
}

TEST_CASE("simplify borders: shared borders stay shared, and the report bounds what was left out") {
    Polyline arc;  // the upper border of the lower region and the lower border of the upper one
    for (int i = 0; i <= 1000; ++i) arc.emplace_back(i * 0.01, 0.3 * std::sin(i * 0.01));
    Polyline lower = arc;
    lower.emplace_back(10, -3);
    lower.emplace_back(0, -3);
    std::reverse(lower.begin(), lower.end());
    Polyline upper = arc;
    upper.emplace_back(10, 3);
    upper.emplace_back(0, 3);
    const std::vector<Region> regions = {region_from_loops({&lower, 1}, FillRule::nonzero),
                                         region_from_loops({&upper, 1}, FillRule::nonzero)};
    BorderGraph graph = border_graph(regions, 2e-6);
    const std::size_t before = graph.segments.size();
    const std::vector<double> tolerance = {0.02, 0.01};
    const std::vector<double> shift = simplify_borders(graph, tolerance, 2e-6);
    CHECK(before > 900);
    CHECK(graph.segments.size() < 40);
    CHECK(shift[0] <= 0.01);
    CHECK(shift[0] > 0.001);
    CHECK(area(region_of(graph, 0)) + area(region_of(graph, 1)) == doctest::Approx(60.0).epsilon(1e-9));
    CHECK(intersect(region_of(graph, 0), region_of(graph, 1)).empty());
}

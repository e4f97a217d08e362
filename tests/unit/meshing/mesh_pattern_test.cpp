#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "pattern/sample_shapes.hpp"
#include "ruche/core/error.hpp"
#include "ruche/meshing/point_locator.hpp"
#include "ruche/meshing/print_mesh.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

double smallest_angle_deg(const TriangleMesh& mesh) {
    double largest_cosine = -1.0;
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const Vec2 a = mesh.vertices[t[(i + 1) % 3]] - mesh.vertices[t[i]];
            const Vec2 b = mesh.vertices[t[(i + 2) % 3]] - mesh.vertices[t[i]];
            largest_cosine = std::max(largest_cosine, a.dot(b) / (a.norm() * b.norm()));
        }
    }
    return std::acos(largest_cosine) * 180.0 / std::numbers::pi;
}

double area_where(const PrintMesh& mesh, const std::function<bool(int)>& counts) {
    double sum = 0.0;
    for (int t = 0; t < mesh.mesh.triangle_count(); ++t) {
        if (counts(t)) sum += layout_area(mesh.mesh, t);
    }
    return sum;
}

/// Counter-clockwise, conforming, vertex-manifold, nothing unused, a strip on each side that is printed.
bool is_sound(const PrintMesh& mesh) {
    const TriangleMesh& m = mesh.mesh;
    if (mesh.print.size() != m.triangles.size() || mesh.strip.size() != m.triangles.size()) return false;
    for (int t = 0; t < m.triangle_count(); ++t) {
        if (!(layout_area(m, t) > 0.0)) return false;
        if ((mesh.strip[t].front < 0) != (mesh.print[t].front == 0.0)) return false;
        if ((mesh.strip[t].back < 0) != (mesh.print[t].back == 0.0)) return false;
    }
    std::vector<int> border(m.vertices.size(), 0);
    std::vector<int> uses(m.vertices.size(), 0);
    for (const Triangle& t : m.triangles) {
        for (const int v : t) ++uses[v];
    }
    for (const Edge& edge : find_edges(m).edges) {  // throws unless edges are shared by two at most
        if (!edge.on_boundary()) continue;
        for (const int v : edge.vertex) ++border[v];
    }
    return std::all_of(border.begin(), border.end(), [](int n) { return n == 0 || n == 2; }) &&
           std::all_of(uses.begin(), uses.end(), [](int n) { return n > 0; });
}

// Every triangle lies on one side of every border: its centroid decides for all of it, so areas add up
// exactly.
void check_areas(const Pattern& pattern, const PrintMesh& mesh) {
    const double fabric = area(pattern.fabric);
    CHECK(std::abs(area_where(mesh, [](int) { return true; }) - fabric) <= 1e-9 * fabric);
    for (const Side side : {Side::front, Side::back}) {
        double drawn = 0.0;
        for (const Strip& s : pattern.strips) drawn += s.side == side ? area(s.region) : 0.0;
        const double meshed = area_where(mesh, [&](int t) {
            return (side == Side::front ? mesh.print[t].front : mesh.print[t].back) > 0.0;
        });
        CHECK(std::abs(meshed - drawn) <= 1e-9 * drawn);
    }
}

Pattern staggered(int rows, int columns) {
    Pattern pattern;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const double x = 15.0 * i + 7.5 * (j % 2);
            pattern.strips.push_back(
                strip("s" + std::to_string(columns * j + i), {Vec2(x, 5.0 * j), Vec2(x + 12, 5.0 * j)}, 1.0));
        }
    }
    return finish_pattern(pattern, 5.0);
}

std::string error_of(const Pattern& pattern, const MeshOptions& options = {}) {
    try {
        mesh_pattern(pattern, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("mesh: a single strip is made of whole elements, its area is exact") {
    Pattern drawn;
    drawn.strips = {strip("a", {Vec2(0, 0), Vec2(30, 0)}, 1.0)};
    const Pattern pattern = finish_pattern(drawn, 5.0);
    const PrintMesh mesh = mesh_pattern(pattern);
    CHECK(is_sound(mesh));
    check_areas(pattern, mesh);
    CHECK(smallest_angle_deg(mesh.mesh) > 20.0);
    const auto plastic =
        std::count_if(mesh.print.begin(), mesh.print.end(), [](const Print& p) { return !p.bare(); });
    CHECK(plastic == 60);
    REQUIRE(mesh.strips.size() == 1);
    CHECK(mesh.strips[0].id == "a");
}

TEST_CASE("mesh: size, elements across and fabric size do what they say") {
    Pattern drawn;
    drawn.strips = {strip("a", {Vec2(0, 0), Vec2(30, 0)}, 4.0, 1.0)};
    const Pattern pattern = finish_pattern(drawn, 20.0);
    const auto longest_edge = [](const PrintMesh& mesh, bool plastic) {
        double longest = 0.0;
        for (int t = 0; t < mesh.mesh.triangle_count(); ++t) {
            if (mesh.print[t].bare() == plastic) continue;
            const Triangle& tri = mesh.mesh.triangles[t];
            for (int i = 0; i < 3; ++i) {
                const Vec2 e = mesh.mesh.vertices[tri[i]] - mesh.mesh.vertices[tri[(i + 1) % 3]];
                longest = std::max(longest, e.norm());
            }
        }
        return longest;
    };
    const PrintMesh usual = mesh_pattern(pattern);
    CHECK(longest_edge(usual, true) <= 1.45);
    CHECK(longest_edge(usual, true) > 0.9);
    CHECK(longest_edge(usual, false) <= 2.9);
    CHECK(longest_edge(usual, false) > 1.8);
    CHECK(longest_edge(mesh_pattern(pattern, {.elements_across = 8.0}), true) <= 0.5 * 1.45);
    CHECK(longest_edge(mesh_pattern(pattern, {.size_mm = 2.0}), true) > 1.8);
    CHECK(longest_edge(mesh_pattern(pattern, {.fabric_size_mm = 4.0}), false) > 3.5);
    CHECK(mesh_pattern(pattern, {.fabric_size_mm = 4.0, .grading = 0.05}).mesh.triangle_count() >
          2 * mesh_pattern(pattern, {.fabric_size_mm = 4.0, .grading = 1.0}).mesh.triangle_count());
}

TEST_CASE("mesh: subdivisions nest meshes") {
    Pattern drawn;
    drawn.strips = {strip("front", {Vec2(0, 0), Vec2(12, 0)}, 2.0, 1.0),
                    strip("back", {Vec2(3, -4), Vec2(6, 5)}, 1.5, 0.6, Side::back)};
    const Pattern pattern = finish_pattern(drawn, 3.0);
    const PrintMesh once = mesh_pattern(pattern, {.centre_lines = true});
    for (const int n : {1, 2}) {
        const PrintMesh finer = mesh_pattern(pattern, {.subdivisions = n, .centre_lines = true});
        CHECK(is_sound(finer));
        CHECK(finer.mesh.triangle_count() == (1 << 2 * n) * once.mesh.triangle_count());
        CHECK(smallest_angle_deg(finer.mesh) == doctest::Approx(smallest_angle_deg(once.mesh)));
        // Every triangle lies in one of the coarser mesh, and carries its print.
        const PointLocator locator(once.mesh);
        const auto carries_its_print = [&](int t) {
            const Triangle& v = finer.mesh.triangles[t];
            const Vec2 middle =
                (finer.mesh.vertices[v[0]] + finer.mesh.vertices[v[1]] + finer.mesh.vertices[v[2]]) / 3.0;
            const std::optional<MeshPoint> at = locator.find(middle, 1e-9);
            return at && finer.print[t] == once.print[at->triangle] &&
                   finer.strip[t] == once.strip[at->triangle];
        };
        for (int t = 0; t < finer.mesh.triangle_count(); ++t) REQUIRE(carries_its_print(t));
        for (const std::size_t s : {0U, 1U}) {
            CHECK(finer.strips[s].centreline[0].size() >
                  (1U << n) * (once.strips[s].centreline[0].size() - 2));
            const std::size_t pieces = once.strips[s].edge_lines[0].vertices.size() - 1;
            CHECK(finer.strips[s].edge_lines[0].vertices.size() - 1 == (1U << n) * pieces);
        }
    }
    CHECK(error_of(pattern, {.subdivisions = 6}).empty());
    CHECK(error_of(pattern, {.size_mm = 0.1, .fabric_size_mm = 0.1, .subdivisions = 6})
              .find("Choose mesh.size_mm") != std::string::npos);
}

TEST_CASE("mesh: thin and wide strips get smaller elements where they need them, in proportion to the size") {
    const auto triangles = [](double width, double thickness, double size) {
        Pattern drawn;
        drawn.strips = {strip("a", {Vec2(0, 0), Vec2(60, 0)}, width, thickness)};
        return 1.0 * mesh_pattern(finish_pattern(drawn, 0.0), {.size_mm = size}).mesh.triangle_count();
    };
    const auto elements_of = [](double size) { return doctest::Approx(1.0 / (size * size)).epsilon(0.15); };
    // It curls across its width: 0.38 * 19 * 0.6^2 / 5 = 0.52 mm. Thicker it does not.
    CHECK(triangles(5.0, 0.6, 1.0) / triangles(5.0, 1.2, 1.0) == elements_of(0.52));
    CHECK(triangles(5.0, 0.6, 0.5) / triangles(5.0, 1.2, 0.5) == elements_of(0.52));
    // Too narrow for that, or so wide that only its rims curl.
    CHECK(triangles(1.0, 0.6, 1.0) == triangles(1.0, 1.2, 1.0));
    CHECK(triangles(14.0, 0.6, 1.0) == triangles(14.0, 1.8, 1.0));
    // Strongly curved: 19 * 0.4^2 / 4.5 = 0.68 mm; however thin, no smaller than 0.35 of the size.
    CHECK(triangles(14.0, 0.4, 1.0) / triangles(14.0, 1.8, 1.0) == elements_of(0.68));
    CHECK(triangles(14.0, 0.1, 1.0) / triangles(14.0, 1.8, 1.0) == elements_of(0.35));
}

TEST_CASE("mesh: a strip thinner than an element keeps exactly its area") {
    Pattern drawn;
    drawn.strips = {strip("hair", {Vec2(0, 0.3), Vec2(10, 3.7)}, 0.12)};
    const Pattern pattern = finish_pattern(drawn, 3.0);
    const PrintMesh mesh = mesh_pattern(pattern, {.size_mm = 2.0, .elements_across = 0.5});
    CHECK(is_sound(mesh));
    check_areas(pattern, mesh);
    CHECK(smallest_angle_deg(mesh.mesh) > 20.0);
}

TEST_CASE("mesh: front over back carries both prints and both strips, the thicker one stands for them") {
    Pattern drawn;
    drawn.strips = {strip("front", {Vec2(0, 0), Vec2(20, 0)}, 2.0, 0.6, Side::front),
                    strip("back", {Vec2(10, -10), Vec2(10, 10)}, 3.0, 0.9, Side::back)};
    drawn.strips[0].youngs_modulus = 50;
    const Pattern pattern = finish_pattern(drawn, 4.0);
    const PrintMesh mesh = mesh_pattern(pattern);
    CHECK(is_sound(mesh));
    check_areas(pattern, mesh);
    const double both = area_where(mesh, [&](int t) { return mesh.print[t] == Print{0.6, 0.9, 50.0, 0.0}; });
    CHECK(both == doctest::Approx(6.0).epsilon(1e-9));
    const auto check_area = [&](double expected, const std::function<bool(int)>& counts) {
        CHECK(area_where(mesh, counts) == doctest::Approx(expected).epsilon(1e-9));
    };
    check_area(40.0, [&](int t) { return mesh.strip[t].front == 0; });
    check_area(60.0, [&](int t) { return mesh.strip[t].back == 1; });
    check_area(6.0, [&](int t) { return mesh.strip[t] == StripPair{0, 1}; });
    check_area(34.0, [&](int t) { return main_strip(mesh, t) == 0; });
    check_area(60.0, [&](int t) { return main_strip(mesh, t) == 1; });
    // The thinner strip's centre line runs through under the other side's strip.
    REQUIRE(mesh.strips[0].centreline.size() == 1);
    CHECK(mesh.strips[0].centreline[0].size() == 41);
}

TEST_CASE("mesh: centre lines are evenly spaced points on the strip's own triangles") {
    Pattern drawn;
    drawn.strips = {strip("a", {Vec2(0, 0), Vec2(10.3, 7.1)}, 1.0),
                    strip("b", {Vec2(10, 0), Vec2(0, 8)}, 1.0, 0.9)};
    const Pattern pattern = finish_pattern(drawn, 4.0);
    const PrintMesh mesh = mesh_pattern(pattern);
    for (int s = 0; s < 2; ++s) {
        CHECK(mesh.strips[s].centreline.size() == (s == 0 ? 2 : 1));
        for (const std::vector<MeshPoint>& line : mesh.strips[s].centreline) {
            REQUIRE(line.size() >= 2);
            const double step = (position(mesh.mesh, line[1]) - position(mesh.mesh, line[0])).norm();
            CHECK(step <= 0.5);
            for (std::size_t i = 0; i < line.size(); ++i) {
                CHECK(mesh.strip[line[i].triangle] == StripPair{.front = s});
                if (i == 0) continue;
                const Vec2 along = position(mesh.mesh, line[i]) - position(mesh.mesh, line[i - 1]);
                CHECK(along.norm() == doctest::Approx(step).epsilon(1e-6));
            }
        }
    }
}

TEST_CASE("mesh: holes in the fabric stay open, plastic may reach the edge") {
    Pattern drawn;
    Polyline hole = circle({0, 0}, 5, 48);
    std::reverse(hole.begin(), hole.end());
    drawn.fabric = {{circle({0, 0}, 20, 96), {hole}}};
    drawn.strips = {strip("a", {Vec2(-30, 9), Vec2(30, 9)}, 1.0),
                    strip("b", {Vec2(0, 0), Vec2(0, -30)}, 2.0)};
    const Pattern pattern = finish_pattern(drawn, 0.0);
    const PrintMesh mesh = mesh_pattern(pattern);
    CHECK(is_sound(mesh));
    check_areas(pattern, mesh);
    CHECK(find_pieces(mesh.mesh).count == 1);
    const int euler = mesh.mesh.vertex_count() - static_cast<int>(find_edges(mesh.mesh).edges.size()) +
                      mesh.mesh.triangle_count();
    CHECK(euler == 0);  // an annulus
}

TEST_CASE("mesh: without a margin there is only plastic") {
    Pattern drawn;
    drawn.strips = {strip("a", {Vec2(0, 0), Vec2(30, 0)}, 1.0)};
    const PrintMesh mesh = mesh_pattern(finish_pattern(drawn, 0.0));
    CHECK(mesh.mesh.triangle_count() == 60);
    CHECK(std::none_of(mesh.print.begin(), mesh.print.end(), [](const Print& p) { return p.bare(); }));
}

TEST_CASE("mesh: bare fabric can be meshed") {
    Pattern pattern;
    pattern.fabric = {{box(0, 0, 20, 10), {}}};
    const PrintMesh mesh = mesh_pattern(finish_pattern(pattern, 0.0, true));
    CHECK(is_sound(mesh));
    CHECK(area_where(mesh, [](int) { return true; }) == doctest::Approx(200.0).epsilon(1e-12));
}

TEST_CASE("mesh: the same pattern gives the same bits") {
    const Pattern pattern = staggered(3, 3);
    const PrintMesh one = mesh_pattern(pattern);
    const std::vector<double> disturb_the_heap(100000, 1.0);
    const PrintMesh two = mesh_pattern(pattern);
    CHECK(one.mesh.vertices == two.mesh.vertices);
    CHECK(one.mesh.triangles == two.mesh.triangles);
    CHECK(one.print == two.print);
}

TEST_CASE("mesh: numbers are spatially coherent") {
    const PrintMesh mesh = mesh_pattern(staggered(6, 4));
    double spread = 0.0;
    for (const Triangle& t : mesh.mesh.triangles) {
        spread += std::max({t[0], t[1], t[2]}) - std::min({t[0], t[1], t[2]});
    }
    // In random order the mean spread would be half the vertices.
    CHECK(spread / mesh.mesh.triangle_count() < 0.06 * mesh.mesh.vertex_count());
}

TEST_CASE("mesh: borders that almost touch give a finite mesh or a clear error") {
    for (const double gap : {1e-6, 1e-4, 4.9e-3, 5.1e-3, 0.02}) {
        Pattern drawn;
        drawn.strips = {strip("a", {Vec2(0, 0), Vec2(10, 0)}, 1.0),
                        strip("b", {Vec2(0, 1.0 + gap), Vec2(10, 1.0 + gap)}, 1.0)};
        const Pattern pattern = finish_pattern(drawn, 2.0);
        const PrintMesh mesh = mesh_pattern(pattern);
        CHECK(is_sound(mesh));
        check_areas(pattern, mesh);
        CHECK(mesh.mesh.triangle_count() < 20000);
    }
    // Not finished: nothing was snapped together.
    Pattern raw;
    raw.strips = {strip("a", {Vec2(0, 0), Vec2(30, 0)}, 1.0),
                  strip("b", {Vec2(0, 1.0001), Vec2(30, 1.0001)}, 1.0)};
    raw.fabric = {{box(-2, -2, 32, 3), {}}};
    CHECK(error_of(raw).find("closer to each other than the element size") != std::string::npos);
}

TEST_CASE("mesh: sharp input angles do not make the mesh explode") {
    Pattern drawn;
    for (const double degrees : {0.0, 1.0, 3.0, 10.0, 30.0}) {
        const double a = degrees * std::numbers::pi / 180.0;
        drawn.strips.push_back(strip("s" + std::to_string(degrees),
                                     {Vec2(0, 0), Vec2(20 * std::cos(a), 20 * std::sin(a))}, 1.0));
    }
    const Polyline needle = {Vec2(0, -5), Vec2(30, -6.7), Vec2(30, -3.3)};
    drawn.strips.push_back({.id = "needle", .region = {{needle, {}}}, .centreline = {}});
    const Pattern pattern = finish_pattern(drawn, 4.0);
    const PrintMesh mesh = mesh_pattern(pattern);
    CHECK(is_sound(mesh));
    check_areas(pattern, mesh);
    CHECK(mesh.mesh.triangle_count() < 20000);
}

TEST_CASE("mesh: parts that touch at a single point are an error that names the place") {
    Pattern pattern;
    pattern.strips = {strip("a", {Vec2(0, 0.5), Vec2(5, 0.5)}, 1.0),
                      strip("b", {Vec2(5, 1.5), Vec2(10, 1.5)}, 1.0)};
    const std::string message = error_of(finish_pattern(pattern, 0.0));
    CHECK(message.find("single point, x = 5, y = 1 mm") != std::string::npos);
}

TEST_CASE("mesh: separate pieces of fabric are allowed with a warning") {
    Pattern pattern;
    pattern.strips = {strip("a", {Vec2(0, 0), Vec2(5, 0)}, 1.0), strip("b", {Vec2(0, 9), Vec2(5, 9)}, 1.0)};
    const PrintMesh mesh = mesh_pattern(finish_pattern(pattern, 1.0));
    REQUIRE(mesh.warnings.size() == 1);
    CHECK(mesh.warnings[0].find("2 separate pieces") != std::string::npos);
}

TEST_CASE("mesh: a size that would take too many triangles is an error that proposes one") {
    const Pattern pattern = staggered(2, 2);
    const std::string message = error_of(pattern, {.size_mm = 0.001, .fabric_size_mm = 0.001});
    CHECK(message.find("Choose mesh.size_mm") != std::string::npos);
    for (const double bad : {0.0, -1.0, std::nan("")}) {
        CHECK(error_of(pattern, {.size_mm = bad}).find("mesh.size_mm") != std::string::npos);
        CHECK(error_of(pattern, {.elements_across = bad}).find("mesh.elements_across") != std::string::npos);
        CHECK(error_of(pattern, {.fabric_size_mm = bad}).find("mesh.fabric_size_mm") != std::string::npos);
    }
    CHECK(error_of(pattern, {.grading = -1.0}).find("mesh.grading") != std::string::npos);
    CHECK(error_of({}).find("no fabric") != std::string::npos);
}

TEST_CASE("mesh: random overlapping strips give sound meshes with exact areas") {
    CHECK(rc::check([] {
        Pattern drawn;
        const int count = *rc::gen::inRange(1, 7);
        const auto coordinate = [] { return *rc::gen::inRange(0, 2500) / 100.0; };
        for (int i = 0; i < count; ++i) {
            const Vec2 a(coordinate(), coordinate());
            const Vec2 b(coordinate(), coordinate());
            if ((b - a).norm() < 2.0) continue;
            drawn.strips.push_back(strip("s" + std::to_string(i), {a, b}, *rc::gen::inRange(5, 30) / 10.0,
                                         *rc::gen::inRange(4, 10) / 10.0,
                                         *rc::gen::arbitrary<bool>() ? Side::front : Side::back));
        }
        RC_PRE(!drawn.strips.empty());
        const Pattern pattern = finish_pattern(drawn, 3.0);
        const PrintMesh mesh = mesh_pattern(pattern);
        RC_ASSERT(is_sound(mesh));
        check_areas(pattern, mesh);
        RC_ASSERT(mesh.strips.size() == pattern.strips.size());
        RC_ASSERT(mesh.mesh.triangle_count() < 40000);
    }));
}

TEST_CASE("mesh: a filled star has a centre line in every arm, as a stroked one has") {
    const Polyline cross = {Vec2(5, 0),  Vec2(6, 0),  Vec2(6, 5), Vec2(11, 5), Vec2(11, 6), Vec2(6, 6),
                            Vec2(6, 11), Vec2(5, 11), Vec2(5, 6), Vec2(0, 6),  Vec2(0, 5),  Vec2(5, 5)};
    const PrintMesh mesh = mesh_pattern(make_pattern(drawing({filled("cross", cross)}), {}));
    const auto& lines = mesh.strips.at(0).centreline;
    REQUIRE(lines.size() == 2);
    for (const std::vector<MeshPoint>& line : lines) {
        const auto place = [&](const MeshPoint& at) {
            Vec2 x = Vec2::Zero();
            for (int i = 0; i < 3; ++i)
                x += at.weights[i] * mesh.mesh.vertices[mesh.mesh.triangles[at.triangle][i]];
            return x;
        };
        // From one end to the other through the middle, on the grid of 1 nm.
        CHECK((place(line.back()) - place(line.front())).norm() == doctest::Approx(11.0).epsilon(1e-6));
        CHECK((0.5 * (place(line.back()) + place(line.front())) - Vec2(5.5, 5.5)).norm() < 1e-5);
    }
}

TEST_CASE("mesh: away from sharp input angles every angle is above 20 degrees") {
    CHECK(rc::check([] {
        Pattern drawn;
        for (int i = 0; i < 6;
             ++i) {  // each in its own 12 mm cell, any direction, sometimes only 0.2 mm apart
            const Vec2 centre(12.0 * (i % 3), 12.0 * (i / 3));
            const double angle = *rc::gen::inRange(0, 314) / 100.0;
            const Vec2 arm = *rc::gen::inRange(10, 57) / 10.0 * Vec2(std::cos(angle), std::sin(angle));
            drawn.strips.push_back(strip("s" + std::to_string(i), {centre - arm, centre + arm},
                                         *rc::gen::inRange(2, 12) / 10.0));
        }
        // An offset outline may have sharp corners where two arcs meet; a box has none.
        drawn.fabric = {{box(-8, -8, 32, 20), {}}};
        const PrintMesh mesh = mesh_pattern(finish_pattern(drawn, 0.0));
        RC_ASSERT(smallest_angle_deg(mesh.mesh) > 20.0);
    }));
}

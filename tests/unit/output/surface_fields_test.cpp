#include "ruche/output/surface_fields.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "output/sample_results.hpp"

using namespace ruche;

TEST_CASE("surface fields: print, side and strip come from the layout, triangle by triangle") {
    const Result result = sample::rolled_sheet();
    const SurfaceFields fields = surface_fields(result);
    const std::size_t count = result.layout.mesh.triangles.size();
    REQUIRE(fields.side.size() == count);
    int seen[4] = {0, 0, 0, 0};
    for (std::size_t t = 0; t < count; ++t) {
        CHECK(fields.front_mm[t] == result.layout.print[t].front);
        CHECK(fields.back_mm[t] == result.layout.print[t].back);
        CHECK(fields.strip[t] == main_strip(result.layout, static_cast<int>(t)));
        CHECK(fields.strips[t] == result.layout.strip[t]);
        const int side = (fields.front_mm[t] > 0 ? 1 : 0) + (fields.back_mm[t] > 0 ? 2 : 0);
        CHECK(static_cast<int>(fields.side[t]) == side);
        ++seen[side];
    }
    CHECK(seen[1] == 2 * 26 * 2);
    CHECK(seen[2] == 2 * 26 * 2);
    CHECK(seen[3] == 2 * 26 * 2);
    CHECK(fields.energy_density.empty());
}

TEST_CASE("surface fields: stretches are the singular values of the map from layout to shape") {
    // A linear map: 0.5 along a direction at 30 degrees, 0.8 across, then turned in space.
    const double c = std::cos(0.5236), s = std::sin(0.5236);
    const auto map = [=](const Vec2& p) {
        const double u = 0.5 * (c * p.x() + s * p.y()), v = 0.8 * (-s * p.x() + c * p.y());
        return Vec3(0.6 * u, v, 0.8 * u);
    };
    const Result result = sample::result(sample::grid({.nx = 6, .ny = 5, .jitter = 0.4}), {}, map);
    const SurfaceFields fields = surface_fields(result);
    for (std::size_t t = 0; t < fields.stretch_max.size(); ++t) {
        CHECK(fields.stretch_max[t] == doctest::Approx(0.8).epsilon(1e-12));
        CHECK(fields.stretch_min[t] == doctest::Approx(0.5).epsilon(1e-12));
        CHECK((fields.face_normal[t] - Vec3(-0.8, 0, 0.6)).norm() < 1e-12);
    }
    for (const VertexCurvature& k : fields.vertex_curvature) CHECK(std::abs(k.max) + std::abs(k.min) < 1e-10);
}

TEST_CASE("surface fields: a roll that is concave at the back has positive curvature 1/R up to its borders") {
    const Result result = sample::rolled_sheet(12.0, 2);
    const SurfaceFields fields = surface_fields(result);
    for (const VertexCurvature& k : fields.face_curvature) {
        CHECK(k.max == doctest::Approx(1.0 / 12.0).epsilon(0.005));
        CHECK(std::abs(k.min) < 0.005 / 12.0);
        CHECK(std::abs(k.gauss()) < 1e-4);
    }
}

TEST_CASE("surface fields: the given energy density is passed through") {
    const Result result = sample::rolled_sheet();
    std::vector<double> density(result.layout.mesh.triangles.size());
    for (std::size_t t = 0; t < density.size(); ++t) density[t] = 0.1 * static_cast<double>(t);
    CHECK(surface_fields(result, density).energy_density == density);
}

TEST_CASE("surface fields: triangles that pass through others are marked, and only those") {
    Result result = sample::rolled_sheet();
    CHECK(std::ranges::count(surface_fields(result).passes_through, 1) == 0);
    result.self_intersections = {{{1, 4}, Vec3::Zero()}, {{4, 6}, Vec3::Zero()}};
    const std::vector<char> marks = surface_fields(result).passes_through;
    REQUIRE(marks.size() == result.layout.mesh.triangles.size());
    CHECK(std::ranges::count(marks, 1) == 3);
    for (const int t : {1, 4, 6}) CHECK(marks[t] == 1);
}

#include "ruche/study/scan/skin.hpp"

#include <doctest/doctest.h>

#include "output/sample_results.hpp"

using namespace ruche;

static double area_of(const std::vector<Corners>& triangles) {
    double area = 0.0;
    for (const Corners& t : triangles) area += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    return area;
}

TEST_CASE("skin: a print's upright sides go once around it, as high as it is thick") {
    const auto strip = [](const Vec2& p) { return p.x() > 2 && p.x() < 10 && p.y() > 2 && p.y() < 4; };
    const auto flat = [](const Vec2& p) { return Vec3(p.x(), p.y(), 0.0); };
    const Result result = sample::result(sample::grid({.width = 12, .height = 6, .nx = 12, .ny = 6}),
                                         {{"a", strip, {.front = 0.7}}}, flat);
    const SurfaceFields fields = surface_fields(result);
    CHECK(area_of(sides_of_print(result, front_skin(result, fields))) == doctest::Approx(2 * (8 + 2) * 0.7));
    CHECK(sides_of_print(result, back_skin(result, fields)).empty());
    CHECK(area_of(front_skin(result, fields)) == doctest::Approx(12 * 6));
}

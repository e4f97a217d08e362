#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "ruche/pattern/svg_transform.hpp"

using namespace ruche;
using namespace ruche::svg;

static void check_maps(const char* text, const Vec2& from, const Vec2& to) {
    CAPTURE(std::string(text));
    const auto map = parse_transform(text);
    REQUIRE(map);
    CHECK((*map * from - to).norm() < 1e-12);
}

TEST_CASE("svg transform: each function does what SVG says") {
    check_maps("matrix(1 2 3 4 5 6)", {10, 100}, {10 + 300 + 5, 20 + 400 + 6});
    check_maps("translate(3)", {1, 1}, {4, 1});
    check_maps("translate(3,-4)", {1, 1}, {4, -3});
    check_maps("scale(2)", {1, 3}, {2, 6});
    check_maps("scale(2 -1)", {1, 3}, {2, -3});
    check_maps("rotate(90)", {1, 0}, {0, 1});
    check_maps("rotate(90, 10, 10)", {11, 10}, {10, 11});
    check_maps("skewX(45)", {1, 2}, {3, 2});
    check_maps("skewY(45)", {1, 2}, {1, 3});
    check_maps("rotate(0.25turn)", {1, 0}, {0, 1});
    check_maps("rotate(100grad)", {1, 0}, {0, 1});
    check_maps("translate(3px, 4px) rotate(90deg)", {1, 0}, {3, 5});
    check_maps("", {1, 2}, {1, 2});
    check_maps("none", {1, 2}, {1, 2});
}

TEST_CASE("svg transform: the last function of a list is applied first") {
    check_maps("translate(10 0) scale(2)", {1, 1}, {12, 2});
    check_maps("scale(2),translate(10 0)", {1, 1}, {22, 2});
    check_maps("  scale( 2 ) , rotate(-90)\n", {1, 0}, {0, -2});
}

TEST_CASE("svg transform: quarter turns are exact") {
    const auto map = parse_transform("rotate(-270)");
    CHECK((*map * Vec2(3, 0)) == Vec2(0, 3));
}

TEST_CASE("svg transform: what cannot be read is none") {
    for (const char* text :
         {"rotte(4)", "scale", "scale(", "scale()", "scale(1 2 3)", "matrix(1 0 0 1 0)", "translate(1 mm)",
          "rotate(1 2)", "scale(nan)", "scale(1e999)", "rotate(3) x", "scale(1e300) scale(1e300)"}) {
        CAPTURE(std::string(text));
        CHECK_FALSE(parse_transform(text));
    }
}

TEST_CASE("svg transform: stretches are the singular values") {
    const Stretches s = stretches((*parse_transform("rotate(20) scale(3 0.5) rotate(50)")).linear);
    CHECK(s.largest == doctest::Approx(3.0).epsilon(1e-12));
    CHECK(s.smallest == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("svg viewBox: preserveAspectRatio places it as SVG's table says") {
    const svg::Box box{{10, 20}, {100, 50}};
    struct Case {
        const char* aspect;
        Vec2 corner;  // where (10, 20) comes to lie in a viewport of 200 x 200
        double x_scale, y_scale;
    };
    for (const auto& [aspect, corner, x_scale, y_scale] : {Case{"", {0, 50}, 2, 2},
                                                           {"xMidYMid meet", {0, 50}, 2, 2},
                                                           {"xMinYMin", {0, 0}, 2, 2},
                                                           {"xMaxYMax meet", {0, 100}, 2, 2},
                                                           {"none", {0, 0}, 2, 4},
                                                           {"xMidYMid slice", {-100, 0}, 4, 4},
                                                           {"xMinYMax slice", {0, 0}, 4, 4},
                                                           {"xMaxYMin slice", {-200, 0}, 4, 4},
                                                           {"defer xMinYMin", {0, 0}, 2, 2}}) {
        CAPTURE(std::string(aspect));
        const auto map = fit_view_box(box, {200, 200}, aspect);
        REQUIRE(map);
        CHECK((*map * Vec2(10, 20) - corner).norm() < 1e-12);
        CHECK((*map * Vec2(110, 70) - corner - Vec2(100 * x_scale, 50 * y_scale)).norm() < 1e-12);
    }
    for (const char* aspect : {"xMid", "xMidYmid", "middle", "xMidYMid fill", "xMidYMid meet x"}) {
        CAPTURE(std::string(aspect));
        CHECK_FALSE(fit_view_box(box, {200, 200}, aspect));
    }
    CHECK_FALSE(parse_view_box("0 0 100"));
    CHECK_FALSE(parse_view_box("0 0 100 nan"));
    CHECK(parse_view_box(" 0,0,100,50 "));
}

#include <doctest/doctest.h>

#include <string>

#include "svg_text.hpp"

using namespace ruche;
using svg_text::extent;

static std::string square(const std::string& svg_attributes, const std::string& side = "10") {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + svg_attributes + "><rect width=\"" + side +
           "\" height=\"" + side + "\"/></svg>";
}

TEST_CASE("svg page: width, height and viewBox give the physical size in every unit") {
    struct Case {
        const char* attributes;
        double width, height, side;  // mm
        bool warns;
    };
    for (const Case& c :
         {Case{"width='120mm' height='80mm' viewBox='0 0 120 80'", 120, 80, 10, false},
          {"width='12cm' height='8cm' viewBox='0 0 240 160'", 120, 80, 5, false},
          {"width='2in' height='1in'", 50.8, 25.4, 10 * 25.4 / 96, false},
          {"width='72pt' height='144pt' viewBox='0 0 72 144'", 25.4, 50.8, 10 * 25.4 / 72, false},
          {"width='6pc' height='12pc' viewBox='0 0 6 12'", 25.4, 50.8, 254 / 6.0, false},
          {"width='96' height='192'", 25.4, 50.8, 10 * 25.4 / 96, true},
          {"width='96px' height='192px' viewBox='0 0 100 200'", 25.4, 50.8, 2.54, true},
          {"viewBox='0 0 960 480'", 254, 127, 10 * 25.4 / 96, true},
          {"width='100%' height='100%' viewBox='0 0 960 480'", 254, 127, 10 * 25.4 / 96, true},
          {"width='100mm' viewBox='0 0 50 20'", 100, 40, 20, false},
          {"height='40mm' viewBox='0 0 50 20'", 100, 40, 20, false},
          {"width='100mm' height='100mm' viewBox='0 0 50 20'", 100, 100, 20, false},
          {"width='100mm' height='100mm' viewBox='0 0 50 20' preserveAspectRatio='xMinYMin slice'", 100, 100,
           50, false}}) {
        CAPTURE(std::string(c.attributes));
        const Drawing drawing = svg_text::read(square(c.attributes));
        CHECK(drawing.width == doctest::Approx(c.width).epsilon(1e-12));
        CHECK(drawing.height == doctest::Approx(c.height).epsilon(1e-12));
        REQUIRE(drawing.shapes.size() == 1);
        // The polygons lie on a grid of 1 nm.
        CHECK(area(drawing.shapes[0].filled) == doctest::Approx(c.side * c.side).epsilon(1e-6));
        CHECK(svg_text::warns(drawing, "96 px per inch") == c.warns);
    }
}

TEST_CASE("svg page: the guess says the size in mm, at 96 and at Illustrator's 72 px per inch") {
    const Drawing drawing = svg_text::read(square("viewBox='0 0 283.46 141.73'"));
    CHECK(svg_text::warns(drawing, "the page is 75.00 x 37.50 mm"));
    CHECK(svg_text::warns(drawing, "100.00 x 50.00 mm"));
    CHECK(svg_text::warns(drawing, "--width-mm"));
}

TEST_CASE("svg page: width_mm scales everything, also a physical size, and ends the guessing") {
    const DrawingOptions wide{.width_mm = 60.0};
    for (const char* attributes : {"viewBox='0 0 30 20'", "width='30mm' height='20mm' viewBox='0 0 30 20'"}) {
        const Drawing drawing = svg_text::read(square(attributes), wide);
        CHECK(drawing.width == doctest::Approx(60.0));
        CHECK(drawing.height == doctest::Approx(40.0));
        CHECK(area(drawing.shapes.at(0).filled) == doctest::Approx(400.0).epsilon(1e-12));
        CHECK(drawing.warnings.empty());
    }
    const Drawing stroked = svg_text::read(
        "<svg viewBox='0 0 30 20'><path d='M0 10H30' stroke='red' stroke-width='1.5'/></svg>", wide);
    CHECK(stroked.shapes.at(0).stroke_width == doctest::Approx(3.0));
}

TEST_CASE("svg page: without any size the page is taken around the drawing") {
    const Drawing drawing = svg_text::read("<svg><rect x='96' y='-48' width='192' height='96'/></svg>");
    CHECK(drawing.width == doctest::Approx(50.8));
    CHECK(drawing.height == doctest::Approx(25.4));
    CHECK(svg_text::warns(drawing, "around what is drawn"));
    const auto box = extent(drawing.shapes.at(0).filled);
    CHECK(box.left == doctest::Approx(0.0));
    CHECK(box.low == doctest::Approx(0.0));
    CHECK(box.high == doctest::Approx(25.4));
    const Drawing wide =
        svg_text::read("<svg><rect x='96' y='-48' width='192' height='96'/></svg>", {.width_mm = 100.0});
    CHECK(wide.height == doctest::Approx(50.0));
    CHECK(area(wide.shapes.at(0).filled) == doctest::Approx(5000.0).epsilon(1e-9));
}

TEST_CASE("svg page: the letter F reads as drawn, y upwards, never mirrored") {
    const Drawing drawing =
        svg_text::draw("<path id='F' fill='red' d='M10 10h40v10h-30v10h20v10h-20v40h-10z'/>");
    const Region& f = drawing.shapes.at(0).filled;
    CHECK(area(f) == doctest::Approx(10 * 70 + 30 * 10 + 20 * 10).epsilon(1e-12));
    CHECK(contains(f, {15, 25}));        // the stem goes down to y = 100 - 80
    CHECK(contains(f, {45, 85}));        // the long arm is above, to the right
    CHECK(contains(f, {35, 65}));        // the short arm below it
    CHECK_FALSE(contains(f, {45, 65}));  // and shorter
    CHECK_FALSE(contains(f, {45, 25}));
    CHECK(f.at(0).holes.empty());
}

TEST_CASE("svg page: viewBox may start anywhere") {
    const Drawing drawing = svg_text::read(
        "<svg width='40mm' height='20mm' viewBox='-20 -10 40 20'><rect x='-5' y='-5' width='10' "
        "height='10'/></svg>");
    const auto box = extent(drawing.shapes.at(0).filled);
    CHECK(box.left == doctest::Approx(15.0));
    CHECK(box.right == doctest::Approx(25.0));
    CHECK(box.low == doctest::Approx(5.0));
    CHECK(box.high == doctest::Approx(15.0));
}

TEST_CASE("svg page: a length with a unit inside a scaled drawing is pointed out") {
    const Drawing drawing = svg_text::draw("<path id='p' d='M0 10H30' stroke='red' stroke-width='1mm'/>");
    CHECK(drawing.shapes.at(0).stroke_width == doctest::Approx(96 / 25.4));
    CHECK(svg_text::warns(drawing, "path 'p': stroke-width: '1mm' is 3.78 mm on paper"));
}

TEST_CASE("svg page: what lies off the page is printed with a warning") {
    const Drawing drawing =
        svg_text::draw("<rect id='scrap' x='200' width='5' height='5'/><rect width='5' height='5'/>");
    CHECK(drawing.shapes.size() == 2);
    CHECK(svg_text::warns(drawing, "'scrap': lies outside of the page"));
    CHECK(drawing.warnings.size() == 1);
}

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "svg_text.hpp"

using namespace ruche;
using std::numbers::pi;
using svg_text::extent;

static Shape one(const std::string& body, const DrawingOptions& options = {}) {
    const Drawing drawing = svg_text::draw(body, options);
    REQUIRE(drawing.shapes.size() == 1);
    return drawing.shapes[0];
}
static double filled(const std::string& body) {
    return area(one(body, {.flatten_tolerance_mm = 0.001}).filled);
}
static double stroked(const std::string& attributes) {
    return area(
        one("<path fill='none' stroke='red' " + attributes + "/>", {.flatten_tolerance_mm = 0.001}).stroked);
}

TEST_CASE("svg shapes: areas are those of geometry") {
    // A chord polygon of a circle of radius r misses about (2/3) of the tolerance times the rim.
    CHECK(filled("<rect x='1' y='2' width='30' height='20'/>") == doctest::Approx(600.0).epsilon(1e-12));
    CHECK(filled("<circle cx='50' cy='50' r='20'/>") == doctest::Approx(400 * pi).epsilon(1e-4));
    CHECK(filled("<circle cx='50%' cy='50%' r='20%'/>") == doctest::Approx(400 * pi).epsilon(1e-4));
    CHECK(filled("<ellipse cx='50' cy='50' rx='20' ry='5'/>") == doctest::Approx(100 * pi).epsilon(3e-4));
    CHECK(filled("<rect width='30' height='20' rx='4'/>") ==
          doctest::Approx(600 - (4 - pi) * 16).epsilon(1e-4));
    CHECK(filled("<rect width='30' height='20' rx='4' ry='2'/>") ==
          doctest::Approx(600 - (4 - pi) * 8).epsilon(1e-4));
    CHECK(filled("<rect width='30' height='20' ry='99'/>") == doctest::Approx(150 * pi).epsilon(1e-4));
    CHECK(filled("<polygon points='0,0 30,0 0,20'/>") == doctest::Approx(300.0).epsilon(1e-12));
    CHECK(filled("<polyline points='0,0 30,0 0,20'/>") == doctest::Approx(300.0).epsilon(1e-12));
    CHECK(filled("<path d='M0 0h30v20z'/>") == doctest::Approx(300.0).epsilon(1e-12));
    // The parabola's segment has two thirds of its box.
    CHECK(filled("<path d='M0 0Q15 40 30 0'/>") == doctest::Approx(400.0).epsilon(2e-4));
}

TEST_CASE("svg shapes: the fill rule decides what a ring's inside is") {
    const std::string ring = "d='M0 0h30v30h-30zM10 10h10v10h-10z'";
    CHECK(filled("<path " + ring + "/>") == doctest::Approx(900.0).epsilon(1e-12));
    CHECK(filled("<path fill-rule='evenodd' " + ring + "/>") == doctest::Approx(800.0).epsilon(1e-12));
    CHECK(filled("<path d='M0 0h30v30h-30zM10 10v10h10v-10z'/>") == doctest::Approx(800.0).epsilon(1e-12));
}

TEST_CASE("svg stroke: a line is a strip of its width, with the cap's ends") {
    CHECK(stroked("d='M10 10h50' stroke-width='2'") == doctest::Approx(100.0).epsilon(1e-9));
    CHECK(stroked("d='M10 10h50' stroke-width='2' stroke-linecap='square'") ==
          doctest::Approx(104.0).epsilon(1e-9));
    CHECK(stroked("d='M10 10h50' stroke-width='2' stroke-linecap='round'") ==
          doctest::Approx(100.0 + pi).epsilon(1e-4));
    const Shape shape = one("<line x1='10' y1='10' x2='60' y2='10' stroke='red' stroke-width='2'/>");
    REQUIRE(shape.lines.size() == 1);
    CHECK(shape.lines[0] == Polyline{{10, 90}, {60, 90}});
    CHECK_FALSE(shape.closed[0]);
    CHECK(shape.stroke_width == doctest::Approx(2.0));
    CHECK(shape.filled.empty());
    CHECK(shape.fill_colour.empty());
}

TEST_CASE("svg stroke: joins at a right angle differ by what geometry says") {
    // Two legs of 50, width 2: 2 * 100 less the square counted twice, plus the outer corner.
    const std::string d = "d='M10 10h50v50' stroke-width='2' ";
    CHECK(stroked(d) == doctest::Approx(200.0).epsilon(1e-9));
    CHECK(stroked(d + "stroke-linejoin='bevel'") == doctest::Approx(199.5).epsilon(1e-9));
    CHECK(stroked(d + "stroke-linejoin='round'") == doctest::Approx(199.0 + pi / 4).epsilon(1e-4));
    CHECK(stroked(d + "stroke-miterlimit='1.4'") == doctest::Approx(199.5).epsilon(1e-9));
    CHECK(stroked(d + "stroke-miterlimit='1.42'") == doctest::Approx(200.0).epsilon(1e-9));
    CHECK(stroked("d='M10 10h50v50h-50z' stroke-width='2'") ==
          doctest::Approx(52 * 52 - 48 * 48).epsilon(1e-9));
    // Open at the start corner: a quarter of the corner square is missing.
    CHECK(stroked("d='M10 10h50v50h-50V10' stroke-width='2'") == doctest::Approx(400.0 - 1.0).epsilon(1e-9));
}

TEST_CASE("svg stroke: a smooth curve has no spikes, however sharply it turns") {
    // There and back with a turn of 1 um: as good as a half circle at the pen's edge, not a miter or a bevel.
    for (const char* turn : {"C50 30.0001 50 30.0009 10 30.001", "A40 0.0005 0 0 1 10 30.001"}) {
        for (const char* join : {"miter", "bevel", "round"}) {
            CAPTURE(std::string(turn));
            CAPTURE(std::string(join));
            const Shape shape =
                one("<path fill='none' stroke='red' stroke-width='4' stroke-miterlimit='100' "
                    "d='M10 30" +
                    std::string(turn) + "' stroke-linejoin='" + join + "'/>");
            const double tip = turn[0] == 'C' ? 40.0 : 50.0;
            CHECK(extent(shape.stroked).right == doctest::Approx(tip + 2.0).epsilon(5e-4));
            CHECK(area(shape.stroked) == doctest::Approx(4.0 * (tip - 10.0) + 2 * pi).epsilon(1e-3));
        }
    }
    // Dashes and caps go on around such turns.
    const double along = stroked(
        "d='M10 30C50 30.0001 50 30.0009 10 30.001' stroke-width='4' "
        "stroke-dasharray='25 10' stroke-dashoffset='-17.5' stroke-linecap='square'");
    CHECK(along == doctest::Approx(4.0 * (11.5 + 14.5) + 2 * pi).epsilon(1e-3));
}

TEST_CASE("svg stroke: a circle's stroke is a ring") {
    const Shape shape = one("<circle cx='50' cy='50' r='20' fill='none' stroke='red' stroke-width='2'/>",
                            {.flatten_tolerance_mm = 0.001});
    CHECK(area(shape.stroked) == doctest::Approx(pi * (21 * 21 - 19 * 19)).epsilon(2e-4));
    REQUIRE(shape.stroked.size() == 1);
    CHECK(shape.stroked[0].holes.size() == 1);
    CHECK(shape.closed.at(0));
}

TEST_CASE("svg stroke: an uneven scale widens the stroke unevenly") {
    const Shape across = one("<path d='M2 10h10' stroke='red' stroke-width='2' transform='scale(5 1)'/>");
    CHECK(area(across.stroked) == doctest::Approx(100.0).epsilon(1e-9));
    const Shape along = one("<path d='M2 10v40' stroke='red' stroke-width='2' transform='scale(5 1)'/>");
    CHECK(area(along.stroked) == doctest::Approx(400.0).epsilon(1e-9));
    CHECK(extent(along.stroked).right - extent(along.stroked).left == doctest::Approx(10.0));
    CHECK(along.stroke_width == doctest::Approx(2.0 * std::sqrt(5.0)));
    // An area scales with the determinant, whatever the shape of the stroke: skewed, mirrored and turned.
    const std::string d = "d='M10 10C20 0 20 30 30 10L15 20' stroke-width='2' stroke-linejoin='round' ";
    const double plain = stroked(d);
    CHECK(stroked(d + "transform='skewX(30)'") == doctest::Approx(plain).epsilon(1e-3));
    CHECK(stroked(d + "transform='translate(90 5) rotate(30) scale(-2 1)'") ==
          doctest::Approx(2 * plain).epsilon(1e-3));
    CHECK(stroked(d + "transform='translate(90) rotate(30) scale(-2 2)'") ==
          doctest::Approx(4 * plain).epsilon(1e-3));
}

TEST_CASE("svg stroke: a round cap under an uneven scale is half an ellipse") {
    const Shape dot =
        one("<path d='M10 10z' stroke='red' stroke-width='2' stroke-linecap='round' transform='scale(5 1)'/>",
            {.flatten_tolerance_mm = 0.001});
    CHECK(area(dot.stroked) == doctest::Approx(5 * pi).epsilon(1e-3));
    const auto box = extent(dot.stroked);
    CHECK(box.right - box.left == doctest::Approx(10.0).epsilon(1e-3));
    CHECK(box.high - box.low == doctest::Approx(2.0).epsilon(1e-3));
}

TEST_CASE("svg stroke: a non-scaling stroke counts CSS px, whatever the transforms") {
    const Shape shape =
        one("<path d='M2 10h10' stroke='red' stroke-width='3' vector-effect='non-scaling-stroke' "
            "transform='scale(5 7)'/>");
    CHECK(shape.stroke_width == doctest::Approx(3 * 25.4 / 96));
    CHECK(area(shape.stroked) == doctest::Approx(50 * 3 * 25.4 / 96).epsilon(1e-6));
}

TEST_CASE("svg stroke: a subpath of no length is a dot of the cap's form") {
    CHECK(stroked("d='M5 5z' stroke-width='2' stroke-linecap='round'") == doctest::Approx(pi).epsilon(2e-3));
    CHECK(stroked("d='M5 5h0' stroke-width='2' stroke-linecap='square'") ==
          doctest::Approx(4.0).epsilon(1e-9));
    const Shape turned =
        one("<path d='M50 50h0' stroke='red' stroke-width='2' stroke-linecap='square' "
            "transform='rotate(45 50 50)'/>");
    CHECK(area(turned.stroked) == doctest::Approx(4.0).epsilon(1e-6));
    CHECK(extent(turned.stroked).right == doctest::Approx(50.0 + std::sqrt(2.0)).epsilon(1e-6));
    CHECK(svg_text::draw("<path d='M5 5z' stroke='red'/>").shapes.empty());
}

TEST_CASE("svg stroke: dashes cut the strip, their caps and offset count") {
    const std::string d = "d='M10 10h50' stroke-width='2' ";
    CHECK(stroked(d + "stroke-dasharray='10'") == doctest::Approx(60.0).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='10,5'") == doctest::Approx(2 * (10 + 10 + 10 + 5)).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='10,5' stroke-dashoffset='5'") ==
          doctest::Approx(2 * (5 + 10 + 10 + 10)).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='10,5' stroke-dashoffset='-5'") ==
          doctest::Approx(2 * (10 + 10 + 10)).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='10 5 5'") == doctest::Approx(2 * (10 + 5 + 5 + 10)).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='10' stroke-linecap='square'") ==
          doctest::Approx(72.0).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='10%' stroke-width='2'") == doctest::Approx(60.0).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='0'") == doctest::Approx(100.0).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='none'") == doctest::Approx(100.0).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='1e-9'") == doctest::Approx(100.0).epsilon(1e-9));
    CHECK(stroked(d + "stroke-dasharray='0 10' stroke-linecap='square'") ==
          doctest::Approx(6 * 4.0).epsilon(1e-6));
    CHECK(stroked(d + "stroke-dasharray='1' pathLength='5'") == doctest::Approx(60.0).epsilon(1e-9));
}

TEST_CASE(
    "svg stroke: more dashes than anyone prints are a solid line, and a warning with line and id says so") {
    const auto dashed = [](const std::string& dashes) {
        return svg_text::draw(
            "<path id='fine' d='M 0 50 H 100' stroke='red' fill='none' stroke-width='1' "
            "stroke-dasharray='" +
            dashes + "'/>");
    };
    const std::string warning =
        "drawing.svg:2: path 'fine': has more than 20000 dashes and gaps: printed as a solid";
    const Drawing fine = dashed("0.0049");
    CHECK(area(fine.shapes.at(0).stroked) == doctest::Approx(100.0).epsilon(1e-9));
    CHECK(svg_text::warns(fine, warning));
    CHECK(fine.warnings.size() == 1);
    const Drawing coarse = dashed("0.0051");
    CHECK(area(coarse.shapes.at(0).stroked) == doctest::Approx(50.0).epsilon(1e-3));
    CHECK(coarse.warnings.empty());
}

TEST_CASE("svg stroke: the dash that runs over a closed line's start is joined there") {
    // Dashes of 20 from the middle of the top side: the corner at the start lies inside one.
    const Shape shape =
        one("<path d='M10 10h40v40h-40z' fill='none' stroke='red' stroke-width='2' "
            "stroke-dasharray='20' stroke-dashoffset='10'/>");
    CHECK(shape.stroked.size() == 4);
    // Four dashes with a corner in the middle each: a corner adds and takes one square.
    CHECK(area(shape.stroked) == doctest::Approx(4 * 40.0).epsilon(1e-9));
    CHECK(shape.lines.size() == 1);
}

TEST_CASE("svg shapes: a shape may have both a stroke and a fill") {
    const Shape shape =
        one("<rect x='10' y='10' width='20' height='20' fill='#0000ff' stroke='#ff0000' stroke-width='2'/>");
    CHECK(shape.fill_colour == "#0000ff");
    CHECK(shape.stroke_colour == "#ff0000");
    CHECK(area(shape.filled) == doctest::Approx(400.0).epsilon(1e-12));
    CHECK(area(shape.stroked) == doctest::Approx(22 * 22 - 18 * 18).epsilon(1e-9));
}

TEST_CASE("svg shapes: an open line with a stroke is filled only if somebody asked for it") {
    const std::string bent = "<polyline id='b' points='0,0 30,0 0,20' stroke='red' ";
    const Drawing by_default = svg_text::draw(bent + "/>");
    CHECK(by_default.shapes.at(0).filled.empty());
    CHECK(by_default.shapes.at(0).fill_colour.empty());
    CHECK(svg_text::warns(by_default, "polyline 'b': is open and only SVG's default would fill it black"));
    CHECK(area(svg_text::draw("<g fill='black'>" + bent + "/></g>").shapes.at(0).filled) ==
          doctest::Approx(300.0));
    CHECK(area(svg_text::draw(bent + "fill='black'/>").shapes.at(0).filled) == doctest::Approx(300.0));
    // Closed ones are filled as SVG says; a straight line is not worth a warning.
    CHECK(area(svg_text::draw("<polygon points='0,0 30,0 0,20' stroke='red'/>").shapes.at(0).filled) ==
          doctest::Approx(300.0));
    CHECK(area(svg_text::draw("<path d='M0 0H30L0 20L0 0' stroke='red'/>").shapes.at(0).filled) ==
          doctest::Approx(300.0));
    CHECK(svg_text::draw("<polyline points='0,0 30,0 50,0' stroke='red'/>").warnings.empty());
}

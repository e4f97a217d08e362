#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "svg_text.hpp"

using namespace ruche;
using svg_text::extent;

namespace {

const double pi = std::numbers::pi;

Drawing sample(const std::string& name, const DrawingOptions& options = {}) {
    return read_drawing(std::string(RUCHE_TEST_DATA) + "/svg/" + name, options);
}

const Shape& shape_named(const Drawing& drawing, const std::string& id) {
    for (const Shape& shape : drawing.shapes) {
        if (shape.id == id) return shape;
    }
    FAIL("no shape ", id);
    return drawing.shapes.front();
}

std::vector<std::string> ids(const Drawing& drawing) {
    std::vector<std::string> all;
    for (const Shape& shape : drawing.shapes) all.push_back(shape.id);
    return all;
}

}  // namespace

TEST_CASE("svg sample: a drawing as Inkscape writes it") {
    const Drawing drawing = sample("inkscape.svg");
    CHECK(drawing.width == doctest::Approx(120.0).epsilon(1e-14));
    CHECK(drawing.height == doctest::Approx(80.0).epsilon(1e-14));
    CHECK(ids(drawing) ==
          std::vector<std::string>{"path20", "path10", "path12", "use13", "rect16", "path18"});

    const Shape& spine = shape_named(drawing, "path10");
    CHECK(spine.label == "spine");
    CHECK(spine.layer == "Front");
    CHECK(spine.stroke_colour == "#ff0000");
    CHECK(spine.stroke_width == doctest::Approx(1.5).epsilon(1e-12));
    CHECK(area(spine.stroked) == doctest::Approx(60.0).epsilon(1e-9));
    REQUIRE(spine.lines.size() == 1);
    CHECK((spine.lines[0].front() - Vec2(40, 40)).norm() < 1e-9);
    CHECK((spine.lines[0].back() - Vec2(80, 40)).norm() < 1e-9);
    CHECK(spine.line == 57);

    const Shape& turned = shape_named(drawing, "path12");
    CHECK(turned.layer == "Front");
    CHECK(turned.groups == std::vector<std::string>{"g14", "Front", "layer1", "svg1"});
    CHECK(area(turned.stroked) == doctest::Approx(60.0).epsilon(1e-9));
    // (30, 60) -> matrix -> (50, 40) -> layer -> (60, 20) -> y up -> (60, 60)
    CHECK((turned.lines.at(0).front() - Vec2(60, 60)).norm() < 1e-9);
    CHECK((turned.lines.at(0).back() - Vec2(60, 30)).norm() < 1e-9);
    const Shape& clone = shape_named(drawing, "use13");
    CHECK((clone.lines.at(0).front() - Vec2(50, 60)).norm() < 1e-9);
    CHECK(clone.stroke_width == doctest::Approx(2.0));

    CHECK(shape_named(drawing, "rect16").fill_colour == "#ff8800");
    CHECK(area(shape_named(drawing, "rect16").filled) == doctest::Approx(32.0).epsilon(1e-9));
    const Region& frame = shape_named(drawing, "path18").filled;
    CHECK(area(frame) == doctest::Approx(32.0).epsilon(1e-9));
    REQUIRE(frame.size() == 1);
    CHECK(frame[0].holes.size() == 1);
    const Shape& fabric = shape_named(drawing, "path20");
    CHECK(fabric.layer == "Fabric");
    CHECK(fabric.closed.at(0));
    CHECK(extent(fabric.stroked).right == doctest::Approx(96.1).epsilon(1e-6));

    REQUIRE(drawing.warnings.size() == 2);
    CHECK(svg_text::warns(drawing, "inkscape.svg:90: text 'text19': text is not printed"));
    CHECK(svg_text::warns(drawing, "inkscape.svg:98: g 'layer3': is hidden"));
}

TEST_CASE("svg sample: a drawing as Illustrator writes it, its width given") {
    const Drawing guessed = sample("illustrator.svg");
    CHECK(svg_text::warns(guessed,
                          "the page is 75.00 x 37.50 mm (at Illustrator's 72 per inch it would be "
                          "100.00 x 50.00 mm)"));

    const Drawing drawing = sample("illustrator.svg", {.width_mm = 100.0});
    CHECK(drawing.height == doctest::Approx(50.0).epsilon(1e-5));
    CHECK(ids(drawing) == std::vector<std::string>{"line-1", "Bogen", "path-3", "polygon-4", "rect-5"});
    const double mm = 100.0 / 283.465;

    const Shape& line = drawing.shapes[0];
    CHECK(line.layer == "Vorderseite_1");
    CHECK(line.groups ==
          std::vector<std::string>{"Vorderseite_1", "Vorderseite_x5F_1", "Ebene 1", "Ebene_1"});
    CHECK(line.classes == std::vector<std::string>{"cls-1"});
    CHECK(line.stroke_colour == "#ed1c24");
    CHECK(line.fill_colour.empty());
    const double width = 4.252 * mm;
    CHECK(line.stroke_width == doctest::Approx(width).epsilon(1e-12));
    // The round caps are polygons: a hundredth of a mm at most is missing along their rims.
    CHECK(area(line.stroked) == doctest::Approx(113.386 * mm * width + pi / 4 * width * width).epsilon(1e-3));

    const Shape& arc = shape_named(drawing, "Bogen");
    const Vec2 centre(198.425 * mm, drawing.height - 70.866 * mm);
    for (const Vec2& p : arc.lines.at(0)) {
        // The cubic itself misses the circle by 2.7e-4 of its radius.
        CHECK((p - centre).norm() == doctest::Approx(28.346 * mm).epsilon(4e-4));
        CHECK(p.y() > centre.y() - 1e-9);
    }
    CHECK(area(arc.stroked) ==
          doctest::Approx(pi * 28.346 * mm * width + pi / 4 * width * width).epsilon(2e-3));

    CHECK(area(drawing.shapes[2].filled) ==
          doctest::Approx((28.346 * 28.346 - 11.338 * 11.338) * mm * mm).epsilon(1e-6));
    CHECK(area(drawing.shapes[3].filled) == doctest::Approx(28.347 * 28.346 / 2 * mm * mm).epsilon(1e-6));
    CHECK(drawing.shapes[4].layer == "Stoff");
    CHECK(drawing.shapes[4].filled.empty());
    REQUIRE(drawing.warnings.size() == 1);
    CHECK(svg_text::warns(drawing, "illustrator.svg:43: g: clip-path url(#clippath) is ignored"));
}

TEST_CASE("svg sample: a drawing as Rhino writes it") {
    const Drawing drawing = sample("rhino.svg");
    CHECK(drawing.width == doctest::Approx(101.6).epsilon(1e-14));
    CHECK(drawing.height == doctest::Approx(50.8).epsilon(1e-14));
    CHECK(drawing.warnings.empty());
    CHECK(ids(drawing) == std::vector<std::string>{"polyline-1", "path-2", "path-3", "path-4"});
    CHECK(drawing.shapes[0].layer == "Strips::Back");
    CHECK(drawing.shapes[0].stroke_width == doctest::Approx(2.54).epsilon(1e-12));
    CHECK(area(drawing.shapes[0].stroked) == doctest::Approx(76.2 * 2.54).epsilon(1e-9));
    CHECK(area(drawing.shapes[1].stroked) == doctest::Approx(50.8 * 2.54).epsilon(1e-9));
    CHECK((drawing.shapes[1].lines.at(0).front() - Vec2(12.7, 12.7)).norm() < 1e-12);
    CHECK(drawing.shapes[2].layer == "Outline");
    CHECK(drawing.shapes[3].fill_colour == "#c0c0c0");
    CHECK(area(drawing.shapes[3].filled) == doctest::Approx(25.4 * 6.35).epsilon(1e-9));
}

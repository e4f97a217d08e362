#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ruche/pattern/pattern.hpp"
#include "svg_text.hpp"

using namespace ruche;
using std::numbers::pi;
using svg_text::extent;
using svg_text::ids;

namespace {

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

// Lengths below are worked out by hand from the files' own units: 297 mm over 297 units, 25.4 mm over 96,
// 120 mm over 340.157 points, ...

TEST_CASE("svg sample: Inkscape's layers inside layers, hairlines, live effects and hidden layers") {
    const Drawing drawing = sample("inkscape-sublayers.svg");
    CHECK(drawing.width == doctest::Approx(297.0).epsilon(1e-14));
    CHECK(drawing.height == doctest::Approx(210.0).epsilon(1e-14));
    CHECK(ids(drawing) == std::vector<std::string>{"rect1", "path3", "path4", "path5", "rect6"});
    CHECK(drawing.shapes[0].layer == "FABRIC");
    CHECK(drawing.shapes[0].lines.size() == 2);

    const Shape& bent = shape_named(drawing, "path3");
    CHECK(bent.layer == "0.6 mm");
    CHECK(bent.groups == std::vector<std::string>{"0.6 mm", "layer3", "Front", "layer2", "svg1"});
    CHECK(bent.stroke_width == doctest::Approx(1.2).epsilon(1e-12));
    // (40.5, 25.75) -> layer (30, 30) -> y up; 60 + 40 + 20 mm long with two mitred corners.
    CHECK((bent.lines.at(0).front() - Vec2(30, 180)).norm() < 1e-9);
    CHECK((bent.lines.at(0).back() - Vec2(70, 140)).norm() < 1e-9);
    CHECK(area(bent.stroked) == doctest::Approx(120 * 1.2).epsilon(1e-9));
    // A ring of 2 mm around a circle of 10 mm, squashed to half its height.
    const Shape& ring = shape_named(drawing, "path4");
    CHECK(area(ring.stroked) == doctest::Approx(2 * pi * 10 * 2 / 2).epsilon(1e-3));
    CHECK(extent(ring.stroked).high - extent(ring.stroked).low == doctest::Approx(11.0).epsilon(2e-3));
    CHECK(extent(ring.stroked).right - extent(ring.stroked).left == doctest::Approx(22.0).epsilon(2e-3));
    const Shape& arc = shape_named(drawing, "path5");
    CHECK(arc.layer == "0.9 mm");
    CHECK(area(arc.stroked) == doctest::Approx(6 * pi).epsilon(1e-3));
    CHECK(area(shape_named(drawing, "rect6").filled) == doctest::Approx(20.0).epsilon(1e-6));
    // Turned by 30 degrees about its middle (105, 31), moved to (94.5, 35.25).
    CHECK(extent(shape_named(drawing, "rect6").filled).right ==
          doctest::Approx(94.5 + 5 * std::sqrt(0.75) + 0.5).epsilon(1e-6));

    REQUIRE(drawing.warnings.size() == 1);
    CHECK(svg_text::warns(drawing, "inkscape-sublayers.svg:97: g 'layer5': is hidden"));

    const Pattern pattern = make_pattern(drawing, {.rules = {{.match = "0.9 mm", .thickness = 0.9}}});
    CHECK(pattern.outline_layer == "FABRIC");
    CHECK(area(pattern.fabric) == doctest::Approx(100 * 60 - 20 * 20).epsilon(1e-12));
    CHECK(pattern.strips.at(0).thickness == 0.6);
    CHECK(pattern.strips.at(2).thickness == 0.9);
}

TEST_CASE("svg sample: Inkscape's inches with a scaled layer, a style sheet, a symbol and a clone") {
    const Drawing drawing = sample("inkscape-inches.svg");
    CHECK(drawing.width == doctest::Approx(215.9).epsilon(1e-14));
    CHECK(drawing.height == doctest::Approx(279.4).epsilon(1e-14));
    CHECK(drawing.warnings.empty());
    CHECK(ids(drawing) == std::vector<std::string>{"path10", "path20", "path21", "use1/path30", "use2"});
    // 3.7795276 is rounded from 96 / 25.4: 1e-8.
    const std::vector<double> widths = {1, 2, 0.5, 1, 1}, lengths = {40, 40, 40, 20, 40};
    for (std::size_t i = 0; i < widths.size(); ++i) {
        CAPTURE(i);
        CHECK(drawing.shapes[i].layer == "Layer 1");
        CHECK(drawing.shapes[i].stroke_width == doctest::Approx(widths[i]).epsilon(1e-7));
        CHECK(area(drawing.shapes[i].stroked) == doctest::Approx(widths[i] * lengths[i]).epsilon(1e-6));
    }
    CHECK((drawing.shapes[3].lines.at(0).front() - Vec2(20, 279.4 - 65)).norm() < 1e-5);
    CHECK((drawing.shapes[4].lines.at(0).front() - Vec2(100, 279.4 - 50)).norm() < 1e-5);
    CHECK((drawing.shapes[4].lines.at(0).back() - Vec2(100, 279.4 - 90)).norm() < 1e-5);
    CHECK(drawing.shapes[4].label == "clone");
    CHECK(drawing.shapes[4].groups == std::vector<std::string>{"pair", "g5", "Layer 1", "layer1", "svg2"});
}

TEST_CASE("svg sample: Illustrator's export, all in one line, in points that need a width") {
    const Drawing guessed = sample("illustrator-export.svg");
    REQUIRE(guessed.warnings.size() == 1);
    CHECK(svg_text::warns(guessed,
                          "the page is 90.00 x 60.00 mm (at Illustrator's 72 per inch it would be "
                          "120.00 x 80.00 mm)"));
    const Drawing drawing = sample("illustrator-export.svg", {.width_mm = 120.0});
    CHECK(drawing.warnings.empty());
    CHECK(drawing.height == doctest::Approx(80.0).epsilon(1e-7));
    CHECK(ids(drawing) == std::vector<std::string>{"path-1", "path-2", "polyline-3", "rect-4", "circle-5"});
    CHECK(drawing.shapes[1].layer == "Front 0.6 mm");
    CHECK(drawing.shapes[1].stroke_width == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(area(drawing.shapes[1].stroked) == doctest::Approx(40.0).epsilon(1e-5));
    CHECK((drawing.shapes[1].lines.at(0).front() - Vec2(20, 60)).norm() < 1e-5);
    // 20 + 20 mm with square caps of 0.3 mm and a mitred corner.
    CHECK(area(drawing.shapes[2].stroked) == doctest::Approx(40.6 * 0.6).epsilon(1e-5));
    CHECK(drawing.shapes[3].groups ==
          std::vector<std::string>{"<Group>", "Group", "Front 0.6 mm", "Front_0.6_mm", "Layer 1", "Layer_1"});
    CHECK(area(drawing.shapes[3].filled) == doctest::Approx(40.0).epsilon(1e-5));
    CHECK(area(drawing.shapes[4].stroked) == doctest::Approx(2 * pi * 5 * 1).epsilon(2e-3));

    const Pattern pattern = make_pattern(drawing, {.rules = {{.match = "Front 0.6 mm", .thickness = 0.6}}});
    CHECK(pattern.outline_layer == "Fabric");
    CHECK(area(pattern.fabric) == doctest::Approx(100 * 60 - 20 * 20).epsilon(1e-5));
}

TEST_CASE("svg sample: Illustrator's own SVG with millimetres, entities, hidden layers and escaped names") {
    const Drawing drawing = sample("illustrator-saved.svg");
    CHECK(drawing.width == doctest::Approx(120.0).epsilon(1e-14));
    CHECK(drawing.height == doctest::Approx(80.0).epsilon(1e-14));
    CHECK(ids(drawing) == std::vector<std::string>{"ellipse-1", "path-2", "line-3", "ring"});
    const Shape& strip = drawing.shapes[1];
    CHECK(strip.layer == "0.6_mm_front");
    CHECK(strip.groups == std::vector<std::string>{"0.6_mm_front", "_x30_.6_mm_x5F_front", "Layer_1"});
    CHECK(strip.stroke_width == doctest::Approx(1.0).epsilon(1e-4));
    CHECK(strip.lines.at(0).front().x() == doctest::Approx(30.0).epsilon(1e-4));
    // Round caps and dots are chords that lie inside by up to 0.01 mm: 2.7 % of a dot of 1 mm is missing at
    // most.
    const double dot = pi / 4;
    CHECK(area(strip.stroked) < 40.0 + dot + 0.01);
    CHECK(area(strip.stroked) > 40.0 + 0.973 * dot - 0.01);
    // Dashes of no length every 10 mm on 40 mm: dots.
    const Shape& dots = drawing.shapes[2];
    CHECK(dots.stroked.size() == 5);
    CHECK(area(dots.stroked) < 5 * dot);
    CHECK(area(dots.stroked) > 5 * 0.973 * dot);
    CHECK(area(drawing.shapes[3].filled) == doctest::Approx(pi * (25 - 6.25)).epsilon(4e-3));
    REQUIRE(drawing.warnings.size() == 2);
    CHECK(svg_text::warns(drawing, "illustrator-saved.svg:32: g 'Guides_1_': is hidden"));
    CHECK(svg_text::warns(drawing, "illustrator-saved.svg:46: text"));

    const Pattern pattern = make_pattern(drawing, {.rules = {{.match = "0.6_mm_front", .side = Side::back}}});
    CHECK(pattern.outline_layer == "Fabric_2_");
    CHECK(area(pattern.fabric) == doctest::Approx(pi * 50 * 30).epsilon(1e-3));
    CHECK(pattern.strips.at(0).side == Side::back);
}

TEST_CASE(
    "svg sample: Rhino's millimetres with coordinates in points, layers with paths, hidden and clipped") {
    const Drawing drawing = sample("rhino-layers.svg");
    CHECK(drawing.width == doctest::Approx(160.0).epsilon(1e-14));
    CHECK(drawing.height == doctest::Approx(90.0).epsilon(1e-14));
    CHECK(ids(drawing) == std::vector<std::string>{"path-1", "circle-2", "path-3", "path-4", "polygon-5"});
    CHECK(drawing.shapes[2].layer == "Kite::Strips::Front");
    CHECK(drawing.shapes[2].stroke_width == doctest::Approx(1.2).epsilon(1e-5));
    CHECK(area(drawing.shapes[2].stroked) == doctest::Approx(40 * 1.2).epsilon(1e-5));
    CHECK((drawing.shapes[2].lines.at(0).front() - Vec2(20, 70)).norm() < 1e-3);
    // A quarter of a circle of 10 mm by a cubic.
    CHECK(area(drawing.shapes[3].stroked) == doctest::Approx(5 * pi * 1.2).epsilon(1e-3));
    CHECK(area(drawing.shapes[4].filled) == doctest::Approx(40.0).epsilon(1e-4));
    REQUIRE(drawing.warnings.size() == 3);
    CHECK(svg_text::warns(drawing, "rhino-layers.svg:5: g: clip-path url(#clip_0) is ignored"));
    CHECK(svg_text::warns(drawing, "rhino-layers.svg:16: path: is hidden"));
    CHECK(svg_text::warns(drawing, "rhino-layers.svg:18: text: text is not printed"));

    const Pattern pattern = make_pattern(drawing, {.rules = {{.match = "Kite::Strips::Front"}}});
    CHECK(pattern.outline_layer == "Kite::Fabric");
    CHECK(area(pattern.fabric) == doctest::Approx(140 * 70 - 100 * pi).epsilon(1e-4));
    CHECK(pattern.strips.size() == 3);
}

TEST_CASE("svg sample: a drawing from Rhino with y upwards, a shifted view box and centimetres") {
    const Drawing drawing = sample("rhino-flipped.svg");
    CHECK(drawing.width == doctest::Approx(120.0).epsilon(1e-14));
    CHECK(drawing.height == doctest::Approx(80.0).epsilon(1e-14));
    CHECK(drawing.warnings.empty());
    CHECK(ids(drawing) == std::vector<std::string>{"polyline-1", "polyline-2", "path-3"});
    // (0, 10) of the group is (0, 50) on the page, whose corner is (-20, -10) and which is 80 high.
    const Polyline& open = drawing.shapes[0].lines.at(0);
    CHECK((open.front() - Vec2(20, 20)).norm() < 1e-9);
    CHECK((open.back() - Vec2(40, 40)).norm() < 1e-9);
    CHECK(area(drawing.shapes[0].stroked) == doctest::Approx(80.0).epsilon(1e-6));
    CHECK(drawing.shapes[0].layer == "Default");
    CHECK(area(drawing.shapes[1].filled) == doctest::Approx(400.0).epsilon(1e-6));
    // "outline" is a name for many things: it bounds the fabric only when the scene says so.
    CHECK(make_pattern(drawing, {.rules = {{.match = "outline", .role = PrintRule::Role::ignore}}})
              .outline_layer.empty());
    const Pattern pattern = make_pattern(drawing, {.fabric_from_outline = true, .fabric_layer = "outline"});
    CHECK(area(pattern.fabric) == doctest::Approx(70 * 55).epsilon(1e-9));
}

TEST_CASE("svg sample: no warning is said twice") {
    for (const char* name :
         {"inkscape.svg", "illustrator.svg", "rhino.svg", "inkscape-sublayers.svg", "inkscape-inches.svg",
          "illustrator-export.svg", "illustrator-saved.svg", "rhino-layers.svg", "rhino-flipped.svg"}) {
        CAPTURE(std::string(name));
        std::vector<std::string> warnings = sample(name).warnings;
        std::ranges::sort(warnings);
        CHECK(std::ranges::adjacent_find(warnings) == warnings.end());
    }
}

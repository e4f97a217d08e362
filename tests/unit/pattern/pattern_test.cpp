#include "ruche/pattern/pattern.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "ruche/core/error.hpp"
#include "ruche/geometry/polyline.hpp"
#include "sample_shapes.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

const Polyline level = {Vec2(0, 0), Vec2(20, 0)};
const Polyline upright = {Vec2(10, -10), Vec2(10, 10)};

std::string error_of(const std::function<void()>& run) {
    try {
        run();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

bool warns(const Pattern& pattern, const std::string& part) {
    for (const std::string& warning : pattern.warnings) {
        if (says(warning, part)) return true;
    }
    return false;
}

Polygon with_hole(const Polyline& outer, Polyline hole) {
    std::reverse(hole.begin(), hole.end());
    return {outer, {hole}};
}

}  // namespace

TEST_CASE("pattern: a stroke becomes a strip with its id, thickness and centre line") {
    const Pattern pattern = make_pattern(drawing({stroked("a", level, 1.0)}), {.thickness = 0.7});
    REQUIRE(pattern.strips.size() == 1);
    CHECK(pattern.strips[0].id == "a");
    CHECK(pattern.strips[0].thickness == 0.7);
    CHECK(area(pattern.strips[0].region) == doctest::Approx(20.0).epsilon(1e-12));
    REQUIRE(pattern.strips[0].centreline.size() == 1);
    CHECK(pattern.strips[0].centreline[0] == level);
    CHECK(pattern.warnings.empty());
}

TEST_CASE("pattern: the margin of fabric is round, without holes, and 0 means exactly the print") {
    const Drawing ring = drawing({stroked("ring", circle({0, 0}, 10), 1.0, true)});
    const Pattern wide = make_pattern(ring, {.margin = 2.0});
    REQUIRE(wide.fabric.size() == 1);
    CHECK(wide.fabric[0].holes.empty());
    CHECK(area(wide.fabric) == doctest::Approx(std::numbers::pi * 12.5 * 12.5).epsilon(0.01));
    const Pattern none = make_pattern(ring, {.margin = 0.0});
    CHECK(area(none.fabric) == doctest::Approx(area(none.strips[0].region)).epsilon(1e-12));
    CHECK(says(error_of([&] { make_pattern(ring, {.margin = -1.0}); }), "margin"));
}

TEST_CASE(
    "pattern: rules match colours, CSS names, layers, classes, ids and labels, and the first one wins") {
    Shape red = stroked("one", level, 1.0, false, "#ff0000");
    Shape blue = filled("two", box(0, 5, 10, 8), "#0000ff");
    Shape layered = stroked("three", {Vec2(0, 20), Vec2(20, 20)}, 1.0);
    layered.layer = "Top layer";
    Shape classy = stroked("four", {Vec2(0, 30), Vec2(20, 30)}, 1.0);
    classy.classes = {"x", "thick"};
    Shape labelled = stroked("five", {Vec2(0, 40), Vec2(20, 40)}, 1.0);
    labelled.label = "the fifth";
    Shape plain = stroked("six", {Vec2(0, 50), Vec2(20, 50)}, 1.0);
    const Drawing all = drawing({red, blue, layered, classy, labelled, plain});
    const PrintRules rules{.rules = {{.match = "red", .thickness = 1.1},
                                     {.match = "one", .thickness = 9.9},
                                     {.match = "#00F", .thickness = 1.2, .side = Side::back},
                                     {.match = "Top layer", .thickness = 1.3, .youngs_modulus = 50},
                                     {.match = ".thick", .thickness = 1.4},
                                     {.match = "the fifth", .role = PrintRule::Role::ignore},
                                     {.match = "six", .thickness = 1.6}}};
    const Pattern pattern = make_pattern(all, rules);
    REQUIRE(pattern.strips.size() == 5);
    CHECK(pattern.strips[0].thickness == 1.1);
    CHECK(pattern.strips[1].thickness == 1.2);
    CHECK(pattern.strips[1].side == Side::back);
    CHECK(pattern.strips[2].thickness == 1.3);
    CHECK(pattern.strips[2].youngs_modulus == 50);
    CHECK(pattern.strips[3].thickness == 1.4);
    CHECK(pattern.strips[4].id == "six");
    CHECK(pattern.strips[4].thickness == 1.6);
}

TEST_CASE("pattern: rules match the groups around a shape, and the nearest match wins") {
    Shape shape = stroked("one", level, 1.0, false, "#ff0000");
    shape.groups = {"thin ones", "g12", "Front", "layer1"};
    shape.layer = "Front";
    const auto thickness = [&](std::vector<PrintRule> rules) {
        return make_pattern(drawing({shape}), {.rules = std::move(rules), .thickness = 0.1})
            .strips.at(0)
            .thickness;
    };
    const PrintRule layer{.match = "Front", .thickness = 1.0};
    const PrintRule layer_id{.match = "#layer1", .thickness = 2.0};
    const PrintRule group{.match = "thin ones", .thickness = 3.0};
    const PrintRule group_id{.match = "g12", .thickness = 4.0};
    const PrintRule colour{.match = "red", .thickness = 5.0};
    const PrintRule id{.match = "#one", .thickness = 6.0};
    CHECK(thickness({layer}) == 1.0);
    CHECK(thickness({layer_id}) == 2.0);
    CHECK(thickness({group_id}) == 4.0);
    CHECK(thickness({layer, group_id}) == 4.0);
    CHECK(thickness({layer_id, layer, group}) == 3.0);
    CHECK(thickness({layer, group, colour}) == 5.0);
    CHECK(thickness({layer, colour, id}) == 5.0);
    CHECK(thickness({layer, id, colour}) == 6.0);
    CHECK(thickness({{.match = "front", .thickness = 7.0}}) == 0.1);
    const PrintRule ignored{.match = "g12", .role = PrintRule::Role::ignore};
    CHECK(says(error_of([&] { thickness({layer, ignored}); }), "nothing is printed"));
}

TEST_CASE("pattern: a layer or group named fabric bounds the fabric when nobody says what does") {
    const auto outlined = [](const std::string& name, const PrintRules& rules) {
        Shape edge = stroked("edge", box(-5, -5, 15, 5), 0.2, true);
        Shape hole = stroked("hole", box(0, 2, 2, 4), 0.2, true);
        for (Shape* shape : {&edge, &hole}) {
            shape->groups = {"g1", name, "svg1"};
            shape->layer = name;
        }
        return make_pattern(drawing({edge, hole, stroked("a", level, 1.0)}), rules);
    };
    for (const char* name : {"fabric", "Fabric", "FABRIC", "Kite::Fabric", "Fabric_1_", "fabric_23_"}) {
        CAPTURE(std::string(name));
        const Pattern pattern = outlined(name, {});
        CHECK(area(pattern.fabric) == doctest::Approx(200.0 - 4.0).epsilon(1e-12));
        CHECK(pattern.strips.size() == 1);
        CHECK(pattern.outline_layer == name);
    }
    for (const char* name : {"outline", "fabrics", "my fabric", "fabric_", "_1_", "", "fabric__"}) {
        CAPTURE(std::string(name));
        const Pattern pattern = outlined(name, {});
        CHECK(pattern.strips.size() == 3);
        CHECK(pattern.outline_layer.empty());
    }
    // Who says what the outline is, or what the layer is, is not second-guessed.
    CHECK(
        outlined("fabric", {.rules = {{.match = "fabric", .role = PrintRule::Role::strip}}}).strips.size() ==
        3);
    CHECK(
        outlined("fabric", {.rules = {{.match = "fabric", .role = PrintRule::Role::ignore}}}).strips.size() ==
        1);
    const Pattern by_rule =
        outlined("fabric", {.rules = {{.match = "edge", .role = PrintRule::Role::fabric_outline}}});
    CHECK(by_rule.outline_layer.empty());
    CHECK(area(by_rule.fabric) == doctest::Approx(200.0).epsilon(1e-12));
    const Pattern by_name = outlined("fabric", {.fabric_from_outline = true, .fabric_layer = "edge"});
    CHECK(by_name.outline_layer.empty());
    CHECK(area(by_name.fabric) == doctest::Approx(200.0).epsilon(1e-12));
}

TEST_CASE("pattern: a mistake in a layer that is the outline for its name alone says so") {
    Shape open = stroked("open", {Vec2(0, -5), Vec2(20, -5), Vec2(20, 5)}, 0.1);
    open.layer = "Fabric";
    open.groups = {"Fabric"};
    const std::string not_closed = error_of([&] {
        make_pattern(drawing({open, stroked("a", level, 1.0)}), {});
    });
    CHECK(says(not_closed, "not closed"));
    CHECK(says(not_closed, "Layer 'Fabric' is taken as the fabric's outline for its name"));
    Shape closed = stroked("closed", box(0, 0, 9, 9), 0.1, true);
    closed.layer = "Fabric";
    CHECK(says(error_of([&] { make_pattern(drawing({closed}), {}); }), "Layer 'Fabric' is taken"));
}

TEST_CASE("pattern: overlapping strips of one side are united, the thickest wins and a warning says so") {
    const Pattern pattern =
        make_pattern(drawing({stroked("thin", level, 1.0), stroked("thick", upright, 2.0)}),
                     {.rules = {{.match = "thick", .thickness = 0.9}}});
    REQUIRE(pattern.strips.size() == 2);
    CHECK(area(pattern.strips[0].region) == doctest::Approx(18.0).epsilon(1e-9));
    CHECK(pattern.strips[0].region.size() == 2);
    CHECK(area(pattern.strips[1].region) == doctest::Approx(40.0).epsilon(1e-9));
    CHECK(intersect(pattern.strips[0].region, pattern.strips[1].region).empty());
    CHECK(warns(pattern, "'thin' by 'thick'"));
    // The centre line of the thinner one is cut where the thicker one passes.
    REQUIRE(pattern.strips[0].centreline.size() == 2);
    CHECK(length(pattern.strips[0].centreline[0]) == doctest::Approx(9.0).epsilon(1e-9));
}

TEST_CASE("pattern: front over back is a laminate, not an overlap") {
    const Pattern pattern =
        make_pattern(drawing({stroked("front", level, 1.0), stroked("back", upright, 2.0)}),
                     {.rules = {{.match = "back", .side = Side::back}}});
    CHECK(pattern.warnings.empty());
    CHECK(area(pattern.strips[0].region) == doctest::Approx(20.0).epsilon(1e-9));
    CHECK(area(pattern.strips[1].region) == doctest::Approx(40.0).epsilon(1e-9));
}

TEST_CASE("pattern: a strip drawn twice counts once, and strips that touch are not an overlap") {
    const Pattern twice = make_pattern(drawing({stroked("a", level, 1.0), stroked("a", level, 1.0)}), {});
    REQUIRE(twice.strips.size() == 1);
    CHECK(warns(twice, "wholly covered"));
    CHECK(area(twice.strips[0].region) == doctest::Approx(20.0).epsilon(1e-12));
    const Pattern touching =
        make_pattern(drawing({filled("a", box(0, 0, 5, 1)), filled("b", box(5, 0, 9, 1))}), {});
    CHECK(touching.strips.size() == 2);
    CHECK(touching.warnings.empty());
}

TEST_CASE("pattern: remainders too narrow to print go to the strip that covers the rest") {
    // Two duplicates of almost the same width: the second leaves rims of 0.02 mm.
    const Pattern pattern = make_pattern(drawing({stroked("a", level, 1.0), stroked("b", level, 1.04)}), {});
    REQUIRE(pattern.strips.size() == 1);
    CHECK(area(pattern.strips[0].region) == doctest::Approx(20.8).epsilon(1e-9));
}

TEST_CASE("pattern: strips are cut at the fabric's edge with a warning, those outside left out") {
    const Shape outline = stroked("edge", box(-5, -5, 15, 5), 0.2, true, "#00ff00");
    const Pattern pattern = make_pattern(
        drawing({outline, stroked("a", level, 1.0), stroked("far", {Vec2(30, 0), Vec2(40, 0)}, 1.0)}),
        {.fabric_from_outline = true, .fabric_layer = "lime"});
    CHECK(area(pattern.fabric) == doctest::Approx(200.0).epsilon(1e-12));
    REQUIRE(pattern.strips.size() == 1);
    CHECK(area(pattern.strips[0].region) == doctest::Approx(15.0).epsilon(1e-9));
    CHECK(warns(pattern, "'a' by 5 mm^2"));
    CHECK(warns(pattern, "'far'"));
    CHECK(length(pattern.strips[0].centreline[0]) == doctest::Approx(15.0).epsilon(1e-9));
}

TEST_CASE(
    "pattern: the fabric's outline may have holes, islands and pieces, in any order, drawn twice or in "
    "parts") {
    const auto outlined = [](std::vector<Shape> shapes) {
        for (Shape& shape : shapes) shape.layer = "fabric";
        shapes.push_back(stroked("a", {Vec2(1, 1), Vec2(4, 1)}, 1.0));
        return make_pattern(drawing(shapes), {.fabric_from_outline = true, .fabric_layer = "fabric"});
    };
    const Shape outer = stroked("outer", box(0, 0, 30, 30), 0.1, true);
    const Shape hole = stroked("hole", box(10, 10, 20, 20), 0.1, true);
    const Shape island = filled("island", box(12, 12, 14, 14));
    CHECK(area(outlined({island, hole, outer}).fabric) == doctest::Approx(900 - 100 + 4).epsilon(1e-12));
    CHECK(area(outlined({outer, outer, hole}).fabric) == doctest::Approx(800).epsilon(1e-12));
    const Shape half = stroked("half", {Vec2(0, 0), Vec2(30, 0), Vec2(30, 30)}, 0.1);
    const Shape rest = stroked("rest", {Vec2(0, 0), Vec2(0, 30), Vec2(30, 30)}, 0.1);
    CHECK(area(outlined({half, rest}).fabric) == doctest::Approx(900).epsilon(1e-12));
}

TEST_CASE("pattern: an outline that is open, crosses itself or another one is an error that names it") {
    const auto message = [](std::vector<Shape> shapes) {
        for (Shape& shape : shapes) shape.layer = "fabric";
        shapes.push_back(stroked("a", {Vec2(1, 1), Vec2(4, 1)}, 1.0));
        return error_of(
            [&] { make_pattern(drawing(shapes), {.fabric_from_outline = true, .fabric_layer = "fabric"}); });
    };
    const Polyline bow = {Vec2(0, 0), Vec2(20, 20), Vec2(20, 0), Vec2(0, 20)};
    CHECK(says(message({stroked("bow", bow, 0.1, true)}), "test.svg:7: element 'bow'"));
    CHECK(says(message({stroked("bow", bow, 0.1, true)}), "near x = 10, y = 10"));
    CHECK(says(message({stroked("open", {Vec2(0, 0), Vec2(20, 0), Vec2(20, 20)}, 0.1)}), "not closed"));
    CHECK(says(message({stroked("one", box(0, 0, 20, 20), 0.1, true),
                        stroked("two", box(10, 10, 30, 25), 0.1, true)}),
               "crosses the edge 'one'"));
    CHECK(says(message({stroked("flat", {Vec2(0, 0), Vec2(20, 0), Vec2(5, 0)}, 0.1, true)}), "'flat'"));
    CHECK(says(error_of([] {
                   make_pattern(drawing({stroked("a", level, 1.0)}),
                                {.fabric_from_outline = true, .fabric_layer = "nowhere"});
               }),
               "nowhere"));
}

TEST_CASE("pattern: nothing printed is an error unless the fabric is bare on purpose") {
    CHECK(says(error_of([] { make_pattern(drawing({}), {}); }), "nothing is printed"));
    const Drawing ignored = drawing({stroked("a", level, 1.0)});
    const PrintRule ignore{.match = "a", .role = PrintRule::Role::ignore};
    CHECK(says(error_of([&] { make_pattern(ignored, {.rules = {ignore}}); }), "nothing is printed"));
    const Pattern bare =
        make_pattern(drawing({filled("sheet", box(0, 0, 10, 10))}), {.margin = 0.0, .bare = true});
    CHECK(bare.strips.empty());
    CHECK(area(bare.fabric) == doctest::Approx(100.0).epsilon(1e-12));
    CHECK(says(error_of([] { make_pattern(drawing({}), {.bare = true}); }), "neither"));
    CHECK(says(error_of([] { finish_pattern({}, 5.0); }), "nothing is printed"));
}

TEST_CASE("pattern: features narrower than 0.1 mm are an error that names the element") {
    const auto message = [](const Shape& shape) {
        return error_of([&] { make_pattern(drawing({stroked("good", upright, 1.0), shape}), {}); });
    };
    CHECK(says(message(stroked("hair", level, 0.01)), "test.svg:7: element 'hair': is 0.01 mm wide"));
    Shape zero = stroked("zero", level, 1.0);
    zero.stroked.clear();
    zero.stroke_width = 0.0;
    CHECK(says(message(zero), "element 'zero': covers no area"));
    // Two pads joined by a bridge of 0.05 mm, and a pad with a whisker.
    const Polyline bridge = {Vec2(30, 0),    Vec2(33, 0),    Vec2(33, 1.5), Vec2(36, 1.5),
                             Vec2(36, 0),    Vec2(39, 0),    Vec2(39, 3),   Vec2(36, 3),
                             Vec2(36, 1.55), Vec2(33, 1.55), Vec2(33, 3),   Vec2(30, 3)};
    CHECK(says(message(filled("bridge", bridge)), "'bridge': is narrower than 0.1 mm for 3"));
    CHECK(message(stroked("thin but good", {Vec2(0, 30), Vec2(20, 30)}, 0.1)).empty());
    const Polyline star_tip = {Vec2(30, 0), Vec2(40, -1), Vec2(40, 1)};
    CHECK(message(filled("sharp", star_tip)).empty());
}

TEST_CASE("pattern: thickness and modulus must make sense") {
    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK(says(error_of([&] { make_pattern(drawing({stroked("a", level, 1.0)}), {.thickness = bad}); }),
                   "thickness"));
    }
    const PrintRule soft{.match = "a", .youngs_modulus = -5};
    CHECK(says(error_of([&] { make_pattern(drawing({stroked("a", level, 1.0)}), {.rules = {soft}}); }),
               "modulus"));
}

TEST_CASE("pattern: ids stay unique") {
    const Pattern pattern =
        make_pattern(drawing({stroked("a", level, 1.0), stroked("a", {Vec2(0, 5), Vec2(9, 5)}, 1.0)}), {});
    CHECK(pattern.strips[0].id == "a");
    CHECK(pattern.strips[1].id == "a (2)");
}

TEST_CASE("pattern: fine borders are simplified within a hundredth of the width, and it says by how much") {
    Shape fine = filled("ring", circle({0, 0}, 10, 4000));
    fine.filled = {with_hole(circle({0, 0}, 10, 4000), circle({0, 0}, 9, 4000))};
    const Pattern pattern = make_pattern(drawing({fine}), {});
    CHECK(pattern.strips[0].region[0].outer.size() < 200);
    CHECK(pattern.border_shift > 0.0);
    CHECK(pattern.border_shift <= 0.0102);
    CHECK(std::abs(pattern.area_change) < 0.002);
    const double exact = std::numbers::pi * (100 - 81);
    CHECK(area(pattern.strips[0].region) == doctest::Approx(exact * (1 + pattern.area_change)).epsilon(1e-5));
}

TEST_CASE("pattern: finishing a finished pattern changes nothing") {
    Pattern pattern;
    pattern.strips = {strip("a", level, 1.0), strip("b", {Vec2(3, -5), Vec2(12, 6)}, 0.8)};
    const Pattern once = finish_pattern(pattern, 4.0);
    const Pattern twice = finish_pattern(once, 4.0);
    REQUIRE(twice.strips.size() == once.strips.size());
    for (std::size_t i = 0; i < once.strips.size(); ++i) {
        CHECK(area(twice.strips[i].region) == doctest::Approx(area(once.strips[i].region)).epsilon(1e-12));
    }
    CHECK(area(twice.fabric) == doctest::Approx(area(once.fabric)).epsilon(1e-12));
}

TEST_CASE("pattern: random overlapping strips end up disjoint and lose no area") {
    CHECK(rc::check([] {
        Pattern pattern;
        std::vector<Region> drawn;
        const int count = *rc::gen::inRange(1, 8);
        const auto coordinate = [] { return *rc::gen::inRange(0, 4000) / 100.0; };
        for (int i = 0; i < count; ++i) {
            const Vec2 a(coordinate(), coordinate());
            const Vec2 b(coordinate(), coordinate());
            if ((b - a).norm() < 2.0) continue;
            pattern.strips.push_back(strip("s" + std::to_string(i), {a, b}, *rc::gen::inRange(5, 30) / 10.0,
                                           *rc::gen::inRange(4, 10) / 10.0));
            drawn.push_back(pattern.strips.back().region);
        }
        RC_PRE(!pattern.strips.empty());
        const Pattern finished = finish_pattern(pattern, 3.0);
        double sum = 0.0;
        double perimeter = 0.0;
        std::vector<Region> regions;
        for (const Strip& s : finished.strips) {
            sum += area(s.region);
            for (const Polygon& polygon : s.region) perimeter += length(polygon.outer, true);
            regions.push_back(s.region);
        }
        RC_ASSERT(std::abs(area(unite(regions)) - sum) < 1e-4);
        RC_ASSERT(std::abs(area(unite(drawn)) - sum) < perimeter * 2 * snap_mm);
    }));
}

#include "ruche/scene/read_scene.hpp"

#include <doctest/doctest.h>

#include "ruche/scene/check_scene.hpp"

using namespace ruche;

namespace {
const std::string drawn = "[pattern]\nsvg = \"a.svg\"\n";
}

TEST_CASE("scene: the shortest one has every default") {
    const Scene scene = parse_scene(drawn, "folder/kite.toml");
    CHECK(scene.pattern.svg == "a.svg");
    CHECK(resolved_path(scene, scene.pattern.svg) == "folder/a.svg");
    CHECK(scene_name(scene) == "kite");
    CHECK(scene.fabric.prestretch == std::array{1.7, 1.7});
    CHECK(scene.material_sources.at("gamma_1") == "paper Table 1");
    CHECK(scene.warnings.empty());
}

TEST_CASE("scene: one pre-stretch or two") {
    CHECK(parse_scene(drawn + "[fabric]\nprestretch = 1.65", "k").fabric.prestretch ==
          std::array{1.65, 1.65});
    CHECK(parse_scene(drawn + "[fabric]\nprestretch = [1.6, 1.7]", "k").fabric.prestretch ==
          std::array{1.6, 1.7});
}

TEST_CASE("scene: a rule takes over the thickness and side of [plastic] unless it says otherwise") {
    const Scene scene = parse_scene(drawn +
                                        "[plastic]\nthickness_mm = 0.8\nside = \"back\"\n"
                                        "[[plastic.rule]]\nmatch = \"red\"\nthickness_mm = 1.2\n"
                                        "[[plastic.rule]]\nmatch = \"blue\"\nside = \"front\"\n"
                                        "[[plastic.rule]]\nmatch = \"edge\"\nrole = \"fabric_outline\"\n",
                                    "k");
    REQUIRE(scene.plastic.rules.size() == 3);
    CHECK(scene.plastic.rules[0].thickness == 1.2);
    CHECK(scene.plastic.rules[0].side == Side::back);
    CHECK(scene.plastic.rules[1].thickness == 0.8);
    CHECK(scene.plastic.rules[1].side == Side::front);
    CHECK(scene.plastic.rules[2].role == PrintRule::Role::fabric_outline);
}

TEST_CASE("scene: material values replace the card's and say where they are from") {
    const Scene scene = parse_scene(drawn +
                                        "[material]\nfabric_thickness_mm = 0.5\ngamma_1 = 1\n"
                                        "[material.source]\ngamma_1 = \"measured\"\n",
                                    "k.toml");
    CHECK(scene.material.fabric_thickness == 0.5);
    CHECK(scene.material_sources.at("fabric_thickness") == "k.toml:4");
    CHECK(scene.material_sources.at("gamma_1") == "measured");
    CHECK(scene.material_sources.at("gamma_2") == "paper Table 1");
}

TEST_CASE("scene: what was assumed is said with units") {
    const std::vector<std::string> texts =
        assumptions(parse_scene(drawn + "[plastic]\nthickness_mm = 1", "k"), {});
    REQUIRE(texts.size() == 8);
    CHECK(texts[0] == "fabric.card = spandex-tpu95a (not given)");
    CHECK(texts[1] == "fabric.prestretch = [1.7, 1.7] (not given)");
    CHECK(texts[3] == "fabric.margin = 5 mm (not given)");
    CHECK(texts[4] == "plastic.side = front (not given)");
    CHECK(texts[5].starts_with("fabric_thickness = 0.46 mm (assumed"));
    const std::vector<std::string> found = assumptions(parse_scene(drawn, "k"), {.outline_layer = "Fabric"});
    CHECK(found[3] == "fabric.outline = the drawing's layer \"Fabric\" (not given, taken for its name)");
    CHECK(found[4] == "plastic.thickness = 0.6 mm (not given)");
}

TEST_CASE("scene: supports are a box or a point, forces as well") {
    const Scene scene = parse_scene(drawn +
                                        "[[support]]\nmin_mm = [0, 0]\nmax_mm = [1, 30]\n"
                                        "[[support]]\npoint_mm = [10, 5]\nfix = \"z\"\nmove_mm = [0, 0, 3]\n"
                                        "[[force]]\npoint_mm = [3, 3]\nforce_n = [0, 0, 0.1]\n",
                                    "k");
    REQUIRE(scene.supports.size() == 2);
    CHECK(scene.supports[0].where == Selection::Where::box);
    CHECK(scene.supports[0].fix == "xyz");
    CHECK(scene.supports[1].where == Selection::Where::point);
    CHECK(scene.supports[1].move_mm == std::array{0.0, 0.0, 3.0});
    REQUIRE(scene.forces.size() == 1);
    CHECK(scene.forces[0].force_n[2] == 0.1);
}

TEST_CASE("scene: plastic may be none, in the file and on the command line") {
    CHECK(parse_scene("plastic = \"none\"\n" + drawn, "k").plastic.none);
    CHECK(parse_scene(drawn + "[plastic]\nthickness_mm = 1\n", "k", {parse_override("plastic=none")})
              .plastic.none);
}

TEST_CASE("scene: mistakes are named with file, line, key and what is allowed") {
    struct Case {
        std::string text;
        std::string message;
    };
    const std::string svg = "pattern.svg = \"a.svg\"\n";
    const Case cases[] = {
        {svg + "[fabric]\nprestretch = 0.8",
         "kite.toml:3: fabric.prestretch: 0.8 is outside [1, 3]\n  Length on the printing frame over "
         "relaxed"},
        {svg + "[material]\nfabric_thicknes_mm = 1",
         "kite.toml:3: material.fabric_thicknes_mm: unknown key; did you mean fabric_thickness_mm?"},
        {svg + "[fabrik]\ncard = \"x\"", "kite.toml:2: fabrik: unknown key; did you mean fabric?"},
        {svg + "[fabric]\nprestretch = \"1.7\"",
         "expected a number or two numbers [a, b], found the text \"1.7\""},
        {svg + "[fabric]\nprestretch = [1.7, 1.7, 1.7]", "found an array of 3"},
        {svg + "[fabric]\nprestretch = nan", "nan is not a finite number"},
        {svg + "[fabric]\nprestretch = inf", "inf is not a finite number"},
        {svg + "[fabric]\nprestretch = 1.72",
         "kite.toml:3: fabric.prestretch: 1.72 is beyond the fabric's law"},
        {svg + "[fabric]\ncard = \"silk\"", "kite.toml:3: fabric.card: there is no material card \"silk\""},
        {svg + "[fabric]\ncard = \"silk.toml\"", "silk.toml: there is no such file"},
        {svg + "fabric = 3", "kite.toml:2: fabric: expected a table, [fabric], found the integer 3"},
        {svg + "[plastic]\nside = \"frnt\"", "\"frnt\" is none of front, back; did you mean front?"},
        {svg + "[plastic]\nthickness_mm = 0", "0 is outside [0.001, 50]"},
        {svg + "plastic = \"nothing\"", "expected [plastic] or \"none\""},
        {svg + "plastic = 3", "expected a table"},
        {svg + "[[plastic.rule]]\nside = \"back\"", "kite.toml:2: plastic.rule.1.match: missing"},
        {svg + "[plastic]\nrule = 3", "expected a list of tables, [[plastic.rule]]"},
        {svg + "[solver]\nseed = 1.5", "expected an integer, found the number 1.5"},
        {svg + "[solver]\nseed = 99999999999", "expected an integer"},
        {svg + "[solver]\ndeterministic = 1", "expected true or false"},
        {svg + "[mesh]\nsize_mm = -1", "-1 is outside"},
        {"[fabric]\nprestretch = 1.5", "there is nothing to simulate"},
        {svg + "pattern.mesh = \"a.ply\"", "kite.toml:2: pattern.mesh: contradicts pattern.svg"},
        {svg + "pattern.options.width_mm = 1",
         "kite.toml:2: pattern.options.width_mm: means nothing with pattern.svg"},
        {"pattern.mesh = \"a.ply\"\npattern.width_mm = 3", "means nothing with pattern.mesh"},
        {"pattern.mesh = \"a.ply\"\n[[plastic.rule]]\nmatch = \"red\"",
         "kite.toml:3: plastic.rule.1.match: means"},
        {svg + "[gravity]\nacceleration_mm_per_s2 = [0, 0, -9810]",
         "kite.toml:3: gravity.acceleration_mm_per_s2: "
         "gravity without a support or a table"},
        {svg + "[gravity]\ntable = true", "a table holds nothing without gravity"},
        {svg + "[[support]]\nfix = \"xyz\"", "kite.toml:2: support.1.min_mm: missing"},
        {svg + "[[support]]\nmin_mm = [0, 0]", "support.1.max_mm: missing"},
        {svg + "[[support]]\nmin_mm = [0, 0]\nmax_mm = [1, 1]\npoint_mm = [0, 0]", "contradicts the box"},
        {svg + "[[support]]\nmin_mm = [2, 0]\nmax_mm = [1, 1]",
         "kite.toml:3: support.1.min_mm: the box is inside out"},
        {svg + "[[support]]\npoint_mm = [2, 0]\nfix = \"q\"", "\"q\" is not made of the directions"},
        {svg + "[[support]]\npoint_mm = [2, 0]\nfix = \"\"", "not made of the directions"},
        {svg + "[[support]]\npoint_mm = [2, 0]\nfix = \"xy\"\nmove_mm = [0, 0, 1]", "does not hold z"},
        {svg + "[[force]]\npoint_mm = [0, 0]\nforce_n = [0, 0, 1]", "a force without a support"},
        {svg + "[material]\nalpha_1_mpa = 0\nbeta_1_mpa = 0\nneo_hookean_share = 0", "no stiffness at all"},
        {svg + "[material.source]\ngamma_1 = \"x\"", "there is no gamma_1 in this scene"},
        {svg + "[fabric]\nmargin_mm = 1e9", "1000000000 is outside"},
        {svg + "[output]\npicture_width_px = 100000", "is outside [64, 16384]"},
        {svg + "[fabric]\naxis_deg = 1979-05-27", "found a date"},
    };
    for (const Case& c : cases)
        CHECK_THROWS_WITH_AS(parse_scene(c.text, "kite.toml"), doctest::Contains(c.message.c_str()),
                             InputError);
}

TEST_CASE("scene: an override is checked like the file and named as it was given") {
    const Override far = parse_override("fabric.prestretch=0.8");
    CHECK_THROWS_WITH_AS(
        parse_scene(drawn, "k", {far}),
        doctest::Contains("--set fabric.prestretch=0.8: fabric.prestretch: 0.8 is outside [1, 3]"),
        InputError);
    const Override misspelt = parse_override("fabric.prestrech=1.5");
    CHECK_THROWS_WITH_AS(parse_scene(drawn, "k", {misspelt}), doctest::Contains("did you mean prestretch?"),
                         InputError);
    CHECK_THROWS_AS(parse_override("fabric.prestretch"), InputError);
    CHECK_THROWS_AS(parse_override("=3"), InputError);
    for (const char* text : {"pattern.svg.x=1", "a..b=1", "plastic.rule.1.side=back", ".=1", "a=[[[", "a={b"})
        CHECK_THROWS_AS(parse_scene(drawn, "k", {parse_override(text)}), InputError);
}

TEST_CASE("scene: overrides reach lists, text goes without quotes, the last one wins") {
    const std::string text = drawn + "[[plastic.rule]]\nmatch = \"red\"\n";
    const Scene scene =
        parse_scene(text, "k",
                    {parse_override("plastic.rule.1.side=back"), parse_override("mesh.size_mm=3"),
                     parse_override("mesh.size_mm=2"), parse_override("pattern.svg=b c.svg"),
                     parse_override("fabric.prestretch=[1.5, 1.6]")});
    CHECK(scene.plastic.rules[0].side == Side::back);
    CHECK(scene.mesh.size_mm == 2);
    CHECK(scene.pattern.svg == "b c.svg");
    CHECK(scene.fabric.prestretch == std::array{1.5, 1.6});
}

TEST_CASE("scene from a drawing: the ending says what it is") {
    CHECK(scene_from_drawing("a b/c.svg").pattern.svg == "a b/c.svg");
    CHECK(scene_from_drawing("c.PLY").pattern.mesh == "c.PLY");
    CHECK(scene_name(scene_from_drawing("a b/c.svg")) == "c");
    CHECK_THROWS_WITH_AS(read_scene_or_drawing("."), doctest::Contains("is neither a scene"), InputError);
    CHECK_THROWS_WITH_AS(read_scene_or_drawing("nothing"), doctest::Contains("there is no such file"),
                         InputError);
}

TEST_CASE("check_scene: a scene built in code is checked as well") {
    Scene scene;
    CHECK_THROWS_AS(check_scene(scene), InputError);
    scene.pattern.svg = "a.svg";
    CHECK_NOTHROW(check_scene(scene));
    scene.supports.push_back({});
    scene.supports[0].fix = "w";
    CHECK_THROWS_AS(check_scene(scene), InputError);
}

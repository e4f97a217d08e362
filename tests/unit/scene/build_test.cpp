#include "ruche/scene/build.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "ruche/scene/read_scene.hpp"

using namespace ruche;

namespace {
/// Two unit squares side by side, or apart when `gap` is positive: vertices 0-3 and 4-7.
PrintMesh two_squares(double gap) {
    PrintMesh layout;
    for (const double x : {0.0, 1.0 + gap})
        for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)})
            layout.mesh.vertices.emplace_back(corner.x() + x, corner.y());
    layout.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    layout.print.resize(4);
    return layout;
}

Scene with(const std::string& text) { return parse_scene("pattern.mesh = \"a.ply\"\n" + text, "k.toml"); }
const std::string down = "[gravity]\nacceleration_mm_per_s2 = [0, 0, -9810]\n";
}  // namespace

TEST_CASE("scene_model: a box holds the vertices inside it, borders included, where they are taken") {
    const ModelInput model = scene_model(
        with("[[support]]\nmin_mm = [0, 0]\nmax_mm = [1, 0]\nfix = \"xz\"\nmove_mm = [0.5, 0, 2]\n"),
        two_squares(3));
    REQUIRE(model.supports.size() == 2);
    CHECK(model.supports[0].vertex == 0);
    CHECK(model.supports[1].vertex == 1);
    CHECK(model.supports[1].fixed == std::array{true, false, true});
    CHECK((model.supports[1].at - Vec3(1.5, 0, 2)).norm() == 0);
}

TEST_CASE("scene_model: a point holds the nearest vertex, and supports of one vertex add up") {
    const ModelInput model =
        scene_model(with("[[support]]\npoint_mm = [5, 5]\nfix = \"x\"\n"
                         "[[support]]\npoint_mm = [5, 0.9]\nfix = \"yz\"\nmove_mm = [0, 1, 0]\n"),
                    two_squares(3));
    REQUIRE(model.supports.size() == 1);
    CHECK(model.supports[0].vertex == 6);
    CHECK(model.supports[0].fixed == std::array{true, true, true});
    CHECK((model.supports[0].at - Vec3(5, 2, 0)).norm() == 0);
}

TEST_CASE("scene_model: a force is shared equally") {
    const ModelInput model =
        scene_model(with("[[support]]\nmin_mm = [0, 0]\nmax_mm = [9, 9]\n"
                         "[[force]]\nmin_mm = [1, 0]\nmax_mm = [1, 1]\nforce_n = [0, 0, 3]\n"),
                    two_squares(3));
    REQUIRE(model.forces.size() == 2);
    CHECK((model.forces[1].force - Vec3(0, 0, 1.5)).norm() == 0);
}

TEST_CASE("scene_model: supports that hold nothing or contradict each other are refused") {
    CHECK_THROWS_WITH_AS(scene_model(with("[[support]]\nmin_mm = [7, 7]\nmax_mm = [8, 8]\n"), two_squares(3)),
                         doctest::Contains("k.toml:2: support.1: there is no vertex of the mesh in this box\n"
                                           "  The layout reaches from [0, 0] to [5, 1] mm."),
                         InputError);
    CHECK_THROWS_WITH_AS(
        scene_model(with("[[support]]\npoint_mm = [0, 0]\n"
                         "[[support]]\npoint_mm = [0, 0]\nmove_mm = [0, 0, 1]\n"),
                    two_squares(3)),
        doctest::Contains("k.toml:4: support.2: takes the vertex at [0, 0] mm somewhere else"), InputError);
}

TEST_CASE("scene_model: every piece must be held against what pulls it") {
    const Scene one_held = with("[[support]]\npoint_mm = [0, 0]\n" + down);
    CHECK_THROWS_WITH_AS(scene_model(one_held, two_squares(3)), doctest::Contains("piece 2 of 2"),
                         InputError);
    const Scene sideways = with("[[support]]\nmin_mm = [0, 0]\nmax_mm = [9, 9]\nfix = \"xy\"\n" + down);
    CHECK_THROWS_WITH_AS(scene_model(sideways, two_squares(3)), doctest::Contains("pulled along z"),
                         InputError);
    const Scene held = with("[[support]]\nmin_mm = [0, 0]\nmax_mm = [9, 0]\n" + down);
    CHECK(scene_model(held, two_squares(3)).gravity[2] == -9810);
    CHECK(scene_model(with(down + "table = true\n"), two_squares(3)).table.present);
}

TEST_CASE("scene_model: what has no weight does not rest on a table, but may be held") {
    const std::string weightless =
        "[material]\nfabric_areal_density_kg_per_m2 = 0\nplastic_density_kg_per_m3 = 0\n";
    const std::string light_fabric = "[material]\nfabric_areal_density_kg_per_m2 = 0\n";
    const std::string light_plastic = "[material]\nplastic_density_kg_per_m3 = 0\n";
    const std::string table = down + "table = true\n";
    PrintMesh layout = two_squares(3);
    layout.print[0].front = layout.print[1].back = 0.6;  // the first piece alone
    CHECK_THROWS_WITH_AS(
        scene_model(with(table + weightless), layout),
        doctest::Contains("k.toml:4: gravity.table: piece 1 of 2 of the sheet has no weight"), InputError);
    CHECK_THROWS_WITH_AS(scene_model(with(table + light_fabric), layout), doctest::Contains("piece 2 of 2"),
                         InputError);
    layout.print[3].front = 0.6;
    CHECK(scene_model(with(table + light_fabric), layout).table.present);
    CHECK(scene_model(with(table + light_plastic), two_squares(3)).table.present);
    const std::string held = "[[support]]\nmin_mm = [0, 0]\nmax_mm = [9, 0]\n" + down + weightless;
    CHECK(Model(scene_model(with(held), two_squares(3))).size() > 0);
    for (const char* key : {"fabric_areal_density_kg_per_m2", "plastic_density_kg_per_m3"})
        CHECK_THROWS_WITH_AS(with("[material]\n" + std::string(key) + " = -1e-9\n"),
                             doctest::Contains("-1e-09 is outside [0, "), InputError);
}

TEST_CASE("scene_mesh: a generated strip is meshed with its thickness, side and fabric") {
    const Scene scene = parse_scene(
        "[pattern]\ngenerator = \"strip\"\n[pattern.options]\nlength_mm = 10\nwidth_mm = "
        "1\n[fabric]\nmargin_mm = 2\n"
        "[plastic]\nthickness_mm = 0.8\nside = \"back\"\n",
        "k.toml");
    const PrintMesh layout = scene_mesh(scene);
    double printed = 0.0;
    for (int t = 0; t < layout.mesh.triangle_count(); ++t) {
        const Print& print = layout.print[static_cast<std::size_t>(t)];
        CHECK(print.front == 0.0);
        if (print.bare()) continue;
        CHECK(print.back == 0.8);
        printed += layout_area(layout.mesh, t);
    }
    CHECK(std::abs(printed - 10.0) < 1e-6);
}

TEST_CASE("scene_pattern: a generator's mistake is found in the scene") {
    const Scene scene = parse_scene(
        "[pattern]\ngenerator = \"strip\"\n[pattern.options]\nlength_mm = 10\nwidht_mm = 1\n", "k.toml");
    CHECK_THROWS_WITH_AS(scene_pattern(scene), doctest::Contains("k.toml:5: pattern.options.widht_mm"),
                         InputError);
    CHECK_THROWS_WITH_AS(scene_pattern(parse_scene("pattern.generator = \"stripp\"", "k.toml")),
                         doctest::Contains("k.toml:1: pattern.generator"), InputError);
}

TEST_CASE("scene_mesh: a mesh that no machine could solve is refused at once") {
    const Scene scene = parse_scene(
        "pattern.generator = \"strip\"\n[mesh]\nsize_mm = 0.01\nfabric_size_mm = 0.01\n", "k.toml");
    CHECK_THROWS_WITH_AS(scene_mesh(scene), doctest::Contains("k.toml:3: mesh.size_mm: 0.01 mm"), InputError);
}

TEST_CASE("scene_pattern: strips that end up on the back are thicker by the factor, whoever put them there") {
    const auto thicknesses = [](const std::string& plastic) {
        const Scene scene = parse_scene(
            "[pattern]\ngenerator = \"staggered\"\n[pattern.options]\nrows = 2\nstrips_per_row = 2\n"
            "half_strips = false\nalternate_sides = true\n[plastic]\nthickness_mm = 0.8\n" +
                plastic,
            "k.toml");
        std::map<Side, double> found;
        for (const Strip& strip : scene_pattern(scene).strips) found[strip.side] = strip.thickness;
        return found;
    };
    const double less = 0.8 * 0.9;
    CHECK(thicknesses("") == std::map<Side, double>{{Side::front, 0.8}, {Side::back, 0.8}});
    CHECK(thicknesses("back_thickness_factor = 0.9") ==
          std::map<Side, double>{{Side::front, 0.8}, {Side::back, less}});
    CHECK(thicknesses("side = \"back\"\nback_thickness_factor = 0.9") ==
          std::map<Side, double>{{Side::front, 0.8}, {Side::back, less}});
    const std::map<Side, double> by_rule = thicknesses(
        "back_thickness_factor = 0.9\n[[plastic.rule]]\nmatch = \"back\"\nside = \"back\"\nthickness_mm = "
        "1.0\n");
    CHECK(by_rule.at(Side::back) == 1.0 * 0.9);
}

TEST_CASE("scene_pattern: the factor of the back needs strips that have one thickness") {
    CHECK_THROWS_WITH_AS(with("[plastic]\nback_thickness_factor = 0.9"),
                         doctest::Contains("k.toml:3: plastic.back_thickness_factor: means nothing"),
                         InputError);
    CHECK_THROWS_AS(with("[plastic]\nback_thickness_factor = 0.05"), InputError);
}

TEST_CASE("scene_pattern: a field's file lies beside the scene, and its mistakes carry its own name") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / "ruche-scene-with-a-field" / "scenes";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "field.csv") << "-9,-9,0,3\n9,-9,0,3\n-9,9,0,3\n9,9,0,3\n";
    const std::string options =
        "[pattern]\ngenerator = \"traced\"\n[pattern.options]\nfield = \"file\"\nfile = \"field.csv\"\n"
        "inner_mm = 0\nouter_mm = ";
    const auto scene = [&](const char* outer) {
        return parse_scene(options + outer, (folder / "k.toml").string());
    };
    CHECK(scene_pattern(scene("9")).strips.size() > 4);
    CHECK_THROWS_WITH_AS(scene_pattern(scene("9.5")), doctest::Contains("field.csv: the grid reaches over x"),
                         InputError);
    std::filesystem::remove_all(folder.parent_path());
}

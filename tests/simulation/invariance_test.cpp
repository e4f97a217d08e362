// The same sheet described differently has the same shape: whole solves, on top of the terms' own
// invariances.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>

#include "release.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Staggered strips with nothing symmetric about them: two pre-stretches, fabric axes askew.
ModelInput askew_sheet() {
    const Scene scene = parse_scene(
        "pattern.generator = \"staggered\"\n"
        "pattern.options = { rows = 4, strips_per_row = 1 }\n"
        "fabric = { prestretch = [1.7, 1.55], axis_deg = 20, margin_mm = 1.5 }\n",
        "test.toml");
    return scene_model(scene, scene_mesh(scene));
}

double released_energy(const ModelInput& input) {
    const Equilibrium state = solve(Model(input));
    REQUIRE(certain(state));
    return state.energy.total();
}

// Of a strict minimum that is found to a residual of 1e-9 N, the energy is exact to (residual *
// displacement), far below 1e-9 of it: what is left is rounding.
constexpr double same = 1e-9;

}  // namespace

TEST_CASE("whole solve: turning the layout together with the fabric's axes changes nothing") {
    const ModelInput sheet = askew_sheet();
    ModelInput turned = sheet;
    const Eigen::Rotation2Dd turn(37.0 * M_PI / 180.0);
    for (Vec2& vertex : turned.mesh.vertices) vertex = turn * vertex;
    const double energy = released_energy(sheet);
    ModelInput half_turned = turned;  // the layout alone: another sheet
    turned.fabric_axis_deg += 37.0;
    CHECK(released_energy(turned) == doctest::Approx(energy).epsilon(same));
    CHECK(std::abs(released_energy(half_turned) / energy - 1.0) > 1e3 * same);
}

TEST_CASE("whole solve: numbering vertices and triangles otherwise changes nothing") {
    const ModelInput sheet = askew_sheet();
    const double energy = released_energy(sheet);
    std::mt19937 random(5);
    std::vector<int> new_name(sheet.mesh.vertices.size());
    std::iota(new_name.begin(), new_name.end(), 0);
    std::shuffle(new_name.begin(), new_name.end(), random);
    std::vector<int> order(sheet.mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    ModelInput renamed = sheet;
    for (std::size_t v = 0; v < new_name.size(); ++v)
        renamed.mesh.vertices[new_name[v]] = sheet.mesh.vertices[v];
    for (std::size_t t = 0; t < order.size(); ++t) {
        const Triangle& old = sheet.mesh.triangles[order[t]];
        for (std::size_t i = 0; i < 3; ++i)
            renamed.mesh.triangles[t][i] = new_name[old[(i + t) % 3]];  // another first vertex as well
        renamed.print[t] = sheet.print[order[t]];
    }
    CHECK(released_energy(renamed) == doctest::Approx(energy).epsilon(same));
}

TEST_CASE("whole solve: the mirrored drawing, and the print on the other side, store the same energy") {
    const ModelInput sheet = askew_sheet();
    const double energy = released_energy(sheet);
    ModelInput mirrored = sheet;
    for (Vec2& vertex : mirrored.mesh.vertices) vertex.x() = -vertex.x();
    for (Triangle& triangle : mirrored.mesh.triangles) std::swap(triangle[1], triangle[2]);
    ModelInput half_mirrored = mirrored;  // the fabric's axes are not: another sheet
    mirrored.fabric_axis_deg = -sheet.fabric_axis_deg;
    CHECK(released_energy(mirrored) == doctest::Approx(energy).epsilon(same));
    CHECK(std::abs(released_energy(half_mirrored) / energy - 1.0) > 1e3 * same);
    ModelInput other_side = sheet;
    for (Print& print : other_side.print) std::swap(print.front, print.back);
    CHECK(released_energy(other_side) == doctest::Approx(energy).epsilon(same));
}

TEST_CASE("whole solve: a drawing turned by 37 degrees, fabric axes too, stores the same energy") {
    // The mesher works on other coordinates and makes another mesh, so the energies differ by what the mesh
    // changes: 0.2 % at the default size, a quarter of that with elements half as large. The fabric's axes
    // left behind, or turned the wrong way, change 0.3 % or more.
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "ruche-turned-drawing";
    std::filesystem::create_directories(folder);
    const auto energy = [&](double turn_deg, double axis_deg) {
        const std::string file = (folder / "drawing.svg").string();
        // In an SVG y points down: rotate(-a) turns what one sees counter-clockwise by a.
        std::ofstream(file) << fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"100mm\" viewBox=\"0 0 100 "
            "100\">"
            "<g transform=\"translate(50 50) rotate({})\" stroke=\"black\" fill=\"none\">"
            "<path d=\"M-10 -3h20M-10 0h20M-10 3h20\"/></g></svg>",
            -turn_deg);
        const Result result = simulate(
            parse_scene(fmt::format("pattern.svg = \"drawing.svg\"\nplastic.thickness_mm = 0.8\n"
                                    "fabric = {{ prestretch = [1.7, 1.5], axis_deg = {}, margin_mm = 3 }}\n",
                                    axis_deg),
                        (folder / "scene.toml").string()));
        REQUIRE(certain(result.equilibrium));
        return result.equilibrium.energy.total();
    };
    const double straight = energy(0.0, 10.0);
    constexpr double mesh_error = 0.001;
    CHECK(energy(37.0, 47.0) == doctest::Approx(straight).epsilon(mesh_error));
    CHECK(energy(37.0, 10.0) > (1.0 + 2.0 * mesh_error) * straight);
    CHECK(energy(37.0, -27.0) > (1.0 + 2.0 * mesh_error) * straight);
    std::filesystem::remove_all(folder);
}

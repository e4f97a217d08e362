// Strips as elastic rods (model.strips = rods): whole releases against closed forms.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "release.hpp"
#include "ruche/core/error.hpp"
#include "ruche/material/rod_section.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"
#include "ruche/study/validation/sheet_measures.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

Result released_as_rods(const std::string& text) {
    return simulate(parse_scene("model.strips = \"rods\"\n" + text, "test.toml"));
}

/// Fabric that is hardly there, as far as it is not what the natural curvature is computed with.
const std::string faint_fabric =
    "material = { alpha_1_mpa = 1e-6, alpha_2_mpa = 1e-6, alpha_3_mpa = 1e-6, beta_1_mpa = 1e-6, "
    "beta_2_mpa = 1e-6, neo_hookean_share = 1e-6, fabric_bending_stiffness_n_mm = 1e-5 }\n";

}  // namespace

TEST_CASE("rods: a strip in hardly any fabric has the bimetal's curvature, front and back") {
    const auto curvature = [](double thickness, const std::string& side) {
        const Result result = released_as_rods(
            faint_fabric + fmt::format("pattern.generator = \"strip\"\nfabric.margin_mm = 1\n"
                                       "plastic = {{ thickness_mm = {}, side = \"{}\" }}\n",
                                       thickness, side));
        REQUIRE(certain(result.equilibrium));
        return measure_strips(result.layout, result.shape).at(0).curvature;
    };
    CHECK(curvature(0.6, "front") == doctest::Approx(0.152362385).epsilon(0.005));
    CHECK(curvature(1.0, "front") == doctest::Approx(0.051255722).epsilon(0.005));
    CHECK(curvature(1.0, "back") == doctest::Approx(-0.051255722).epsilon(0.005));
}

TEST_CASE("rods: a cantilever bends about both axes of its section under a load at its tip as a beam does") {
    // 20 edges of 1 mm along y = 0; what lies at x <= 1 is held.
    constexpr int edges = 20;
    ModelInput input;
    input.prestretch = {1.0, 1.0};
    Material& m = input.material;
    m.alpha_1 = m.alpha_2 = m.alpha_3 = 1e-6;
    m.beta_1 = m.beta_2 = m.neo_hookean_share = 0.0;
    m.fabric_bending_stiffness = 1e-6;
    input.options.strips = StripModel::rods;
    input.mesh = rectangle_mesh(MeshKind::alternating, {.length = edges, .width = 2.0, .across = 2});
    Rod rod{.width = 1.2, .thickness = 0.6};
    for (int i = 0; i <= edges; ++i) {
        for (int v = 0; v < input.mesh.vertex_count(); ++v) {
            if ((input.mesh.vertices[v] - Vec2(i, 1.0)).norm() < 1e-9) rod.vertices.push_back(v);
        }
    }
    REQUIRE(rod.vertices.size() == edges + 1);
    input.rods = {rod};
    for (int v = 0; v < input.mesh.vertex_count(); ++v) {
        const Vec2& p = input.mesh.vertices[v];
        if (p.x() < 1.0 + 1e-9) input.supports.push_back({.vertex = v, .at = Vec3(p.x(), p.y(), 0.0)});
    }
    const Vec3 stiffness = turning_stiffness({1.2, 0.6, m.plastic_youngs_modulus, m.laminate_poissons_ratio});
    // Joint i turns by M l / B, M = F (L - i): the tip moves by F / B sum k^2, k = 1 .. 19.
    const double sum = 19.0 * 20.0 * 39.0 / 6.0;
    for (const int axis : {2, 1}) {
        const double force = 0.02 * stiffness[axis == 2 ? 1 : 2] / sum;
        ModelInput loaded = input;
        Vec3 direction = Vec3::Zero();
        direction[axis] = force;
        loaded.forces = {{.vertex = rod.vertices.back(), .force = direction}};
        const Model model(loaded);
        const Equilibrium state = solve(model, {.noise_mm = 0.0});
        REQUIRE(certain(state));
        const double moved =
            state.x[3 * rod.vertices.back() + axis] - model.initial()[3 * rod.vertices.back() + axis];
        // Fabric of 1e-6 MPa around 1 mm^4 of 72 MPa.
        CHECK(moved == doctest::Approx(0.02).epsilon(2e-3));
    }
}

TEST_CASE("rods: examples' patterns come to a certified rest, and halving the elements changes little") {
    const auto curvature = [](double size) {
        const Result result = released_as_rods(fmt::format(
            "pattern.generator = \"staggered\"\npattern.options = {{ rows = 5, strips_per_row = 2 }}\n"
            "fabric.margin_mm = 1\nplastic.thickness_mm = 0.7\nmesh.size_mm = {}\n",
            size));
        REQUIRE(certain(result.equilibrium));
        double sum = 0.0;
        const auto strips = measure_strips(result.layout, result.shape);
        for (const StripMetrics& strip : strips) sum += strip.curvature;
        MESSAGE(result.layout.mesh.triangle_count()
                << " triangles, " << result.equilibrium.iterations << " steps, "
                << sum / static_cast<double>(strips.size()) << " /mm");
        return sum / static_cast<double>(strips.size());
    };
    const double coarse = curvature(1.0);
    CHECK(coarse > 0.02);
    CHECK(curvature(0.5) == doctest::Approx(coarse).epsilon(0.1));
}

TEST_CASE(
    "rods: on the radial pattern rings contract across the strips alike, under the shell by what is "
    "printed") {
    // The torus of the examples; rings where 20, 20 and 40 strips of 1 mm are printed.
    const auto rings = [](const std::string& strips) {
        const Result result =
            simulate(parse_scene("model.strips = \"" + strips +
                                     "\"\npattern.generator = \"radial\"\nfabric.outline = \"fabric\"\n"
                                     "plastic.thickness_mm = 0.7\nsolver = { seed = 1, noise_mm = 0.01 }\n",
                                 "test.toml"));
        CHECK(certain(result.equilibrium));
        std::vector<double> stretches;
        for (const Vec2& ring : {Vec2(13.0, 16.0), Vec2(17.5, 21.0), Vec2(23.5, 28.0), Vec2(28.0, 33.0)})
            stretches.push_back(
                transverse_stretch(result.layout, result.shape, {.inner = ring[0], .outer = ring[1]}));
        MESSAGE(strips << ": " << result.layout.mesh.triangle_count() << " triangles, "
                       << result.equilibrium.iterations << " steps; transverse stretch " << stretches[0]
                       << ", " << stretches[1] << ", " << stretches[2] << ", " << stretches[3]);
        // The strips of each ring begin at its radius and end at 34 mm.
        std::map<int, std::pair<double, int>> tube;
        for (const StripMetrics& strip : measure_strips(result.layout, result.shape)) {
            auto& [sum, count] = tube[static_cast<int>(std::lround(strip.printed_length))];
            sum += strip.curvature;
            ++count;
        }
        for (const auto& [length, of] : tube)
            MESSAGE(of.second << " strips of " << length << " mm: curvature " << of.first / of.second
                              << " /mm");
        return stretches;
    };
    const auto shell = rings("shell");
    const auto rods = rings("rods");
    for (std::size_t k = 0; k < shell.size(); ++k) CHECK(rods[k] < shell[k]);
}

TEST_CASE("rods: the report says what they leave out, and a mesh file is refused") {
    const Scene scene = parse_scene("model.strips = \"rods\"\npattern.generator = \"strip\"\n", "test.toml");
    const auto texts = assumptions(scene, {});
    CHECK(
        std::ranges::any_of(texts, [](const std::string& text) { return text.starts_with("model.strips"); }));
    CHECK_THROWS_AS(released_as_rods("pattern.mesh = \"layout.ply\"\n"), InputError);
}

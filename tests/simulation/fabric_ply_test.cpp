// Whole releases with the fabric's own law under plastic (model.fabric_ply = same_law).
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "release.hpp"
#include "ruche/material/consistent_modulus.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

Result released(const std::string& pattern, const std::string& fabric_ply, double modulus) {
    return simulate(parse_scene(
        fmt::format(
            "{}\nmodel.fabric_ply = \"{}\"\nmaterial.fabric_youngs_modulus_mpa = {}\nsolver.seed = 1\n",
            pattern, fabric_ply, modulus),
        "test.toml"));
}

double mean_curvature(const Result& result) {
    double sum = 0.0;
    const auto strips = measure_strips(result.layout, result.shape);
    for (const StripMetrics& strip : strips) sum += strip.curvature;
    return sum / static_cast<double>(strips.size());
}

const std::string strip_amid_fabric =
    "pattern.generator = \"strip\"\npattern.options.width_mm = 1.5\nfabric.margin_mm = 5\n"
    "plastic.thickness_mm = 0.6";
const std::string staggered_rows =
    "pattern.generator = \"staggered\"\npattern.options = { rows = 5, strips_per_row = 2 }\n"
    "fabric.margin_mm = 1\nplastic.thickness_mm = 0.7";

}  // namespace

TEST_CASE("same law: a strip in fabric and the staggered sheet come to a certified rest") {
    const double consistent = consistent_fabric_modulus({}, {1.7, 1.7});
    for (const std::string& pattern : {strip_amid_fabric, staggered_rows}) {
        const Result law = released(pattern, "same_law", 1.05);
        const Result linear = released(pattern, "linear", 1.05);
        const Result matched = released(pattern, "linear", consistent);
        CHECK(certain(law.equilibrium));
        CHECK(certain(linear.equilibrium));
        CHECK(certain(matched.equilibrium));
        MESSAGE("steps: law " << law.equilibrium.iterations << ", linear " << linear.equilibrium.iterations
                              << ", linear with the consistent modulus " << matched.equilibrium.iterations);
        MESSAGE("curvature: law " << mean_curvature(law) << ", linear " << mean_curvature(linear)
                                  << ", linear with the consistent modulus " << mean_curvature(matched));
        CHECK(law.equilibrium.iterations < 3 * linear.equilibrium.iterations + 10);
        // Fabric that pulls a ninth as hard bends less, and about as much whichever way that is modelled.
        CHECK(mean_curvature(law) < 0.65 * mean_curvature(linear));
        CHECK(mean_curvature(law) == doctest::Approx(mean_curvature(matched)).epsilon(0.3));
        CHECK(law.equilibrium.health.beyond_law == 0);
    }
}

TEST_CASE("same law: of linear isotropic fabric it gives the linear ply's equilibrium, rims and all") {
    ModelInput input;
    Material& m = input.material;
    m.alpha_1 = m.alpha_2 = m.fabric_youngs_modulus;
    m.alpha_3 = m.fabric_youngs_modulus / (2.0 * (1.0 + m.fabric_poissons_ratio));
    m.beta_1 = m.beta_2 = m.neo_hookean_share = 0.0;
    m.laminate_poissons_ratio = m.fabric_poissons_ratio;
    const PrintMesh layout =
        printed(rectangle_mesh(MeshKind::jittered, {.length = 12.0, .width = 2.0, .across = 2}),
                [](const Vec2&) { return 0.8; });
    const Equilibrium linear = release(layout, input);
    input.options.fabric_ply = FabricPlyLaw::same_law;
    const Equilibrium law = release(layout, input);
    REQUIRE(certain(linear));
    REQUIRE(certain(law));
    CHECK(law.energy.total() == doctest::Approx(linear.energy.total()).epsilon(1e-10));
    CHECK(law.x.size() > linear.x.size());
}

TEST_CASE("same law: averaged edge normals come to rest too, without unknowns") {
    ModelInput input;
    input.options.fabric_ply = FabricPlyLaw::same_law;
    input.options.edge_normals = EdgeNormals::averaged;
    const PrintMesh layout =
        printed(rectangle_mesh(MeshKind::alternating, {.length = 20.0, .width = 2.0, .across = 2}),
                [](const Vec2&) { return 0.8; });
    const Equilibrium state = release(layout, input);
    CHECK(certain(state));
    CHECK(state.x.size() == 3 * layout.mesh.vertex_count());
}

// How shapes depend on parameters: against closed forms, and against shapes that are solved for again.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "release.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"
#include "ruche/study/sensitivity/model_parameters.hpp"
#include "ruche/study/sensitivity/sensitivity.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

struct Studied {
    Result result;
    Sensitivities found;

    double slope(const std::string& measure, const std::string& parameter) const {
        const auto row = std::ranges::find(found.measures, measure, &ShapeMeasure::name);
        const auto column = std::ranges::find(found.parameters, parameter, &SensitivityParameter::name);
        REQUIRE(row != found.measures.end());
        REQUIRE(column != found.parameters.end());
        return found.slopes(row - found.measures.begin(), column - found.parameters.begin());
    }
};

Studied studied_scene(const std::string& scene) {
    Result result = simulate(parse_scene(scene, "test.toml"));
    REQUIRE(certain(result.equilibrium));
    std::optional<Sensitivities> found = sensitivities(result);
    REQUIRE(found);
    return {std::move(result), std::move(*found)};
}

/// Measures of the same sheet, solved for again with one parameter scaled.
std::vector<double> solved_again(const Studied& studied, const ModelParameter& parameter, double factor) {
    const Result& result = studied.result;
    ModelInput input = scene_model(result.scene, result.layout);
    input.options.log_extension = result.equilibrium.log_extension;
    parameter.scale(input, factor);
    const Equilibrium state = solve(Model(std::move(input)), {}, {}, &result.equilibrium.x);
    REQUIRE(certain(state));
    std::vector<double> values;
    const std::vector<Vec3> shape = positions(state, result.layout);
    const ShapeMeasures measures(result.layout, shape);
    for (const ShapeMeasure& measure : measures.values()) values.push_back(measure.value);
    return values;
}

/// The slopes of every measure against those of shapes that are solved for again. The error of a central
/// difference falls with the square of its step: a halved step leaves a quarter, and the extrapolation of
/// both is much closer than either.
void check_against_solves(const Studied& studied, const std::string& name, double step) {
    CAPTURE(name);
    const std::vector<ModelParameter> parameters =
        model_parameters(scene_model(studied.result.scene, studied.result.layout));
    const auto at = std::ranges::find(parameters, name, &ModelParameter::name);
    REQUIRE(at != parameters.end());
    const auto slopes = [&](double h) {
        const std::vector<double> more = solved_again(studied, *at, 1.0 + h);
        const std::vector<double> less = solved_again(studied, *at, 1.0 - h);
        std::vector<double> result(more.size());
        for (std::size_t m = 0; m < more.size(); ++m)
            result[m] = (more[m] - less[m]) / (2.0 * h * studied.found.measures[m].value);
        return result;
    };
    const std::vector<double> wide = slopes(step);
    const std::vector<double> narrow = slopes(0.5 * step);
    for (std::size_t m = 0; m < wide.size(); ++m) {
        const std::string& measure = studied.found.measures[m].name;
        const double exact = studied.slope(measure, name);
        if (std::isnan(exact)) continue;
        CAPTURE(measure);
        const double scale = std::max(std::abs(exact), 0.01);
        CHECK(std::abs((4.0 * narrow[m] - wide[m]) / 3.0 - exact) < 1e-5 * scale);
        // The order shows where the difference is not yet rounding of the solves.
        const double coarse_error = std::abs(wide[m] - exact);
        if (coarse_error > 1e-4 * scale) {
            CHECK(coarse_error / std::abs(narrow[m] - exact) > 3.5);
            CHECK(coarse_error / std::abs(narrow[m] - exact) < 4.5);
        }
    }
}

}  // namespace

TEST_CASE("sensitivity: a bare strip's are those of Timoshenko's bimetal") {
    for (const double thickness : {0.6, 1.0}) {
        CAPTURE(thickness);
        const Studied strip =
            studied_scene(fmt::format("pattern.generator = \"strip\"\nfabric.margin_mm = 0\n"
                                      "plastic.thickness_mm = {}\n",
                                      thickness));
        const auto closed = [&](const std::function<void(Material&, double&, double&, double)>& scale) {
            const auto log_curvature = [&](double factor) {
                Material material = strip.result.scene.material;
                double s = 1.7;
                double plastic = thickness;
                scale(material, s, plastic, factor);
                return std::log(bimetal_curvature(material, s, plastic));
            };
            const double h = 1e-5;
            return (log_curvature(1.0 + h) - log_curvature(1.0 - h)) / (2.0 * h);
        };
        const auto check = [&](const std::string& name,
                               const std::function<void(Material&, double&, double&, double)>& scale) {
            CAPTURE(name);
            // The strip is 1 mm wide: its curvature is within 0.3 % of the narrow one's over a range of
            // thickness and modulus of a factor of 2, which allows for slopes that much apart.
            CHECK(std::abs(strip.slope("mean_curvature", name) - closed(scale)) < 0.02);
        };
        check("material.plastic_youngs_modulus_mpa",
              [](Material& m, double&, double&, double f) { m.plastic_youngs_modulus *= f; });
        check("material.fabric_youngs_modulus_mpa",
              [](Material& m, double&, double&, double f) { m.fabric_youngs_modulus *= f; });
        check("material.fabric_thickness_mm",
              [](Material& m, double&, double&, double f) { m.fabric_thickness *= f; });
        check("fabric.prestretch", [](Material&, double& s, double&, double f) { s *= f; });
        check("plastic.thickness_mm", [](Material&, double&, double& h, double f) { h *= f; });
        CHECK(std::abs(strip.slope("mean_curvature", "material.alpha_1_mpa")) < 1e-9);
    }
}

TEST_CASE("sensitivity: of a strip in fabric, it is what shapes that are solved for again show") {
    const Studied strip = studied_scene(
        "pattern.generator = \"strip\"\npattern.options.length_mm = 12\nfabric.margin_mm = 2\n"
        "mesh.fabric_size_mm = 1\n");
    for (const char* name :
         {"fabric.prestretch", "plastic.thickness_mm", "material.fabric_thickness_mm",
          "material.plastic_youngs_modulus_mpa", "material.fabric_youngs_modulus_mpa", "material.beta_1_mpa",
          "material.laminate_poissons_ratio", "material.fabric_bending_stiffness_n_mm"})
        check_against_solves(strip, name, 0.002);
    check_against_solves(strip, "material.gamma_1", 0.001);
}

TEST_CASE("sensitivity: of a sheet that hangs, it is what shapes that are solved for again show") {
    const Studied sheet = studied_scene(
        "pattern.generator = \"strip\"\npattern.options.length_mm = 12\nfabric.margin_mm = 2\n"
        "mesh.fabric_size_mm = 1\nmodel.fabric_ply = \"same_law\"\n"
        "gravity.acceleration_mm_per_s2 = [0, 0, -9810]\n"
        "[[support]]\nmin_mm = [-10, -10]\nmax_mm = [-7, 10]\n");
    for (const char* name : {"fabric.prestretch.1", "plastic.thickness_mm",
                             "material.plastic_density_kg_per_m3", "material.alpha_2_mpa"})
        check_against_solves(sheet, name, 0.002);
}

TEST_CASE("sensitivity: doubling everything that resists and pulls changes no shape") {
    const Studied strip = studied_scene(
        "pattern.generator = \"strip\"\npattern.options.length_mm = 12\nfabric.margin_mm = 2\n"
        "gravity.acceleration_mm_per_s2 = [0, 0, -9810]\n"
        "[[support]]\nmin_mm = [-10, -10]\nmax_mm = [-7, 10]\n");
    double sum = 0.0;
    double largest = 0.0;
    for (const SensitivityParameter& parameter : strip.found.parameters) {
        if (parameter.unit != "MPa" && parameter.unit != "N mm" && !parameter.unit.starts_with("kg"))
            continue;
        const double slope = strip.slope("mean_curvature", parameter.name);
        sum += slope;
        largest = std::max(largest, std::abs(slope));
    }
    CHECK(largest > 0.1);
    CHECK(std::abs(sum) < 1e-7);
}

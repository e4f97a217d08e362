#include "ruche/study/calibration/printed_fit.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>

#include "ruche/material/cards.hpp"
#include "ruche/output/metrics.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"
#include "ruche/study/calibration/calibration.hpp"
#include "ruche/study/calibration/campaign.hpp"
#include "synthetic_tests.hpp"

using namespace ruche;

namespace {

/// Radius of a bare strip 30 x 1 mm, mm.
double radius(double plastic_mm, double Material::*member, double value) {
    Scene scene = parse_scene(
        fmt::format("pattern.generator = \"strip\"\npattern.options = {{ length_mm = 30, width_mm = 1 }}\n"
                    "fabric = {{ prestretch = 1.7, margin_mm = 0 }}\nplastic.thickness_mm = {}\n",
                    plastic_mm),
        "strip.toml");
    scene.material.*member = value;
    const Result result = simulate(scene);
    return 1.0 / measure_strips(result.layout, result.shape).at(0).curvature;
}

}  // namespace

TEST_CASE(
    "printed samples: the value that bent the strips comes back from their radii, from a start far off") {
    const test::TestFolder folder("printed-fit");
    struct Case {
        const char* name;
        double Material::*member;
        double truth;
    };
    for (const Case& c : {Case{"fabric_thickness", &Material::fabric_thickness, 0.36},
                          Case{"fabric_youngs_modulus", &Material::fabric_youngs_modulus, 0.6},
                          Case{"plastic_youngs_modulus", &Material::plastic_youngs_modulus, 95.0}}) {
        CAPTURE(c.name);
        std::string text = fmt::format(
            "name = \"printed\"\n[printed_fit]\ncard = \"spandex-tpu95a\"\nparameter = \"{}\"\n", c.name);
        for (const double plastic : {0.6, 0.8, 1.0})
            text += fmt::format(
                "[[printed]]\nlength_mm = 30\nwidth_mm = 1\nthickness_mm = {}\nprestretch = 1.7\n"
                "radius_mm = {:.17g}\n",
                plastic, radius(plastic, c.member, c.truth));
        const Calibration result = calibrate(parse_campaign(text, folder.write("printed.toml", text)));
        const ResolvedCard card = resolve_card(result.card, {1.7, 1.7});
        CHECK(card.material.*c.member == doctest::Approx(c.truth).epsilon(1e-4));
        const CardValue& value = result.card.sets.at(0).values.at(c.name);
        REQUIRE(value.interval);
        CHECK(value.interval->at(0) < c.truth);
        CHECK(value.interval->at(1) > c.truth);
    }
}

TEST_CASE("printed samples: what was measured beside them replaces the card's values") {
    const test::TestFolder folder("printed-and-measured");
    const std::string text = fmt::format(
        "[fabric]\nareal_density_kg_per_m2 = 0.15\n[[printed]]\nlength_mm = 30\nwidth_mm = 1\nthickness_mm = "
        "0.6\n"
        "radius_mm = {}\n[[cantilever]]\nangle_deg = 0\nlength_mm = [40, 60]\nx_mm = [30, 28]\ny_mm = [22, "
        "48]\n",
        radius(0.6, &Material::fabric_thickness, 0.46));
    const Calibration result = calibrate(parse_campaign(text, folder.write("printed.toml", text)));
    const auto& values = result.card.sets.at(0).values;
    CHECK(values.at("fabric_areal_density").value == 0.15);
    CHECK(values.at("fabric_bending_stiffness").source.starts_with("measured"));
    CHECK(values.at("alpha_1").source == "paper Table 1");
    CHECK(values.at("fabric_thickness").value == doctest::Approx(0.46).epsilon(1e-3));
}

// Samples in testing machines: tension, shear, cantilever, printed plastic.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference_data.hpp"
#include "ruche/core/error.hpp"
#include "ruche/study/cantilever_sample.hpp"
#include "ruche/study/clamped_sample.hpp"
#include "ruche/study/plastic_sample.hpp"
#include "ruche/study/sheared_sample.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Nominal stress (MPa) of the material point with free transverse and shear strain, blend 0.01.
double material_point(double angle, double stretch) {
    for (const std::vector<double>& row : read_csv("uniaxial_orthotropic.csv"))
        if (row[0] == 1.0 && row[1] == angle && std::abs(row[2] - stretch) < 1e-9) return 1e-6 * row[4];
    FAIL("no such row");
    return 0.0;
}

constexpr double thickness = 0.46;  // mm, of the default material

}  // namespace

TEST_CASE("clamped sample: it pulls as hard as the homogeneous law, up to what its grips hold") {
    const std::vector<double> strains = {0.2, 0.7, 0.4};  // in no order
    for (const double angle : {0.0, 30.0, 90.0}) {
        CAPTURE(angle);
        const ClampedResponse response = simulate_clamped({.angle_deg = angle}, {}, strains);
        REQUIRE(response.converged);
        for (std::size_t i = 0; i < strains.size(); ++i) {
            CAPTURE(strains[i]);
            const double free = material_point(angle, 1.0 + strains[i]) * thickness * 20.0;
            // The theory page has the departures found with another mesh; none is above 1.6 %.
            CHECK(response.force_N[i] == doctest::Approx(free).epsilon(0.016));
            CHECK(response.force_N[i] != doctest::Approx(free).epsilon(1e-4));
        }
    }
}

TEST_CASE("clamped sample: half the element size changes the force by less than 0.05 %") {
    const std::vector<double> strains = {0.7, 0.4, 0.1};
    for (const double angle : {0.0, 45.0}) {
        CAPTURE(angle);
        const ClampedResponse coarse = simulate_clamped({.angle_deg = angle}, {}, strains);
        const ClampedResponse fine =
            simulate_clamped({.angle_deg = angle, .element_size_mm = 1.0}, {}, strains);
        REQUIRE(coarse.converged);
        REQUIRE(fine.converged);
        for (std::size_t i = 0; i < strains.size(); ++i) {
            CAPTURE(strains[i]);
            CHECK(coarse.force_N[i] == doctest::Approx(fine.force_N[i]).epsilon(5e-4));
            CHECK(coarse.mid_width_mm[i] == doctest::Approx(fine.mid_width_mm[i]).epsilon(5e-4));
        }
    }
}

TEST_CASE("clamped sample: without Poisson's effect and logarithms it is a bar") {
    Material bar;
    bar.fabric_poissons_ratio = 0.0;
    bar.beta_1 = bar.beta_2 = 0.0;
    bar.neo_hookean_share = 0.0;
    const std::vector<double> strains = {0.5, 0.0, 0.2};
    const ClampedResponse response = simulate_clamped({.element_size_mm = 5.0}, bar, strains);
    REQUIRE(response.converged);
    for (std::size_t i = 0; i < strains.size(); ++i) {
        const double stretch = 1.0 + strains[i];
        const double force = bar.alpha_1 * stretch * 0.5 * (stretch * stretch - 1.0) * thickness * 20.0;
        CHECK(response.force_N[i] == doctest::Approx(force).epsilon(1e-9));
        CHECK(response.mid_width_mm[i] == doctest::Approx(20.0).epsilon(1e-9));
    }
}

TEST_CASE("clamped sample: a dogbone narrows where it is narrow, and pulls less than a strip of its grips") {
    const std::vector<double> strains = {0.4};
    const ClampedResponse narrow = simulate_clamped({.width_mm = 10.0, .element_size_mm = 1.0}, {}, strains);
    const ClampedResponse wide = simulate_clamped({.width_mm = 20.0, .element_size_mm = 2.0}, {}, strains);
    const ClampedResponse dogbone = simulate_clamped(
        {.width_mm = 10.0, .element_size_mm = 1.0, .grip_width_mm = 20.0, .gauge_length_mm = 60.0}, {},
        strains);
    REQUIRE(dogbone.converged);
    CHECK(dogbone.force_N[0] > narrow.force_N[0]);
    CHECK(dogbone.force_N[0] < wide.force_N[0]);
    CHECK(dogbone.mid_width_mm[0] < 10.0);
}

TEST_CASE("clamped sample: one without size, or a strain of -1, is refused") {
    const std::vector<double> strains = {0.1};
    const std::vector<double> crushed = {-1.0};
    CHECK_THROWS_AS((void)simulate_clamped({.width_mm = 0.0}, {}, strains), InputError);
    CHECK_THROWS_AS((void)simulate_clamped({.grip_width_mm = 5.0}, {}, strains), InputError);
    CHECK_THROWS_AS((void)simulate_clamped({}, {}, crushed), InputError);
}

TEST_CASE("sheared sample: what its free sides give up vanishes with a longer clamp") {
    // A wide sample is sheared homogeneously but for its two ends, which lose a share that goes with one over
    // the width. Small shear, so that the lateral stress is alpha_3 times the shear plus the blend's.
    Material m;
    const double shear = 0.01;
    const std::vector<double> shears = {shear};
    const double blend =
        m.neo_hookean_share * m.fabric_youngs_modulus / (2.0 * (1.0 + m.fabric_poissons_ratio));
    const double modulus = (1.0 - m.neo_hookean_share) * m.alpha_3 + blend;
    const auto lost = [&](double width) {
        const ShearedResponse response =
            simulate_sheared({.length_mm = 20.0, .width_mm = width, .element_size_mm = 1.0}, m, shears);
        REQUIRE(response.converged);
        return 1.0 - response.force_N[0] / (modulus * shear * thickness * width);
    };
    const double square = lost(20.0);
    const double wide = lost(80.0);
    const double wider = lost(160.0);
    MESSAGE("a square answers softer by ", 100.0 * square, " %, one four times as wide by ", 100.0 * wide,
            " %");
    // A Timoshenko beam as long as it is high, its ends kept from turning, bends by V/(E h) and shears by
    // 1.2 V/(G h); with E = 0.065 and G = 0.067 MPa that loses 55 %.
    CHECK(square > 0.4);
    CHECK(square < 0.6);
    CHECK(wider == doctest::Approx(0.5 * wide).epsilon(0.05));
}

TEST_CASE("plastic sample: it follows the law that is linear in Green's strain") {
    const Material m;
    const std::vector<double> strains = {0.0, 0.01, 0.05};
    const PlasticSample sample;
    const PlasticResponse response = simulate_plastic(sample, m, strains);
    REQUIRE(response.converged);
    for (std::size_t i = 0; i < strains.size(); ++i) {
        const double e = strains[i];
        const double stress = m.plastic_youngs_modulus * (e + 1.5 * e * e + 0.5 * e * e * e);
        const double force = stress * sample.width_mm * sample.thickness_mm;
        // Clamps that hold the width stiffen about a width's length of it by at most 1/(1 - nu^2).
        CHECK(response.force_N[i] >= force * (1.0 - 1e-9));
        CHECK(response.force_N[i] <= force * (1.0 + 0.2 * sample.width_mm / sample.length_mm));
    }
}

TEST_CASE("cantilever sample: the fabric's own strip droops as the master curve says") {
    const Material m;
    for (const double length : {30.0, 50.0, 70.0}) {
        CAPTURE(length);
        const CantileverResponse response = simulate_cantilever({.length_mm = length}, m);
        REQUIRE(response.converged);
        const double weight = 9806.65 * 1e-9 * m.fabric_areal_density;  // N/mm^2
        const double gamma = weight * std::pow(length, 3) / m.fabric_bending_stiffness;
        const auto curve = read_csv("cantilever_master_curve.csv");
        const auto above =
            std::find_if(curve.begin(), curve.end(), [&](const auto& row) { return row[0] > gamma; });
        REQUIRE(above != curve.begin());
        REQUIRE(above != curve.end());
        // Between two points of the curve in logarithms, where it is nearly straight.
        const auto below = above - 1;
        const double t = std::log(gamma / (*below)[0]) / std::log((*above)[0] / (*below)[0]);
        const double expected = std::exp((1.0 - t) * std::log((*below)[3]) + t * std::log((*above)[3]));
        // It also stretches under its own weight, by 0.2 % at 70 mm.
        CHECK(response.y_mm / response.x_mm == doctest::Approx(expected).epsilon(0.015));
    }
}

#include "ruche/material/rod_section.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace ruche;

TEST_CASE("rod section: the torsion constant is that of Timoshenko and Goodier's table") {
    // Sec. 109: J / (a b^3) for a/b; three digits are printed.
    const double table[][2] = {{1.0, 0.1406}, {1.5, 0.196}, {2.0, 0.229},
                               {3.0, 0.263},  {5.0, 0.291}, {10.0, 0.312}};
    for (const auto& [ratio, factor] : table) {
        CAPTURE(ratio);
        CHECK(torsion_constant(ratio * 0.5, 0.5) ==
              doctest::Approx(factor * ratio * std::pow(0.5, 4)).epsilon(3e-3));
        CHECK(torsion_constant(0.5, ratio * 0.5) == torsion_constant(ratio * 0.5, 0.5));
    }
    // Thin: b^3 a / 3 (1 - 0.630 b / a).
    CHECK(torsion_constant(100.0, 1.0) == doctest::Approx(100.0 / 3.0 * (1.0 - 0.0063025)).epsilon(1e-6));
}

TEST_CASE("rod section: stiffness belongs to the axes of the section") {
    const RodSection section{.width = 2.0, .thickness = 0.5, .youngs_modulus = 60.0, .poissons_ratio = 0.5};
    CHECK(stretching_stiffness(section) == doctest::Approx(60.0));
    const Vec3 stiffness = turning_stiffness(section);
    CHECK(stiffness[0] == doctest::Approx(20.0 * torsion_constant(2.0, 0.5)));
    CHECK(stiffness[1] == doctest::Approx(60.0 * 2.0 * 0.125 / 12.0));
    CHECK(stiffness[2] == doctest::Approx(60.0 * 0.5 * 8.0 / 12.0));
}

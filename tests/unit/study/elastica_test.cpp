#include "ruche/study/calibration/elastica.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "reference_data.hpp"

using namespace ruche;
using namespace ruche::test;

TEST_CASE("elastica: follows the independent master curve to its nine digits") {
    const auto rows = read_csv("cantilever_master_curve.csv");
    REQUIRE(rows.size() == 31);
    for (const std::vector<double>& row : rows) {
        CAPTURE(row[0]);
        const Cantilever c = cantilever(row[0]);
        CHECK(c.load == doctest::Approx(row[0]).epsilon(1e-12));
        CHECK(std::abs(c.reach - row[1]) < 1e-9);
        CHECK(std::abs(c.drop - row[2]) < 1e-9);
        CHECK(std::abs(c.drop / c.reach - row[3]) < 1e-9 * (1.0 + row[3]));
        CHECK(std::abs(c.tip_angle * 180.0 / std::numbers::pi - row[4]) < 1e-8);
    }
}

TEST_CASE("elastica: the load that a chord angle belongs to is the tabulated one") {
    for (const std::vector<double>& row : read_csv("cantilever_inverse.csv")) {
        CAPTURE(row[0]);
        // Eight digits are printed.
        CHECK(cantilever_of_chord(std::atan(row[0])).load == doctest::Approx(row[1]).epsilon(1e-7));
    }
}

TEST_CASE("elastica: light strips bend as beams, y = Gamma / 8, with an error of order Gamma^2") {
    // Bernoulli's beam under its own weight: y/L = Gamma/8, tip angle Gamma/6.
    for (const double load : {1e-4, 1e-3, 1e-2}) {
        const Cantilever c = cantilever(load);
        CHECK(std::abs(c.drop / (load / 8.0) - 1.0) < load * load);
        CHECK(std::abs(c.tip_angle / (load / 6.0) - 1.0) < load * load);
    }
}

TEST_CASE("elastica: Peirce's cantilever formula holds near his working angle of 43 degrees") {
    // Peirce 1930: the bending length c = (k_B/w)^(1/3) is L (cos(theta/2) / (8 tan theta))^(1/3) for a chord
    // at theta below the horizontal, an empirical formula good to about one per cent up to 60 degrees.
    for (const double degrees : {20.0, 30.0, 41.5, 43.0, 50.0}) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const double peirce = std::cbrt(std::cos(0.5 * angle) / (8.0 * std::tan(angle)));
        CHECK(std::cbrt(1.0 / cantilever_of_chord(angle).load) == doctest::Approx(peirce).epsilon(0.01));
    }
}

TEST_CASE("elastica: heavy strips hang down, and the clamp bends as much as it takes") {
    // For a strip that ends up vertical, energy is conserved only at the clamp's scale (k_B/w L)^(1/2): there
    // y -> L - O(Gamma^-1/2).
    const Cantilever c = cantilever(5e3);
    CHECK(c.drop > 0.98);
    CHECK(c.reach < 0.03);
    CHECK(std::abs(c.tip_angle - 0.5 * std::numbers::pi) < 1e-9);
}

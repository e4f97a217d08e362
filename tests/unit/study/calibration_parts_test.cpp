// Cycles, slack, shear, bending, moduli, statistics: the steps of a calibration one by one.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "ruche/study/calibration/bending_fit.hpp"
#include "ruche/study/calibration/cycles.hpp"
#include "ruche/study/calibration/elastica.hpp"
#include "ruche/study/calibration/grip_correction.hpp"
#include "ruche/study/calibration/moduli.hpp"
#include "ruche/study/calibration/shear_fit.hpp"
#include "ruche/study/calibration/statistics.hpp"
#include "synthetic_tests.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Triangles up and down, with noise on the displacement and a pause at the end.
TestRecord triangles(int cycles, double noise) {
    TestRecord record{.file = "test.csv"};
    for (int i = 0; i <= 200 * cycles; ++i) {
        const double phase = std::fmod(i / 200.0, 1.0);
        const double d = 50.0 * (phase <= 0.5 ? 2.0 * phase : 2.0 - 2.0 * phase);
        record.displacement.push_back(d + noise * std::sin(12.9898 * i));
        record.force.push_back(0.1 * d);
        record.line.push_back(i + 2);
    }
    return record;
}

}  // namespace

TEST_CASE("cycles: triangles are counted, with noise on the displacement too") {
    for (const double noise : {0.0, 1.0}) {
        const TestRecord record = triangles(3, noise);
        const std::vector<Cycle> cycles = find_cycles(record);
        REQUIRE(cycles.size() == 3);
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(cycles[i].unloads);
            CHECK(std::abs(static_cast<double>(cycles[i].peak) - (200.0 * static_cast<double>(i) + 100.0)) <=
                  3.0 * noise);
        }
        CHECK(cycles[2].end == record.size());
    }
}

TEST_CASE("cycles: a hold at the top belongs to the loading, one at the bottom to the loading that follows") {
    TestRecord record;
    for (const double d : {0, 5, 10, 10, 10, 5, 0, 0, 0, 5, 10, 5, 0}) record.displacement.push_back(d);
    record.force = record.displacement;
    const std::vector<Cycle> cycles = find_cycles(record);
    REQUIRE(cycles.size() == 2);
    CHECK(cycles[0].peak == 4);
    CHECK(cycles[0].end == 7);
    CHECK(cycles[1].begin == 6);
    CHECK(cycles[1].peak == 10);
    CHECK(cycles[1].rows(Branch::loading).size() == 5);
    CHECK(cycles[1].rows(Branch::unloading).begin == 11);
}

TEST_CASE("cycles: a test that only loads has none that unloads") {
    TestRecord record = triangles(1, 0.0);
    record.displacement.resize(101);
    record.force.resize(101);
    const std::vector<Cycle> cycles = find_cycles(record);
    REQUIRE(cycles.size() == 1);
    CHECK_FALSE(cycles[0].unloads);
}

TEST_CASE("slack: is where the force begins, and none where it begins at once") {
    TestRecord record = triangles(1, 0.0);
    CHECK(slack_of(record, find_cycles(record).front()) == 0.0);
    for (double& f : record.force) f = std::max(0.0, f - 1.0);  // pulls from 10 mm on
    CHECK(slack_of(record, find_cycles(record).front()) == doctest::Approx(10.0).epsilon(0.05));
}

TEST_CASE("slack: a soft beginning in noise is none, at any angle and seed, and 5 mm are found in it") {
    for (const double noise : {0.0, 0.003, 0.01}) {
        for (const double angle : {0.0, 45.0, 90.0}) {
            CAPTURE(noise);
            CAPTURE(angle);
            int found_again = 0;
            for (std::uint64_t seed = 1; seed <= 10; ++seed) {
                LawCurve curve = exact_curve(Material{}, angle, 1.7, 300);
                std::reverse(curve.stretch.begin(), curve.stretch.end());
                std::reverse(curve.nominal_stress.begin(), curve.nominal_stress.end());
                add_noise(curve, noise, seed);
                TestRecord record{.file = "test.csv"};
                for (const double slack : {0.0, 5.0}) {
                    record = TestRecord{.file = "test.csv"};
                    LawCurve flat = exact_curve(Material{}, angle, 1.7, 300);
                    for (auto& p : flat.nominal_stress) p = 0.0;
                    flat.nominal_stress.front() = curve.nominal_stress.back();
                    add_noise(flat, noise, 100 + seed);
                    for (int i = 0; i < 20 && slack > 0.0; ++i) {
                        record.displacement.push_back(slack * i / 20.0);
                        record.force.push_back(flat.nominal_stress[static_cast<std::size_t>(i) + 1]);
                    }
                    for (std::size_t i = 0; i < curve.stretch.size(); ++i) {
                        record.displacement.push_back(slack + 110.0 * (curve.stretch[i] - 1.0));
                        record.force.push_back(curve.nominal_stress[i]);
                    }
                    const double found = slack_of(record, {0, record.size() - 1, record.size(), false});
                    // What is below 2 % of the length is not taken off.
                    if (slack == 0.0) CHECK(found < 0.02 * 110.0);
                    if (slack > 0.0) found_again += found == doctest::Approx(slack).epsilon(0.4) ? 1 : 0;
                }
            }
            // Where the law begins softly, noise hides it; a test of significance misses some elsewhere.
            if (noise == 0.0) CHECK(found_again == 10);
            if (noise == 0.003 && angle > 0.0) CHECK(found_again >= 9);
        }
    }
}

TEST_CASE("sudden falls: a slip of the grip is found, a smooth test has none") {
    TestRecord record = triangles(1, 0.0);
    CHECK(sudden_falls(record, find_cycles(record).front()).empty());
    for (std::size_t i = 60; i <= 100; ++i) record.force[i] -= 1.0;
    const auto falls = sudden_falls(record, find_cycles(record).front());
    REQUIRE_FALSE(falls.empty());
    CHECK(falls.front() == 60);
}

TEST_CASE("bending fit: cantilevers of one stiffness give it back, and those of two their mean") {
    const double density = 0.2;
    const double weight = density * 9.80665e-6;
    const auto test_of = [&](double angle, double stiffness) {
        CantileverTest test{.angle_deg = angle};
        for (const double length : {20.0, 30.0, 40.0, 50.0}) {
            const Cantilever c = cantilever(weight * std::pow(length, 3.0) / stiffness);
            test.length_mm.push_back(length);
            test.x_mm.push_back(length * c.reach);
            test.y_mm.push_back(length * c.drop);
        }
        return test;
    };
    const std::vector<CantileverTest> one = {test_of(0, 9.57e-3)};
    CHECK(fit_bending(one, density).stiffness == doctest::Approx(9.57e-3).epsilon(1e-6));
    const std::vector<CantileverTest> two = {test_of(0, 9.57e-3), test_of(90, 2e-2)};
    const BendingFit fit = fit_bending(two, density);
    CHECK(fit.stiffness == doctest::Approx(0.5 * (9.57e-3 + 2e-2)).epsilon(1e-6));
    CHECK(fit.smallest == doctest::Approx(9.57e-3).epsilon(1e-6));
    CHECK(fit.has_interval);
    CHECK(fit.high - fit.low < 1e-5 * fit.stiffness);  // exact data
}

TEST_CASE("shear: the slope of a straight response, and of the straight part of a bent one") {
    const TestFolder folder("shear-test");
    for (const double cubic : {0.0, 0.5}) {
        std::string csv = "Extension (mm),Load (N)\n";
        for (int i = 0; i <= 200; ++i) {
            const double g = 0.5 * (i <= 100 ? i : 200 - i) / 100.0;
            csv += fmt::format("{},{}\n", 50.0 * g, 50.0 * 0.5 * (0.06 * g + cubic * g * g * g));
        }
        const ShearCurve curve =
            read_shear_curve({{.file = folder.write("s.csv", csv)}, 0.0, 50.0, 50.0}, 0.5);
        CHECK(curve.range == doctest::Approx(cubic == 0.0 ? 0.5 : 0.1).epsilon(0.6));
        CHECK(curve.slope == doctest::Approx(0.06).epsilon(cubic == 0.0 ? 1e-9 : 0.15));
    }
}

TEST_CASE("strip curvature: is the bimetal formula's for the paper's material") {
    // Worked out independently (Timoshenko's formula with true thicknesses) for Table 1, s = 1.7.
    CHECK(strip_curvature(Material{}, 1.7, 0.6) == doctest::Approx(0.152362385).epsilon(1e-8));
    CHECK(strip_curvature(Material{}, 1.7, 1.0) == doctest::Approx(0.051255722).epsilon(1e-8));
}

TEST_CASE("fabric modulus: Table 1's E_f is nine times the one that matches its own law") {
    std::vector<LawCurve> curves;
    for (const double angle : seven_angles) curves.push_back(exact_curve(Material{}, angle));
    const FabricModulus modulus = fabric_modulus(curves, Material{}, 1.7);
    CHECK(Material{}.fabric_youngs_modulus / modulus.working == doctest::Approx(9.0).epsilon(0.08));
    CHECK(modulus.secant > 0.1);
    CHECK(modulus.secant < 0.3);
}

TEST_CASE("statistics: line, noise and resemblance of neighbours") {
    std::vector<double> x, y, slow, white;
    for (int i = 0; i < 400; ++i) {
        x.push_back(i);
        y.push_back(3.0 + 2.0 * i);
        slow.push_back(std::sin(0.02 * i));
        const double pseudo = std::sin(12.9898 * i * i) * 43758.5453;
        white.push_back(pseudo - std::floor(pseudo) - 0.5);
    }
    const Line line = fit_line(x, y);
    CHECK(line.slope == doctest::Approx(2.0).epsilon(1e-12));
    CHECK(line.intercept == doctest::Approx(3.0).epsilon(1e-9));
    CHECK(correlation_length(std::array{slow}) > 20.0);
    CHECK(correlation_length(std::array{white}) < 1.5);
    CHECK(noise_variance(white).value == doctest::Approx(1.0 / 12.0).epsilon(0.15));
    CHECK(noise_variance(slow).value < 1e-3);
    CHECK(student_t(0.95, 10) == doctest::Approx(2.228138852).epsilon(1e-8));
}

TEST_CASE("statistics: the noise of neighbours is known as well as its freedom says") {
    // Mean and variance of the estimate over many short series of white noise of variance 1.
    std::mt19937_64 generator(3);
    std::normal_distribution<double> normal;
    std::vector<double> found;
    double freedom = 0.0;
    for (int k = 0; k < 4000; ++k) {
        std::vector<double> white(8);
        for (double& v : white) v = normal(generator);
        const Variance variance = noise_variance(white);
        found.push_back(variance.value);
        freedom = variance.freedom;
    }
    const Spread s = spread(found);
    // Standard errors of 4000 values: 0.9 % of the mean, and some 4 % of the variance 2/freedom.
    CHECK(s.mean == doctest::Approx(1.0).epsilon(0.03));
    CHECK(s.deviation * s.deviation == doctest::Approx(2.0 / freedom).epsilon(0.15));
}

TEST_CASE("moderated variances: what chance explains becomes one, what it does not stays apart") {
    const std::vector<Variance> few = {{0.7, 5.0}, {1.6, 5.0}, {1.1, 5.0}, {0.5, 5.0}};
    for (const double v : moderated(few)) CHECK(v == doctest::Approx(0.975).epsilon(1e-12));
    // Variances that are known well, and a hundredfold apart, move by less than a per cent.
    const std::vector<Variance> apart = {{0.1, 400.0}, {10.0, 400.0}, {1.0, 400.0}};
    const std::vector<double> kept = moderated(apart);
    for (std::size_t i = 0; i < apart.size(); ++i)
        CHECK(kept[i] == doctest::Approx(apart[i].value).epsilon(0.01));
    // Between: towards the middle, in the same order.
    const std::vector<double> drawn = moderated(std::vector<Variance>{{0.1, 5.0}, {10.0, 5.0}, {1.0, 5.0}});
    CHECK(drawn[0] > 0.1);
    CHECK(drawn[1] < 10.0);
    CHECK(drawn[0] < drawn[2]);
    CHECK(drawn[2] < drawn[1]);
    CHECK(moderated(std::vector<Variance>{{0.0, 5.0}, {2.0, 5.0}}) == std::vector<double>{0.0, 2.0});
    CHECK(moderated(std::vector<Variance>{{3.0, 5.0}}) == std::vector<double>{3.0});
}

TEST_CASE("interpolation: reproduces a polynomial through its nodes") {
    const std::vector<double> nodes = {1.0, 1.2, 1.5, 1.7};
    std::vector<double> values;
    for (const double x : nodes) values.push_back(x * x * x - 2.0 * x);
    CHECK(interpolate(nodes, values, 1.33) == doctest::Approx(1.33 * 1.33 * 1.33 - 2.66).epsilon(1e-13));
    CHECK(interpolate(nodes, values, 1.5) == values[2]);
}

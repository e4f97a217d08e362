#include "ruche/study/calibration/repeated_cycles.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ruche/study/calibration/law_fit.hpp"
#include "ruche/study/calibration/tension_curve.hpp"
#include "synthetic_tests.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr int rows_of_branch = 120;

/// What makes a cycle another one.
struct Settling {
    double force = 1.0;  ///< factor
    double width = 1.0;
};

/// Cycles of a test at 0 degrees: loading a tenth stiffer; noise as a share of the largest force and of the
/// width.
TestRecord cycles_of(const std::vector<Settling>& settling, double noise, unsigned seed) {
    const LawCurve curve = exact_curve(Material{}, 0.0, 1.7, rows_of_branch);
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    TestRecord record{.file = "test.csv"};
    const auto read = [&](std::size_t i, double factor, const Settling& cycle) {
        record.line.push_back(static_cast<int>(record.size()) + 1);
        record.displacement.push_back(110.0 * (curve.stretch[i] - 1.0));
        record.force.push_back(10.0 * (factor * cycle.force * curve.nominal_stress[i] +
                                       noise * curve.nominal_stress.front() * normal(generator)));
        record.width.push_back(20.0 *
                               (cycle.width * stretch_of(curve.transverse[i]) + noise * normal(generator)));
    };
    for (const Settling& cycle : settling) {
        for (std::size_t i = curve.stretch.size(); i-- > 0;) read(i, 1.1, cycle);
        for (std::size_t i = 1; i < curve.stretch.size(); ++i) read(i, 1.0, cycle);
    }
    return record;
}

std::vector<std::size_t> repeated(const TestRecord& record) {
    const std::vector<Cycle> cycles = find_cycles(record);
    return repeated_cycles(record, cycles, cycles.size() - 1, Branch::unloading);
}

using Used = std::vector<std::size_t>;

}  // namespace

TEST_CASE("repeated cycles: those that only noise tells apart are used together, at nearly all seeds") {
    int all = 0;
    for (unsigned seed = 1; seed <= 40; ++seed)
        all += repeated(cycles_of(std::vector<Settling>(4), 0.01, seed)).size() == 4 ? 1 : 0;
    // Six tests at 99 % each: 37.7 of 40 expected, fewer than 33 in one of 100 cases.
    CHECK(all >= 33);
    CHECK(repeated(cycles_of(std::vector<Settling>(3), 0.0, 1)) == Used{0, 1, 2});
}

TEST_CASE("repeated cycles: a cycle before the fabric has settled is left out, and all before it") {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        CHECK(repeated(cycles_of({{1.2}, {1.03}, {1.0}, {1.0}}, 0.005, seed)).front() >= 2);
        CHECK(repeated(cycles_of({{1.0}, {1.1}, {1.0}}, 0.01, seed)) == Used{2});
        // The same force at another width is another fabric.
        CHECK(repeated(cycles_of({{1.0, 1.03}, {1.0, 1.0}}, 0.01, seed)) == Used{1});
    }
}

TEST_CASE("repeated cycles: what noise hides changes the mean by no more than noise does") {
    // A cycle that is off by a share of the force, and how often it is taken for the same.
    const auto taken = [](double off) {
        int count = 0;
        for (unsigned seed = 1; seed <= 20; ++seed)
            count += repeated(cycles_of({{1.0 + off}, {1.0}}, 0.01, seed)).size() == 2 ? 1 : 0;
        return count;
    };
    // The noise of 1 % averages to 0.13 % of the largest force over both branches.
    CHECK(taken(0.001) >= 17);
    CHECK(taken(0.04) == 0);
}

TEST_CASE("repeated cycles: masses that were hung are compared by the lengths that were read under them") {
    const LawCurve curve = exact_curve(Material{}, 0.0, 1.65, 30);
    const auto record_of = [&](double longer) {
        std::mt19937_64 generator(5);
        std::normal_distribution<double> normal;
        TestRecord record{.file = "hung.csv", .driven_by_force = true};
        for (const double more : {longer, 0.0}) {
            for (const Branch branch : {Branch::loading, Branch::unloading}) {
                for (std::size_t k = 0; k < curve.stretch.size(); ++k) {
                    const std::size_t i = branch == Branch::loading ? curve.stretch.size() - 1 - k : k;
                    record.line.push_back(static_cast<int>(record.size()) + 1);
                    record.force.push_back(curve.nominal_stress[i]);
                    record.displacement.push_back(110.0 * (curve.stretch[i] - 1.0) + more +
                                                  0.5 * normal(generator));
                    record.branch.push_back(branch);
                }
            }
        }
        return record;
    };
    CHECK(repeated(record_of(0.0)).size() == 2);
    CHECK(repeated(record_of(4.0)).size() == 1);
}

TEST_CASE(
    "repeated cycles: all rows are one curve, the largest stretch first, unless one cycle is asked for") {
    const TestFolder folder("repeated-cycles");
    const TestRecord record = cycles_of(std::vector<Settling>(3), 0.01, 2);
    std::string csv = "Extension (mm),Load (N),Width (mm)\n";
    for (std::size_t i = 0; i < record.size(); ++i)
        csv += fmt::format("{},{},{}\n", record.displacement[i], record.force[i], record.width[i]);
    TensionTest test{{.file = folder.write("test.csv", csv)}};
    test.length_mm = 110.0;
    test.width_mm = 20.0;
    test.prestretch = 1.7;
    const TensionCurve all = read_tension_curve(test, 0.46);
    CHECK(all.used == Used{0, 1, 2});
    CHECK(all.used_cycles() == "cycles 1 to 3");
    CHECK(all.stretch.size() == 3 * (rows_of_branch - 1));
    CHECK(std::is_sorted(all.stretch.rbegin(), all.stretch.rend()));
    test.cycle = 2;
    const TensionCurve second = read_tension_curve(test, 0.46);
    CHECK(second.used == Used{1});
    CHECK(second.used_cycles() == "cycle 2");
    CHECK(second.stretch.size() == rows_of_branch - 1);
}

TEST_CASE("repeated cycles: of more rows than a fit needs, neighbours are averaged") {
    const TestFolder folder("repeated-cycles-many");
    const LawCurve curve = exact_curve(Material{}, 0.0, 1.7, 6000);
    TensionTest test{{.file = folder.write("test.csv", machine_csv(curve, Material{}))}};
    test.length_mm = 110.0;
    test.width_mm = 20.0;
    test.prestretch = 1.7;
    const TensionCurve thinned = read_tension_curve(test, Material{}.fabric_thickness);
    CHECK(thinned.stretch.size() <= 1500);
    CHECK(thinned.stretch.size() > 1000);
    const LawPrediction law =
        predict(Material{}, {.stretch = thinned.stretch, .nominal_stress = thinned.nominal_stress});
    // The mean of a bent curve lies off it by its second difference over 24: 1e-5 where it is steepest.
    for (std::size_t i = 0; i < thinned.stretch.size(); ++i)
        CHECK(std::abs(thinned.nominal_stress[i] - law.nominal_stress[i]) < 2e-5 * law.nominal_stress[0]);
}

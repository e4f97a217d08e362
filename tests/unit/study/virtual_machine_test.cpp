#include "ruche/study/virtual_test/virtual_machine.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/study/virtual_test/hung_weights.hpp"
#include "ruche/study/virtual_test/virtual_campaign.hpp"

using namespace ruche;

namespace {

/// Force 3 d - 0.01 d^2 over displacements up to 50 mm: a curve that an interpolant of order 3 has exactly.
VirtualCurve parabola(const char* test) {
    VirtualCurve curve{.test = test};
    for (int i = 0; i <= 20; ++i) {
        const double d = 50.0 * i / 20.0;
        curve.displacement.push_back(d);
        curve.force.push_back(3.0 * d - 0.01 * d * d);
        if (curve.test == "tension") curve.width.push_back(20.0 - 0.1 * d);
    }
    return curve;
}

double force_of(double d) { return 3.0 * d - 0.01 * d * d; }

MachineRecord recorded(const VirtualCurve& curve, const VirtualMachine& machine) {
    NoiseSource noise(7);
    return record(curve, machine, noise);
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
}

}  // namespace

TEST_CASE("virtual machine: without noise and hysteresis it records the curve, to and fro") {
    // 50 mm at 60 mm/min and 5 Hz: 50 s and 250 readings per stroke.
    const VirtualMachine machine{
        .cycles = 2, .speed = 60.0, .sampling = 5.0, .noise = 0.0, .hysteresis = 0.0};
    const MachineRecord r = recorded(parabola("tension"), machine);
    REQUIRE(r.time.size() == 1001);
    CHECK(r.time.back() == doctest::Approx(200.0));
    CHECK(r.displacement[250] == doctest::Approx(50.0));
    CHECK(r.displacement[500] == doctest::Approx(0.0));
    CHECK(r.displacement[375] == doctest::Approx(25.0));
    for (std::size_t i = 0; i < r.time.size(); ++i) {
        CHECK(r.force[i] == doctest::Approx(force_of(r.displacement[i])).epsilon(1e-12));
        CHECK(r.width[i] == doctest::Approx(20.0 - 0.1 * r.displacement[i]).epsilon(1e-12));
    }
}

TEST_CASE("virtual machine: fabric unloads along the curve and loads above it, less so in later cycles") {
    const VirtualMachine machine{.cycles = 3, .speed = 60.0, .noise = 0.0, .hysteresis = 0.1};
    const MachineRecord r = recorded(parabola("tension"), machine);
    const double full = force_of(50.0);
    for (int cycle = 0; cycle < 3; ++cycle) {
        CAPTURE(cycle);
        const std::size_t loading = 500 * cycle + 125;  // half way up
        const std::size_t unloading = 500 * cycle + 375;
        CHECK(r.force[unloading] == doctest::Approx(force_of(25.0)).epsilon(1e-12));
        const double gap = 0.1 * full * (1.0 + std::pow(0.5, cycle));
        CHECK(r.force[loading] - r.force[unloading] == doctest::Approx(gap).epsilon(1e-12));
    }
}

TEST_CASE("virtual machine: plastic is pulled once, loads along the curve and unloads below it") {
    const VirtualMachine machine{.cycles = 3, .plastic_speed = 60.0, .noise = 0.0, .hysteresis = 0.1};
    const MachineRecord r = recorded(parabola("plastic"), machine);
    REQUIRE(r.time.size() == 501);
    CHECK(r.width.empty());
    CHECK(r.force[125] == doctest::Approx(force_of(25.0)).epsilon(1e-12));
    CHECK(r.force[375] == doctest::Approx(force_of(25.0) - 0.1 * force_of(50.0)).epsilon(1e-12));
}

TEST_CASE("virtual machine: noise has the stated spread about the curve") {
    const VirtualMachine machine{.cycles = 20, .speed = 60.0, .noise = 0.01, .hysteresis = 0.0};
    const MachineRecord r = recorded(parabola("tension"), machine);
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < r.time.size(); ++i) {
        const double off = (r.force[i] - force_of(r.displacement[i])) / force_of(50.0);
        sum += off;
        squares += off * off;
    }
    const auto n =
        static_cast<double>(r.time.size());  // 10001: the mean spreads by 1e-4, the spread by 0.7 %
    CHECK(std::abs(sum / n) < 4e-4);
    CHECK(std::sqrt(squares / n) == doctest::Approx(0.01).epsilon(0.03));
}

TEST_CASE("virtual machine: each kind of file has its own separators, quotes, units and encoding") {
    const MachineRecord r{
        .time = {0.0, 0.2}, .displacement = {0.0, 1.5}, .force = {0.0, -0.25}, .width = {20.0, 19.5}};
    CHECK(machine_csv(r, "a", MachineFormat::plain) ==
          "time_s,displacement_mm,force_N,width_mm\n0.000,0.00000,0.000000,20.0000\n"
          "0.200,1.50000,-0.250000,19.5000\n");
    const std::string bluehill = machine_csv(r, "a", MachineFormat::bluehill);
    CHECK(
        bluehill.find("\"Time\",\"Extension\",\"Load\",\"Width\"\r\n\"(s)\",\"(mm)\",\"(N)\",\"(mm)\"\r\n") !=
        std::string::npos);
    CHECK(bluehill.ends_with("\"0.200\",\"1.50000\",\"-0.250000\",\"19.5000\"\r\n"));
    const std::string zwick = machine_csv(r, "a", MachineFormat::zwick);
    CHECK(zwick.find("Pr\xfc"
                     "fzeit") != std::string::npos);
    CHECK(zwick.ends_with("0,200;1,50000;-0,250000;19,5000\r\n"));
}

TEST_CASE("virtual machine: hung weights are a table of lengths, longer on the way back") {
    const VirtualMachine machine{.noise = 0.0, .hysteresis = 0.1};
    NoiseSource noise(7);
    const std::string csv = hung_weights_csv(parabola("tension"), 110.0, machine, noise);
    CHECK(count(csv, ",loading\n") == 9);
    CHECK(count(csv, ",unloading\n") == 8);
    CHECK(csv.starts_with("mass_g,length_mm,width_mm,branch\n0.00,110.00,20.00,loading\n"));
    CHECK(csv.ends_with("0.00,110.00,20.00,unloading\n"));
    // Half of the largest force, 62.5 N: on the way back where 3 d - 0.01 d^2 = 62.5, at d = 22.5.
    const double d = 150.0 - std::sqrt(150.0 * 150.0 - 6250.0);
    const std::string half =
        fmt::format("{:.2f},{:.2f},{:.2f},unloading\n", 62.5 / 9.80665e-3, 110.0 + d, 20.0 - 0.1 * d);
    CHECK(count(csv, half) == 1);
    // 8/8 of it are carried at the end of both ways.
    CHECK(count(csv, fmt::format("{:.2f},160.00,15.00,loading\n", 125.0 / 9.80665e-3)) == 1);
}

TEST_CASE("virtual campaign: the seed decides the files, and names every record") {
    VirtualCurves curves;
    curves.curves = {parabola("tension"), parabola("tension"), parabola("shear"), parabola("plastic")};
    curves.curves[1].angle = 90.0;
    curves.droops = {{0.0, 50.0, 40.0, 20.0}, {0.0, 60.0, 42.0, 33.0}, {90.0, 50.0, 40.0, 20.0}};
    VirtualMachine machine;
    const auto files = virtual_campaign(curves, machine, "a card");
    const auto again = virtual_campaign(curves, machine, "a card");
    machine.seed = 2;
    const auto other = virtual_campaign(curves, machine, "a card");
    REQUIRE(files.size() == 5);
    for (std::size_t i = 0; i < files.size(); ++i) {
        CHECK(files[i].contents == again[i].contents);
        CHECK(files[i].contents != other[i].contents);
    }
    // Two equal samples have noise of their own.
    CHECK(files[0].contents != files[1].contents);
    const std::string& campaign = files.back().contents;
    CHECK(files.back().name == "campaign.toml");
    for (std::size_t i = 0; i + 1 < files.size(); ++i)
        CHECK(count(campaign, "file = \"" + files[i].name + "\"") == 1);
    CHECK(count(campaign, "[[cantilever]]") == 4);  // two angles, two sides
    CHECK(count(campaign, "length_mm = [50, 60]") == 2);
}

TEST_CASE("virtual curves: they come back from their file to the last bit, and only for the same samples") {
    VirtualCurves curves;
    curves.curves = {parabola("tension")};
    curves.curves[0].force[3] = 1.0 / 3.0;
    curves.droops = {{0.0, 50.0, 40.1, 20.0}};
    const std::string json = to_json(curves);
    const auto read = same_curves(json, curves.samples, curves.material);
    REQUIRE(read);
    CHECK(to_json(*read) == json);
    CHECK(read->curves[0].force[3] == 1.0 / 3.0);
    VirtualSamples longer = curves.samples;
    longer.length += 1.0;
    CHECK(!same_curves(json, longer, curves.material));
    Material stiffer = curves.material;
    stiffer.alpha_2 *= 1.0 + 1e-15;
    CHECK(!same_curves(json, curves.samples, stiffer));
    CHECK(!same_curves("{}", curves.samples, curves.material));
    CHECK(!same_curves("not JSON", curves.samples, curves.material));
}

TEST_CASE("virtual samples: lists of numbers and of tests are read, mistakes are named") {
    CHECK(numbers_of("0, 22.5 ,90", "angles_deg", -360, 360) == std::vector<double>{0.0, 22.5, 90.0});
    for (const char* wrong : {"", "0,,90", "0 90", "0; 90", "400", "nan", "0,5 deg"}) {
        CAPTURE(wrong);
        CHECK_THROWS_AS((void)numbers_of(wrong, "angles_deg", -360, 360), InputError);
    }
    CHECK(includes({.tests = "shear, tension"}, "tension"));
    CHECK(!includes({.tests = "shear"}, "tension"));
    CHECK_THROWS_AS((void)includes({.tests = "sheer"}, "tension"), InputError);
}

#include "ruche/study/validation/validation.hpp"
#include "ruche/study/validation/validation_run.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "ruche/core/error.hpp"
#include "ruche/meshing/structured.hpp"
#include "ruche/study/validation/choice_table.hpp"
#include "ruche/study/validation/sheet_measures.hpp"

using namespace ruche;

namespace {

/// A value with +-0.1: two meshes, the coarser of which is 0.08 lower.
Estimate about(double value) { return estimate(std::vector<double>{value - 0.08, value}, 2.0); }

/// An experiment whose series are given: variants "a" and "b", metric "m", with +-0.1 on each value.
ExperimentOutcome measured(const std::vector<double>& a, const std::vector<double>& b) {
    ExperimentOutcome outcome;
    outcome.experiment.variants = {{.name = "a"}, {.name = "b"}};
    outcome.experiment.metrics = {{.name = "m"}};
    for (const auto& [name, values] : {std::pair("a", a), std::pair("b", b)}) {
        ValueSeries series{.variant = name, .metric = "m"};
        for (const double v : values) {
            series.x.push_back(static_cast<double>(series.x.size()));
            series.y.push_back(about(v));
        }
        outcome.series.push_back(series);
    }
    return outcome;
}

Verdict verdict_of(ExperimentOutcome outcome, const CheckSpec& check) {
    outcome.experiment.checks = {check};
    return judge(outcome).at(0).verdict;
}

bool holds(const ExperimentOutcome& outcome, const CheckSpec& check) {
    return verdict_of(outcome, check) == Verdict::holds;
}

/// A rectangle as a sheet without print, and a shape that `place` gives its vertices.
PrintMesh sheet(double length, double width, int across) {
    PrintMesh layout;
    layout.mesh = rectangle_mesh(MeshKind::alternating, {.length = length, .width = width, .across = across});
    layout.print.resize(layout.mesh.triangles.size());
    layout.strip.resize(layout.mesh.triangles.size());
    return layout;
}

template <class Place>
std::vector<Vec3> placed(const PrintMesh& layout, const Place& place) {
    std::vector<Vec3> shape;
    for (const Vec2& p : layout.mesh.vertices) shape.push_back(place(p));
    return shape;
}

/// A layout rolled around an axis along y, below x = `top`: the back is concave.
std::vector<Vec3> rolled_about(const PrintMesh& layout, double top, double radius) {
    return placed(layout, [&](const Vec2& p) {
        const double angle = (p.x() - top) / radius;
        return Vec3(radius * std::sin(angle), p.y(), radius * std::cos(angle));
    });
}

/// A folder with an experiment that goes away with the test.
class ExperimentFolder {
  public:
    explicit ExperimentFolder(const std::string& text) {
        path_ = std::filesystem::temp_directory_path() /
                fmt::format("ruche-experiment-{}", reinterpret_cast<std::uintptr_t>(this));
        std::filesystem::create_directories(path_);
        write("experiment.toml", text);
    }
    ~ExperimentFolder() { std::filesystem::remove_all(path_); }
    ExperimentFolder(const ExperimentFolder&) = delete;
    ExperimentFolder& operator=(const ExperimentFolder&) = delete;

    void write(const char* file, const std::string& text) const { std::ofstream(path_ / file) << text; }
    std::string path() const { return path_.string(); }

    std::string problem() const {
        try {
            (void)read_experiment(path_.string());
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

  private:
    std::filesystem::path path_;
};

}  // namespace

TEST_CASE("estimate: three meshes with an error of second order give the order and the limit") {
    const std::vector<double> values = {5.0 + 3.0 * 1.0, 5.0 + 3.0 * 0.25, 5.0 + 3.0 * 0.0625};
    const Estimate e = estimate(values, 2.0);
    CHECK(e.order == doctest::Approx(2.0).epsilon(1e-12));
    CHECK(e.extrapolated == doctest::Approx(5.0).epsilon(1e-12));
    CHECK(e.uncertainty == doctest::Approx(1.25 * 3.0 * 0.0625).epsilon(1e-12));
    CHECK(e.value == values.back());
}

TEST_CASE("estimate: the limit lies within the uncertainty of two meshes, and noise is not extrapolated") {
    const Estimate two = estimate(std::vector<double>{5.4, 5.1}, 2.0);
    CHECK(std::isnan(two.order));
    CHECK(two.uncertainty == doctest::Approx(1.25 * 0.3));
    const Estimate noise = estimate(std::vector<double>{5.0, 5.2, 5.1}, 2.0);
    CHECK(std::isnan(noise.order));
    CHECK(noise.extrapolated == 5.1);
    CHECK(noise.uncertainty == doctest::Approx(1.25 * 0.2));
    CHECK(estimate(std::vector<double>{5.0, 5.0, 5.0}, 2.0).uncertainty == 0.0);
}

TEST_CASE("checks: a trend holds only beyond the uncertainty") {
    CHECK(holds(measured({3, 2, 1}, {4, 3, 2}), {.kind = CheckKind::falls, .metric = "m"}));
    CHECK_FALSE(holds(measured({3, 2, 1.85}, {4, 3, 2}), {.kind = CheckKind::falls, .metric = "m"}));
    CHECK_FALSE(holds(measured({3, 2, 1}, {4, 3, 2}), {.kind = CheckKind::rises, .metric = "m"}));
    const ExperimentOutcome negative = measured({-3, -2, -1}, {-4, -3, -2});
    CHECK(holds(negative, {.kind = CheckKind::falls, .metric = "m", .absolute = true}));
    CHECK(holds(negative, {.kind = CheckKind::rises, .metric = "m"}));
}

TEST_CASE("checks: signs, ranges, references and comparisons count the uncertainty") {
    const ExperimentOutcome o = measured({1.0, 2.0}, {0.05, 2.15});
    const auto of = [](CheckKind kind, const char* variant) {
        return CheckSpec{.kind = kind, .metric = "m", .variants = {variant}};
    };
    CHECK(holds(o, of(CheckKind::positive, "a")));
    CHECK_FALSE(holds(o, of(CheckKind::positive, "b")));
    CHECK_FALSE(holds(o, of(CheckKind::negative, "b")));

    CheckSpec range = of(CheckKind::in_range, "a");
    range.range = {0.9, 2.11};
    CHECK(holds(o, range));
    range.range = {0.9, 2.09};
    CHECK_FALSE(holds(o, range));

    CheckSpec exceeds = of(CheckKind::exceeds, "a");
    exceeds.other_variant = "b";
    CHECK_FALSE(holds(o, exceeds));
    exceeds.where = {0, 0};
    CHECK(holds(o, exceeds));

    CheckSpec ratio = of(CheckKind::ratio, "b");
    ratio.other_variant = "a";
    ratio.where = {1, 1};
    // 2.07/1.92 on the coarser mesh, 2.15/2 on the finer: much nearer to each other than the values are.
    const double width = 1.25 * std::abs(2.15 / 2.0 - 2.07 / 1.92);
    CHECK(width < 0.005);
    ratio.range = {1.075 - width - 1e-9, 1.075 + width + 1e-9};
    CHECK(holds(o, ratio));
    ratio.range[1] = 1.075;
    CHECK(verdict_of(o, ratio) == Verdict::unresolved);

    CheckSpec resolved = of(CheckKind::resolved, "a");
    resolved.relative = 0.1;
    CHECK(holds(o, resolved));
    resolved.relative = 0.09;
    CHECK_FALSE(holds(o, resolved));
}

TEST_CASE(
    "checks: what a part of the uncertainty speaks against is not resolved, what all of it does is wrong") {
    const auto say = [](std::vector<double> a, std::vector<double> b, CheckSpec check) {
        check.metric = "m";
        check.variants = {"a"};
        check.other_variant = check.kind == CheckKind::exceeds || check.kind == CheckKind::ratio ? "b" : "";
        return verdict_of(measured(a, b), check);
    };
    using enum CheckKind;
    CHECK(say({0.05}, {0}, {.kind = positive}) == Verdict::unresolved);
    CHECK(say({0.05}, {0}, {.kind = negative}) == Verdict::unresolved);
    CHECK(say({-0.11}, {0}, {.kind = positive}) == Verdict::fails);
    CHECK(say({0.11}, {0}, {.kind = negative}) == Verdict::fails);
    CHECK(say({1.0}, {1.15}, {.kind = exceeds}) == Verdict::unresolved);
    CHECK(say({1.0}, {1.25}, {.kind = exceeds}) == Verdict::fails);
    CHECK(say({1.0, 1.15}, {1, 1}, {.kind = falls}) == Verdict::unresolved);
    CHECK(say({1.0, 1.25}, {1, 1}, {.kind = falls}) == Verdict::fails);
    CHECK(say({1.0}, {1}, {.kind = in_range, .range = {0.95, 2}}) == Verdict::unresolved);
    CHECK(say({1.0}, {1}, {.kind = in_range, .range = {1.15, 2}}) == Verdict::fails);
    CHECK(say({1.0}, {2}, {.kind = ratio, .range = {0.6, 2}}) == Verdict::fails);
    CHECK(say({1.0}, {1}, {.kind = resolved, .relative = 0.05}) == Verdict::unresolved);
    // One value against it decides, and so does a divisor that is zero.
    CHECK(say({0.05, -1.0}, {0, 0}, {.kind = positive}) == Verdict::fails);
    CHECK(say({1.0}, {0.0}, {.kind = ratio, .range = {-1e9, 1e9}}) == Verdict::fails);
}

TEST_CASE("checks: a quick run does not count as wrong what its meshes do not resolve") {
    ExperimentOutcome o = measured({1.0, 1.15}, {1.0, 1.3});
    o.experiment.checks = {{.kind = CheckKind::rises, .metric = "m", .variants = {"a"}},
                           {.kind = CheckKind::falls, .metric = "m", .variants = {"b"}}};
    o.checks = judge(o);
    Validation validation{.experiments = {o}, .quick = true};
    CHECK(validation.unresolved_checks() == 1);
    CHECK(validation.failed_checks() == 1);
    validation.quick = false;
    CHECK(validation.failed_checks() == 2);
}

TEST_CASE("checks: a reference curve has to have a value where it is compared") {
    ExperimentOutcome o = measured({1.0, 2.0}, {1.0, 2.0});
    o.experiment.references = {{.name = "r", .x = {0.0}, .y = {1.05}}};
    CheckSpec within{
        .kind = CheckKind::within, .metric = "m", .reference = "r", .relative = 0.15, .where = {0, 0}};
    CHECK(holds(o, within));
    within.relative = 0.14;  // 0.9 is 14.3 % away
    CHECK_FALSE(holds(o, within));
    within.relative = 0.15;
    within.where = {0, 1};
    CHECK_FALSE(holds(o, within));
}

TEST_CASE("checks: what is no certified equilibrium proves nothing") {
    ExperimentOutcome o = measured({1.0}, {1.0});
    const CheckSpec positive{.kind = CheckKind::positive, .metric = "m"};
    CHECK(holds(o, positive));
    o.series[1].y[0].certain = false;
    CHECK(verdict_of(o, positive) == Verdict::fails);
}

TEST_CASE(
    "shape measures: a cylinder has mean curvature 1/(2R), a saddle and a sphere their Gauss curvature") {
    const PrintMesh layout = sheet(20.0, 20.0, 40);
    const LayoutRing middle{.middle = Vec2(10, 10), .outer = 6.0};
    const double radius = 12.0;
    const auto rolled = rolled_about(layout, 10.0, radius);
    const IntegratedCurvature cylinder = integrated_curvature(layout, rolled, middle);
    CHECK(cylinder.gauss == doctest::Approx(0.0).epsilon(1e-10));
    // The ring cuts through elements of 0.5 mm on a circumference of 38 mm: some per cent of its area.
    CHECK(cylinder.mean == doctest::Approx(0.5 / radius).epsilon(0.03));

    const auto graph = [&](double sign) {
        return placed(layout, [&](const Vec2& p) {
            const double x = p.x() - 10.0;
            const double y = p.y() - 10.0;
            return Vec3(x, y, -0.5 * (x * x + sign * y * y) / 100.0);
        });
    };
    // z = (x^2 +- y^2)/2R with R = 100: K = +-1/R^2 up to (r/R)^2 < 0.4 % twice.
    const IntegratedCurvature sphere = integrated_curvature(layout, graph(1.0), middle);
    CHECK(sphere.gauss == doctest::Approx(1e-4).epsilon(0.04));
    CHECK(sphere.mean == doctest::Approx(0.01).epsilon(0.04));
    const IntegratedCurvature saddle = integrated_curvature(layout, graph(-1.0), middle);
    CHECK(saddle.gauss == doctest::Approx(-1e-4).epsilon(0.04));
    CHECK(std::abs(saddle.mean) < 1e-4);
    CHECK(std::isnan(integrated_curvature(layout, rolled, {.inner = 500.0, .outer = 600.0}).gauss));
}

TEST_CASE(
    "shape measures: fitted curvatures of a sphere, a cylinder and a saddle, without the ring's border") {
    const PrintMesh layout = sheet(20.0, 20.0, 40);
    const LayoutRing middle{.middle = Vec2(10, 10), .outer = 4.0};
    const double radius = 30.0;
    const auto rolled = rolled_about(layout, 10.0, radius);
    // The second ring of neighbours is 1 mm away: a quadric misses (1/30)^2 of the curvature at most.
    const VertexCurvature cylinder = fitted_curvature(layout, rolled, middle);
    CHECK(cylinder.max == doctest::Approx(1.0 / radius).epsilon(2e-3));
    CHECK(std::abs(cylinder.min) < 2e-3 / radius);
    const auto saddle = placed(layout, [&](const Vec2& p) {
        const double x = p.x() - 10.0;
        const double y = p.y() - 10.0;
        return Vec3(x, y, (x * x - y * y) / (2.0 * 1000.0));
    });
    const VertexCurvature both = fitted_curvature(layout, saddle, middle);
    CHECK(both.max == doctest::Approx(1e-3).epsilon(1e-3));
    CHECK(both.min == doctest::Approx(-1e-3).epsilon(1e-3));
    CHECK(std::isnan(fitted_curvature(layout, saddle, {.inner = 500.0, .outer = 600.0}).max));
}

TEST_CASE("shape measures: a point of the layout is found where it went, a strip of it as a helix") {
    PrintMesh layout = sheet(20.0, 2.0, 8);
    const double radius = 5.0;
    const double advance = 2.0;  // per radian
    const double length = std::hypot(radius, advance);
    const auto shape = placed(layout, [&](const Vec2& p) {
        const double at = p.x() / length;
        // A ruled strip around the helix y = 1: its other points do not matter.
        const double out = radius + (p.y() - 1.0);
        return Vec3(out * std::cos(at), out * std::sin(at), advance * at);
    });
    const Vec3 end = position_of(layout, shape, Vec2(20.0, 1.0));
    CHECK((end -
           Vec3(radius * std::cos(20.0 / length), radius * std::sin(20.0 / length), advance * 20.0 / length))
              .norm() < 1e-12);
    CHECK(std::isnan(position_of(layout, shape, Vec2(21.0, 1.0)).x()));
    layout.strips.push_back(
        {.id = "s", .centreline = {points_on_mesh(layout.mesh, {{0.0, 1.0}, {20.0, 1.0}}, 81)}});
    const HelixFit helix = strip_helix(layout, shape, 0);
    // Chords of 0.25 mm lie 0.25^2/(8 radius^2) = 3e-4 of the radius inside.
    CHECK(helix.curvature == doctest::Approx(radius / (length * length)).epsilon(1e-3));
    CHECK(helix.torsion == doctest::Approx(advance / (length * length)).epsilon(1e-3));
}

TEST_CASE("shape measures: the stretch around the middle is that of the shape, whatever the radial one") {
    const PrintMesh layout = sheet(20.0, 20.0, 20);
    const auto shape = placed(layout, [](const Vec2& p) {
        // Polar coordinates around (10, 10): radius r -> 0.5 r, angle kept: both stretches are 0.5.
        const Vec2 q = 0.5 * (p - Vec2(10, 10));
        return Vec3(q.x(), q.y(), 0.0);
    });
    const LayoutRing ring{.middle = Vec2(10, 10), .inner = 3.0, .outer = 9.0};
    CHECK(transverse_stretch(layout, shape, ring) == doctest::Approx(0.5).epsilon(1e-12));
    const auto cone = placed(layout, [](const Vec2& p) {
        const Vec2 q = p - Vec2(10, 10);
        return Vec3(q.x(), q.y(), 2.0 * q.norm());  // longer outward, not around
    });
    // Within an element around and outward mix: (element/radius)^2.
    CHECK(transverse_stretch(layout, cone, ring) == doctest::Approx(1.0).epsilon(0.02));
}

TEST_CASE("shape measures: the silhouette of a roll is its circle, without what flares at its ends") {
    PrintMesh layout = sheet(30.0, 5.0, 5);
    for (Print& print : layout.print) print.front = 0.6;
    const auto rolled = [&](double straight_from) {
        return placed(layout, [&](const Vec2& p) {
            const double round = std::min(p.x(), straight_from) / 7.0;
            const double rest = std::max(0.0, p.x() - straight_from);
            return Vec3(7.0 * std::sin(round) + rest * std::cos(round), p.y(),
                        7.0 * std::cos(round) - rest * std::sin(round));
        });
    };
    CHECK(silhouette_curvature(layout, rolled(30.0), 1.0) == doctest::Approx(1.0 / 7.0).epsilon(1e-9));
    // Five millimetres at one end are straight; the middle 0.6 of 30 mm ends at 24.
    CHECK(silhouette_curvature(layout, rolled(25.0), 1.0) < 0.99 / 7.0);
    CHECK(silhouette_curvature(layout, rolled(25.0), 0.6) == doctest::Approx(1.0 / 7.0).epsilon(1e-9));
}

TEST_CASE("shape measures: strips are chosen by name and by where they lie, and cut to their middle") {
    PrintMesh layout = sheet(20.0, 20.0, 20);
    for (const double y : {2.0, 10.0, 18.0})
        layout.strips.push_back({.id = fmt::format("row-{:g}", y),
                                 .centreline = {points_on_mesh(layout.mesh, {{5.0, y}, {15.0, y}}, 41)}});
    // A strip in the middle that is as long as the print is not inside half of it.
    CHECK(chosen_strips(layout, "", 1.0) == std::vector<int>{0, 1, 2});
    CHECK(chosen_strips(layout, "row-1", 1.0) == std::vector<int>{1, 2});
    CHECK(chosen_strips(layout, "", 0.5).empty());
    layout.strips.push_back(
        {.id = "short", .centreline = {points_on_mesh(layout.mesh, {{9, 10}, {11, 10}}, 5)}});
    CHECK(chosen_strips(layout, "", 0.5) == std::vector<int>{3});
    CHECK(with_middles(layout, 0.5).strips[0].centreline[0].size() == 21);
}

TEST_CASE("experiments: a mistake is named with its place") {
    const std::string good =
        "scene = \"scene.toml\"\n[[metric]]\nname = \"m\"\n[[check]]\nkind = \"positive\"\nmetric = \"m\"\n";
    CHECK(ExperimentFolder(good).problem().empty());
    const auto problem = [&](const std::string& text) { return ExperimentFolder(text).problem(); };
    CHECK(problem("").find("[[metric]]") != std::string::npos);
    CHECK(problem("titel = \"x\"\n" + good).find("did you mean title") != std::string::npos);
    CHECK(problem("meshes = [1, 0.5, 0.4]\n" + good).find("fall by one factor") != std::string::npos);
    CHECK(problem("meshes = [1]\n" + good).find("fewer than two") != std::string::npos);
    CHECK(problem(good + "variants = [\"b\"]\n").find("no variant \"b\"") != std::string::npos);
    CHECK(problem(good + "[[check]]\nkind = \"exceeds\"\nmetric = \"m\"\n").find("compares with nothing") !=
          std::string::npos);
    CHECK(problem(good + "[[check]]\nkind = \"within\"\nmetric = \"m\"\nreference = \"n\"\n")
              .find("no metric or reference \"n\"") != std::string::npos);
    CHECK(problem(good + "[[picture]]\nvariant = \"b\"\n").find("no variant \"b\"") != std::string::npos);
}

TEST_CASE("experiments: nested meshes are the first one, divided") {
    const std::string text =
        "meshes = [1.4, 0.7, 0.35]\nnested = true\nscene = \"scene.toml\"\n[[metric]]\nname = \"m\"\n"
        "[[check]]\nkind = \"positive\"\nmetric = \"m\"\n";
    const ExperimentFolder folder(text);
    folder.write("scene.toml", "[pattern]\ngenerator = \"strip\"\n[mesh]\nsize_mm = 2\n");
    const std::vector<ValidationRun> runs = expand(read_experiment(folder.path()), false, "program");
    REQUIRE(runs.size() == 3);
    for (const ValidationRun& run : runs) {
        CHECK(run.scene.mesh.size_mm == doctest::Approx(2.8));
        CHECK(std::ldexp(1.4, -run.scene.mesh.subdivisions) == doctest::Approx(run.place.mesh));
        CHECK(run.command.find("mesh.subdivisions=") != std::string::npos);
    }
    CHECK(ExperimentFolder("quick_meshes = [1, 0.5]\n" + text).problem().find("not a half, quarter") !=
          std::string::npos);
}

TEST_CASE("experiments: variants of a file of their own come first, and metrics can be shares of others") {
    const std::string text =
        "scene = \"scene.toml\"\nvariants_from = \"shared.toml\"\n[[variant]]\nname = \"own\"\n"
        "[[metric]]\nname = \"m\"\nover = \"n\"\n[[metric]]\nname = \"n\"\n"
        "[[check]]\nkind = \"positive\"\nmetric = \"m\"\n";
    const ExperimentFolder folder(text);
    folder.write("shared.toml",
                 "[[variant]]\nname = \"first\"\n[[variant]]\nname = \"second\"\nset = [\"a=1\"]\n");
    const Experiment e = read_experiment(folder.path());
    REQUIRE(e.variants.size() == 3);
    CHECK(e.variants[0].name == "first");
    CHECK(e.variants[1].set == std::vector<std::string>{"a=1"});
    CHECK(e.variants[2].name == "own");
    CHECK(e.metrics[0].over == "n");
    folder.write("shared.toml", "[[variants]]\nname = \"first\"\n");
    CHECK(folder.problem().find("did you mean variant") != std::string::npos);
    const std::string missing =
        "scene = \"scene.toml\"\n[[metric]]\nname = \"m\"\nover = \"n\"\n[[check]]\n"
        "kind = \"positive\"\nmetric = \"m\"\n";
    CHECK(ExperimentFolder(missing).problem().find("no metric \"n\"") != std::string::npos);
    CHECK(ExperimentFolder(missing + "[pull]\n[hang]\n").problem().find("stands beside a [pull]") !=
          std::string::npos);
}

TEST_CASE("page: choices are shares of the first variant, estimated from the shares on each mesh") {
    Validation validation;
    validation.experiments.push_back(measured({2.0}, {1.0}));
    CHECK(choice_table(validation).empty());
    validation.experiments[0].experiment.set = ExperimentSet::numerics;
    validation.experiments[0].experiment.name = "folder";
    const std::string html = choice_table(validation);
    CHECK(html.find("2 ± 0.1") != std::string::npos);
    // 0.92 / 1.92 on the coarser mesh: 1.25 (0.5 - 0.4792)
    CHECK(html.find("× 0.500 ± 0.026") != std::string::npos);
    CHECK(html.find("#folder") != std::string::npos);
}

TEST_CASE("experiments: all that come with the source can be read, with every scene of every run") {
    const std::string folder = RUCHE_TEST_DATA "/../../validation";
    const std::vector<std::string> names = experiment_names(folder);
    CHECK(names.size() >= 10);
    for (const std::string& name : names) {
        const Experiment e = read_experiment(folder + "/" + name);
        CHECK_FALSE(e.title.empty());
        CHECK_FALSE(e.shows.empty());
        CHECK_FALSE(e.known.empty());
        for (const CheckSpec& check : e.checks) CHECK_FALSE(check.says.empty());
        const std::vector<ValidationRun> runs = expand(e, false, "test");
        CHECK(runs.size() >= 2);
        CHECK(runs.front().key != runs.back().key);
        CHECK(runs.front().key == expand(e, false, "test").front().key);
        CHECK(runs.front().key != expand(e, false, "another program").front().key);
    }
}

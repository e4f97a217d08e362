#include "ruche/pattern/direction_grid.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>

#include "ruche/core/error.hpp"
#include "ruche/pattern/generator_registry.hpp"
#include "ruche/pattern/generators.hpp"
#include "temporary_file.hpp"

using namespace ruche;
using ruche::test::TemporaryFile;

namespace {

constexpr double degree = M_PI / 180.0;

/// Angle between two lines, which have no sign: 0 to pi/2.
double line_angle(double a, double b) { return std::abs(std::remainder(a - b, M_PI)); }

/// A square grid around the origin: directions as `angle_deg` says, spacing the same everywhere.
std::string grid_text(double reach, double step, double spacing,
                      const std::function<double(double, double)>& angle_deg) {
    std::string text = "x_mm,y_mm,angle_deg,spacing_mm\n";
    const int half = static_cast<int>(std::lround(reach / step));
    for (int j = -half; j <= half; ++j)
        for (int i = -half; i <= half; ++i)
            text += fmt::format("{},{},{},{}\n", i * step, j * step, angle_deg(i * step, j * step), spacing);
    return text;
}

/// "LINE KEY: problem" of a file that is read and has to reach over a disc of 1 mm with a spacing of 1 mm.
std::string grid_problem(const std::string& text) {
    const TemporaryFile file(text);
    try {
        const DirectionGrid grid(file.path());
        grid.require_disc(1.0);
        grid.require_spacing(1.0, 0.65);
    } catch (const InputError& error) {
        CHECK(error.place().file == file.path());
        return fmt::format("{} {}: {}", error.place().line, error.place().key, error.problem());
    }
    return "";
}

std::string traced_problem(std::map<std::string, std::string> options) {
    try {
        (void)generate("traced", options, {.file = "kite.toml", .key = "pattern.options"});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("direction grid: between nodes spacing is bilinear, and directions turn the short way") {
    const TemporaryFile file("0,0,170,2\n10,0,10,4\n0,10,170,2\n10,10,10,8\n");
    const DirectionGrid grid(file.path());
    // 170 and 10 degrees are 20 apart, by way of 0: lines have no sign.
    CHECK(line_angle(grid.angle({5, 3}), 0.0) < 1e-12);
    CHECK(line_angle(grid.angle({0, 7}), 170 * degree) < 1e-12);
    CHECK(line_angle(grid.angle({10, 10}), 10 * degree) < 1e-12);
    CHECK(grid.spacing({5, 0}) == doctest::Approx(3.0).epsilon(1e-12));
    CHECK(grid.spacing({5, 10}) == doctest::Approx(5.0).epsilon(1e-12));
    CHECK(grid.spacing({2.5, 5}) == doctest::Approx(0.75 * 2 + 0.25 * 6).epsilon(1e-12));
    CHECK(grid.largest_spacing() == 8.0);
    // Outside as on the border.
    CHECK(grid.spacing({-3, 4}) == grid.spacing({0, 4}));
    CHECK(grid.spacing({50, 50}) == 8.0);
}

TEST_CASE("direction grid: rows in any order, columns by the header, separators and steps as they come") {
    const TemporaryFile sorted("0,0,0,2\n1,0,10,3\n5,0,20,4\n0,2,30,5\n1,2,40,6\n5,2,50,7\n");
    const TemporaryFile shuffled(
        "\xEF\xBB\xBF# from another program\r\nspacing_mm;angle_deg;y_mm;x_mm\r\n7;50;2;5\r\n2;0;0;0\r\n"
        "6;40;2;0.9999999999\r\n3;10;0;1\r\n\r\n5;30;2;0\r\n4;20;0;5\r\n");
    const DirectionGrid a(sorted.path());
    const DirectionGrid b(shuffled.path());
    for (const Vec2& p : {Vec2(0, 0), Vec2(0.3, 1.7), Vec2(4, 0.5), Vec2(5, 2)}) {
        CHECK(a.angle(p) == doctest::Approx(b.angle(p)).epsilon(1e-9));
        CHECK(a.spacing(p) == doctest::Approx(b.spacing(p)).epsilon(1e-9));
    }
    CHECK(a.spacing({3, 0}) == doctest::Approx(3.5).epsilon(1e-12));
}

TEST_CASE("direction grid: what is no grid, or none of numbers, is an error with its line") {
    const std::string good = "-1,-1,0,2\n1,-1,0,2\n-1,1,0,2\n1,1,0,2\n";
    CHECK(grid_problem(good).empty());
    CHECK(mentions(grid_problem(""), "no nodes"));
    CHECK(mentions(grid_problem("# nothing\n"), "no nodes"));
    CHECK(mentions(grid_problem("0,0,0,2\n1,0,0\n"), "2 : 3 columns, expected 4"));
    CHECK(mentions(grid_problem("0,0,0,2\n1,0,nan,2\n"), "2 angle_deg: \"nan\" is not a finite number"));
    CHECK(mentions(grid_problem("0,0,0,2\n1,0,0,inf\n"), "2 spacing_mm: \"inf\""));
    CHECK(mentions(grid_problem("0,0,0,2\n1,0,,2\n"), "2 angle_deg: \"\""));
    CHECK(mentions(grid_problem("0,0,0,2\n1,0,0,0\n"), "2 spacing_mm: 0 is outside"));
    CHECK(mentions(grid_problem("x,y,angle,spacing\n" + good), "1 : the header has no column \"x_mm\""));
    CHECK(mentions(grid_problem(good + "x_mm,y_mm,angle_deg,spacing_mm\n"), "5 x_mm: \"x_mm\""));
    CHECK(mentions(grid_problem("0,0,0,2\n0,1,0,2\n"), "a grid of 1 x 2 nodes"));
    CHECK(mentions(grid_problem(good + "1,-1,5,2\n"),
                   "5 : the node x = 1, y = -1 mm stands in line 2 already"));
}

TEST_CASE("direction grid: a missing node is named, and the row whose coordinate slipped") {
    const auto nine = [](const char* middle) {
        return std::string("-1,-1,0,2\n0,-1,0,2\n1,-1,0,2\n-1,0,0,2\n") + middle +
               "1,0,0,2\n-1,1,0,2\n0,1,0,2\n1,1,0,2\n";
    };
    CHECK(grid_problem(nine("0,0,0,2\n")).empty());
    // Nobody is to blame for a row that is not there.
    CHECK(mentions(grid_problem(nine("")),
                   "0 : there is no node at x = 0, y = 0 mm: 8 rows with 3 different x and 3"));
    CHECK(mentions(grid_problem(nine("0.05,0,0,2\n")), "5 : there is no node at x = 0.05, y = -1"));
    CHECK(mentions(grid_problem(nine("0,0.05,0,2\n")), "5 : there is no node at x = 0, y = 0"));
    // As many places as pairs of coordinates would not fit into memory.
    std::string line_of_nodes;
    for (int i = 0; i < 100000; ++i) line_of_nodes += fmt::format("{0},{0},0,2\n", 0.01 * i);
    CHECK(mentions(grid_problem(line_of_nodes), "100000 different x and 100000 different y"));
}

TEST_CASE("direction grid: it has to reach over the fabric and leave room between strips") {
    CHECK(mentions(grid_problem("-1,-1,0,2\n0.9,-1,0,2\n-1,1,0,2\n0.9,1,0,2\n"), "over x from -1 to 0.9"));
    CHECK(mentions(grid_problem("-1,-1,0,2\n1,-1,0,2\n-1,1,0,0.9\n1,1,0,2\n"),
                   "3 spacing_mm: lines 0.9 mm apart"));
}

TEST_CASE("traced generator: a field from a file gives the lines of the field that it was taken from") {
    const TemporaryFile file(
        grid_text(20.0, 0.5, 2.5, [](double x, double y) { return std::atan2(y, x) / degree + 90.0; }));
    const TracedStripsOptions options{
        .field = DirectionField::file, .file = file.path(), .inner = 6, .outer = 20, .length = 10};
    const GeneratedPattern pattern = generate_traced(options);
    CHECK(pattern.fabric.size() == 2);
    REQUIRE(pattern.strips.size() > 10);
    for (const DrawnStrip& strip : pattern.strips) {
        // A bilinear (cos 2a, sin 2a) is off by at most h^2/8 of its second derivatives, 4/r^2 along x and y
        // each: half of it in the angle, 0.0035 at r = 6; over 10 mm of line 0.035 mm.
        const Polyline& line = strip.lines.front().points;
        for (const Vec2& p : line) CHECK(std::abs(p.norm() - line.front().norm()) < 0.035);
    }
}

TEST_CASE("traced generator: spacings from a file, and strips cross the place where directions cancel") {
    // Angles half as fast as the polar one: a singular point that only lines without sign can have.
    const TemporaryFile file(
        grid_text(16.0, 1.0, 3.5, [](double x, double y) { return 0.5 * std::atan2(y, x) / degree; }));
    const GeneratedPattern pattern = generate_traced(
        {.field = DirectionField::file, .file = file.path(), .inner = 0, .outer = 16, .length = 0});
    CHECK(pattern.fabric.size() == 1);
    double nearest_to_middle = 1e9;
    double closest = 1e9;
    for (std::size_t i = 0; i < pattern.strips.size(); ++i)
        for (const Vec2& p : pattern.strips[i].lines.front().points) {
            CHECK(p.allFinite());
            nearest_to_middle = std::min(nearest_to_middle, p.norm());
            for (std::size_t k = 0; k < i; ++k)
                for (const Vec2& q : pattern.strips[k].lines.front().points)
                    closest = std::min(closest, (p - q).norm());
        }
    CHECK(closest > 0.75 * 3.5 - 1e-9);
    CHECK(closest < 3.5);
    CHECK(nearest_to_middle < 3.5);
}

TEST_CASE("traced generator: what contradicts a field from a file is named") {
    const TemporaryFile file(grid_text(10.0, 1.0, 2.5, [](double, double) { return 0.0; }));
    CHECK(mentions(traced_problem({{"field", "file"}}), "pattern.options.file: no file"));
    CHECK(mentions(traced_problem({{"file", file.path()}}), "pattern.options.file: is given"));
    CHECK(mentions(traced_problem({{"field", "file"}, {"file", "/nowhere/at all.csv"}}),
                   "/nowhere/at all.csv: there is no"));
    CHECK(mentions(traced_problem({{"field", "file"}, {"file", file.path()}}),
                   "the fabric 20 mm to all sides"));
    const std::map<std::string, std::string> good = {
        {"field", "file"}, {"file", file.path()}, {"outer_mm", "10"}, {"inner_mm", "0"}};
    CHECK(traced_problem(good).empty());
    auto with_spacing = good;
    with_spacing["spacing_mm"] = "3";
    CHECK(mentions(traced_problem(with_spacing),
                   "pattern.options.spacing_mm: means nothing with a field from a file"));
    auto wide = good;
    wide["width_mm"] = "2";
    CHECK(mentions(traced_problem(wide), ":2: spacing_mm: lines 2.5 mm apart leave no room"));
}

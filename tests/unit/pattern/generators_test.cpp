#include "ruche/pattern/generators.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "ruche/core/error.hpp"
#include "ruche/pattern/generator_registry.hpp"
#include "ruche/pattern/tiling.hpp"
#include "temporary_file.hpp"

using namespace ruche;
using ruche::test::TemporaryFile;

namespace {

const Polyline& line_of(const DrawnStrip& strip) { return strip.lines.front().points; }

std::string problem_of(std::string_view name, const std::map<std::string, std::string>& options) {
    try {
        (void)generate(name, options, {.file = "kite.toml", .key = "pattern.options"});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool contains_text(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("strip generator: the strip has its length from end to end, caps included") {
    const GeneratedPattern butt = generate_strip({.length = 30, .width = 2});
    REQUIRE(butt.strips.size() == 1);
    CHECK(line_of(butt.strips[0]) == Polyline{{-15, 0}, {15, 0}});
    CHECK(butt.fabric.empty());
    const GeneratedPattern round = generate_strip({.length = 30, .width = 2, .cap = StripCap::round});
    CHECK(line_of(round.strips[0]) == Polyline{{-14, 0}, {14, 0}});
    CHECK(round.strips[0].cap == LineCap::round);
    CHECK_THROWS_AS(generate_strip({.length = 1, .width = 2}), InputError);
}

TEST_CASE("staggered generator: rows are a pitch apart and shifted by half a period") {
    const GeneratedPattern p =
        generate_staggered({.length = 10, .axial_gap = 2, .pitch = 3, .rows = 3, .strips_per_row = 2});
    // Rows of 2, 1 + two halves, 2.
    REQUIRE(p.strips.size() == 7);
    CHECK(line_of(p.strips[0]) == Polyline{{-11, -3}, {-1, -3}});
    CHECK(line_of(p.strips[1]) == Polyline{{1, -3}, {11, -3}});
    CHECK(line_of(p.strips[2]) == Polyline{{-11, 0}, {-7, 0}});
    CHECK(line_of(p.strips[3]) == Polyline{{-5, 0}, {5, 0}});
    CHECK(line_of(p.strips[4]) == Polyline{{7, 0}, {11, 0}});
    CHECK(line_of(p.strips[6]) == Polyline{{1, 3}, {11, 3}});
    const GeneratedPattern ragged = generate_staggered(
        {.length = 10, .axial_gap = 2, .pitch = 3, .rows = 3, .strips_per_row = 2, .half_strips = false});
    CHECK(ragged.strips.size() == 5);
}

TEST_CASE("staggered generator: every other row can be on the back") {
    const GeneratedPattern p = generate_staggered({.rows = 2, .strips_per_row = 1, .alternate_sides = true});
    CHECK(p.strips.front().side == Side::front);
    CHECK(p.strips.back().side == Side::back);
}

TEST_CASE("radial generator: the torus has 80 evenly spread strips that end on the outline") {
    const GeneratedPattern p = generate_radial({});
    REQUIRE(p.strips.size() == 80);
    std::vector<double> angles;
    for (const DrawnStrip& strip : p.strips) {
        const Polyline& line = line_of(strip);
        // Corners of the butt end on the circle of the fabric.
        CHECK(std::hypot(line[1].norm(), 0.5) == doctest::Approx(34).epsilon(1e-12));
        double angle = std::atan2(line[1].y(), line[1].x());
        angles.push_back(angle < -1e-9 ? angle + 2 * M_PI : angle);
    }
    CHECK(std::hypot(line_of(p.strips[0])[0].norm(), 0.5) == doctest::Approx(12).epsilon(1e-12));
    CHECK(line_of(p.strips[20])[0].norm() == doctest::Approx(16.5));
    CHECK(line_of(p.strips[40])[0].norm() == doctest::Approx(22));
    std::ranges::sort(angles);
    for (int i = 0; i < 80; ++i) CHECK(angles[i] == doctest::Approx(2 * M_PI * i / 80).epsilon(1e-9));
    REQUIRE(p.fabric.size() == 2);
    for (const Vec2& x : p.fabric[0]) CHECK(x.norm() == doctest::Approx(34).epsilon(1e-12));
    for (const Vec2& x : p.fabric[1]) CHECK(x.norm() == doctest::Approx(12).epsilon(1e-12));
}

TEST_CASE("radial generator: strips that were inserted keep as far from the others as they can") {
    const GeneratedPattern p = generate_radial({.rings = "12:8, 20:4"});
    const Polyline& line = line_of(p.strips[8]);
    CHECK(std::atan2(line[1].y(), line[1].x()) == doctest::Approx(M_PI / 8));
}

TEST_CASE("star generator: arms run along the tiling's edges towards the neighbours and do not touch") {
    const StarTilingOptions options;
    const GeneratedPattern p = generate_stars(options);
    REQUIRE(p.strips.size() ==
            12);  // 6 at one edge and 6 at two from the centre; those at sqrt(7) would leave the disc
    int facing = 0;
    for (const DrawnStrip& star : p.strips) {
        REQUIRE(star.lines.size() == 3);
        for (const DrawnLine& arm : star.lines) {
            const Vec2 along = (arm.points[1] - arm.points[0]).normalized();
            const Vec2 neighbour = arm.points[0] + options.edge * along;
            for (const DrawnStrip& other : p.strips) facing += (line_of(other)[0] - neighbour).norm() < 1e-9;
            const Vec2 across(-along.y(), along.x());
            for (const double side : {0.6, -0.6})
                CHECK((arm.points[1] + side * across).norm() <= options.radius - options.rim + 1e-9);
        }
    }
    CHECK(facing == 12 * 3 - 6 * 2);  // each of the outer six has two arms that look outward
    CHECK((line_of(p.strips[0])[1] - line_of(p.strips[0])[0]).norm() == doctest::Approx(2.9));
    CHECK_THROWS_AS(generate_stars({.arm = 3.2}), InputError);
    CHECK_THROWS_AS(generate_stars({.width = 3}), InputError);
    CHECK_THROWS_AS(generate_stars({.radius = 3}), InputError);
}

TEST_CASE("hexagon generator: neighbours are the gap apart, outlined or filled") {
    const HexagonTilingOptions options{.edge = 6, .gap = 1.5, .style = HexagonStyle::filled, .radius = 16};
    const GeneratedPattern p = generate_hexagons(options);
    REQUIRE(p.strips.size() == 7);
    const auto inradius = [](const Polyline& hexagon) { return hexagon[0].norm() * std::sqrt(3.0) / 2; };
    const double cell = 6 * std::sqrt(3.0) / 2;
    CHECK(2 * (cell - inradius(line_of(p.strips[0]))) == doctest::Approx(1.5));
    CHECK(p.strips[0].width == 0.0);
    CHECK(p.strips[0].lines[0].closed);
    HexagonTilingOptions outlined = options;
    outlined.style = HexagonStyle::outlined;
    outlined.width = 1.0;
    const GeneratedPattern q = generate_hexagons(outlined);
    CHECK(2 * (cell - inradius(line_of(q.strips[0])) - 0.5) == doctest::Approx(1.5));
    CHECK_THROWS_AS(generate_hexagons({.edge = 1, .gap = 2}), InputError);
    CHECK_THROWS_AS(generate_hexagons({.edge = 2, .gap = 0.5, .width = 1.5}), InputError);
}

TEST_CASE("tiling: vertices are all there, each once, each with three neighbours") {
    const auto vertices = hexagon_vertices(2.0, 20.0);
    for (const TilingVertex& v : vertices) {
        if (v.at.norm() > 17.9) continue;
        int neighbours = 0;
        int same = 0;
        for (const TilingVertex& w : vertices) {
            const double distance = (v.at - w.at).norm();
            same += distance < 1e-6;
            neighbours += std::abs(distance - 2.0) < 1e-6;
        }
        CHECK(same == 1);
        CHECK(neighbours == 3);
    }
}

TEST_CASE("curve generator: points are read whatever separates them, curves split at empty lines") {
    const TemporaryFile file(
        "\xEF\xBB\xBFx_mm, y_mm\r\n# a comment\r\n0, 0\r\n10.5, -2e1\r\n\r\n1;1\n2\t1\n2 2\n1,1\n");
    const GeneratedPattern p = generate_curves({.file = file.path(), .width = 1.5});
    REQUIRE(p.strips.size() == 2);
    CHECK(line_of(p.strips[0]) == Polyline{{0, 0}, {10.5, -20}});
    CHECK_FALSE(p.strips[0].lines[0].closed);
    CHECK(line_of(p.strips[1]) == Polyline{{1, 1}, {2, 1}, {2, 2}});
    CHECK(p.strips[1].lines[0].closed);
    CHECK(p.strips[1].width == 1.5);
}

TEST_CASE("curve generator: a third column names the curves") {
    const TemporaryFile file("curve,x_mm,y_mm\nb c,0,0\na,5,5\nb c,1,0\na,6,5\nb-c,0,9\nb-c,1,9\nlone,3,3\n");
    const GeneratedPattern p = generate_curves({.file = file.path()});
    REQUIRE(p.strips.size() == 3);
    CHECK(p.strips[0].id == "curve-b-c");
    CHECK(line_of(p.strips[0]) == Polyline{{0, 0}, {1, 0}});
    CHECK(p.strips[1].id == "curve-a");
    CHECK(p.strips[2].id == "curve-b-c-2");
    REQUIRE(p.warnings.size() == 1);
    CHECK(contains_text(p.warnings[0], "lone"));
}

TEST_CASE("curve generator: what is no table of points is an error with its line") {
    const auto message = [](const char* text) {
        const TemporaryFile file(text);
        try {
            (void)generate_curves({.file = file.path()});
        } catch (const InputError& error) {
            return std::to_string(error.place().line) + " " + error.problem();
        }
        return std::string();
    };
    CHECK(contains_text(message("0,0\n1,x\n"), "2 "));
    CHECK(contains_text(message("0,0\n1,nan\n"), "2 "));
    CHECK(contains_text(message("0,0\n1\n"), "2 1 columns"));
    CHECK(contains_text(message("0,0\n1,5;2,5\n"), "2 4 columns"));
    CHECK(contains_text(message("0,0\na,1,1\n"), "2 the number of columns changes"));
    CHECK(contains_text(message("0,0\n1e9,1\n"), "2 "));
    CHECK(contains_text(message(""), "no points"));
    CHECK(contains_text(message("# nothing\n"), "no points"));
    CHECK(contains_text(message("1,1\n1,1\n"), "no curve"));
}

TEST_CASE("generator registry: every generator runs with its defaults and has unique ids") {
    const TemporaryFile file("0,0\n10,0\n");
    for (const std::string& name : generator_names()) {
        CAPTURE(name);
        std::map<std::string, std::string> options;
        if (name == "curves") options["file"] = file.path();
        const GeneratedPattern p = generate(name, options);
        CHECK(p.name == name);
        CHECK_FALSE(p.strips.empty());
        std::set<std::string> ids;
        for (const DrawnStrip& strip : p.strips) CHECK(ids.insert(strip.id).second);
    }
}

TEST_CASE("generator registry: options are read from text and told back in the description") {
    const GeneratedPattern p =
        generate("radial", {{"rings", "15:10"}, {"width_mm", "1.25"}, {"inner_mm", "14"}});
    CHECK(p.strips.size() == 10);
    CHECK(p.strips[0].width == 1.25);
    CHECK(contains_text(p.description, "width_mm = 1.25"));
    CHECK(contains_text(p.description, "rings = 15:10"));
    CHECK(contains_text(p.description, "outer_mm = 34"));
}

TEST_CASE("generator registry: help knows every option with its default, unit and range") {
    for (const GeneratorInfo& about : generators()) {
        CHECK_FALSE(about.summary.empty());
        for (const GeneratorOption& option : about.options) {
            CAPTURE(option.key);
            CHECK_FALSE(option.meaning.empty());
            CHECK((option.unit == "mm") == option.key.ends_with("_mm"));
        }
    }
    const GeneratorInfo strip = generators().front();
    CHECK(strip.options[0].key == "length_mm");
    CHECK(strip.options[0].initial == "30");
    CHECK(strip.options[2].range == "butt | round");
}

TEST_CASE("generator registry: mistakes are errors that name the option and help") {
    CHECK(contains_text(problem_of("radail", {}), "did you mean radial?"));
    CHECK(contains_text(problem_of("radial", {{"width", "1"}}), "did you mean width_mm?"));
    CHECK(
        contains_text(problem_of("radial", {{"width_mm", "1"}, {"x", "1"}}), "kite.toml: pattern.options.x"));
    CHECK(contains_text(problem_of("strip", {{"width_mm", "wide"}}), "\"wide\" is not a number"));
    CHECK(contains_text(problem_of("strip", {{"width_mm", "1,5"}}), "decimals with a point"));
    CHECK(contains_text(problem_of("strip", {{"width_mm", ""}}), "is not a number"));
    CHECK(contains_text(problem_of("strip", {{"width_mm", "nan"}}), "not a finite number"));
    CHECK(contains_text(problem_of("strip", {{"width_mm", "0.01"}}), "outside [0.1, 1000]"));
    CHECK(contains_text(problem_of("strip", {{"cap", "rond"}}), "did you mean round?"));
    CHECK(contains_text(problem_of("staggered", {{"rows", "2.5"}}), "not a whole number"));
    CHECK(contains_text(problem_of("staggered", {{"half_strips", "yes"}}), "neither true nor false"));
    CHECK(contains_text(problem_of("staggered", {{"pitch_mm", "0.9"}}), "pattern.options.pitch_mm"));
    CHECK(contains_text(problem_of("staggered", {{"rows", "2000"}, {"strips_per_row", "2000"}}), "too many"));
    for (const char* rings : {"", "12", "12:", ":20", "12:20,", "12:-3", "12:0", "nan:3", "12:20; 14:3",
                              "9:20", "12:20, 11:20", "33.9:20", "12:99999999999", "12:200"}) {
        CAPTURE(rings);
        CHECK(contains_text(problem_of("radial", {{"rings", rings}}), "pattern.options.rings"));
    }
    CHECK(contains_text(problem_of("radial", {{"inner_mm", "40"}}), "inner_mm"));
    CHECK(contains_text(
        problem_of("hexagons",
                   {{"edge_mm", "0.5"}, {"gap_mm", "0.1"}, {"style", "filled"}, {"radius_mm", "9999"}}),
        "too many"));
    CHECK(contains_text(problem_of("curves", {}), "no file"));
    CHECK(contains_text(problem_of("curves", {{"file", "/nowhere/at all.csv"}}), "/nowhere/at all.csv"));
}

TEST_CASE("traced generator: lines follow their field and keep their distance") {
    const TracedStripsOptions options{.field = DirectionField::circular, .inner = 5, .outer = 20};
    const GeneratedPattern pattern = generate_traced(options);
    CHECK(pattern.fabric.size() == 2);
    REQUIRE(pattern.strips.size() > 10);
    for (const DrawnStrip& strip : pattern.strips) {
        // Runge-Kutta's fourth order with steps of 0.25 mm on radii above 5 mm: far below a micrometre.
        const double radius = line_of(strip).front().norm();
        for (const Vec2& p : line_of(strip)) CHECK(p.norm() == doctest::Approx(radius).epsilon(1e-5));
        CHECK(radius > 5.0 + 0.5 + 0.5);
        CHECK(radius < 20.0 - 0.5 - 0.5);
    }
    double closest = 1e9;
    for (std::size_t i = 0; i < pattern.strips.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            for (const Vec2& p : line_of(pattern.strips[i]))
                for (const Vec2& q : line_of(pattern.strips[k])) closest = std::min(closest, (p - q).norm());
    CHECK(closest > 0.75 * 2.5 - 1e-9);
}

TEST_CASE("traced generator: radial lines grow in number outward, so that their distance stays") {
    const GeneratedPattern pattern =
        generate_traced({.field = DirectionField::radial, .inner = 4, .outer = 24, .length = 0});
    for (const double radius : {7.0, 12.0, 17.0, 22.0}) {
        int crossing = 0;
        for (const DrawnStrip& strip : pattern.strips) {
            const Vec2& a = line_of(strip).front();
            const Vec2& b = line_of(strip).back();
            CHECK(std::abs(a.x() * b.y() - a.y() * b.x()) <
                  1e-6 * a.norm() * b.norm());  // through the middle
            if ((a.norm() < radius) != (b.norm() < radius)) ++crossing;
        }
        // Lines may be as near as three quarters of the spacing; where two are two spacings apart one begins.
        CHECK(2.0 * M_PI * radius / crossing > 0.75 * 2.5);
        CHECK(2.0 * M_PI * radius / crossing < 2.0 * 2.5);
    }
}

TEST_CASE("traced generator: strips are cut to their length, and printed on the back near the middle") {
    const GeneratedPattern pattern = generate_traced(
        {.field = DirectionField::parallel, .inner = 0, .outer = 20, .length = 6, .back_inside = 9});
    CHECK(pattern.fabric.size() == 1);
    int on_the_back = 0;
    for (const DrawnStrip& strip : pattern.strips) {
        const Polyline& line = line_of(strip);
        CHECK((line.back() - line.front()).norm() < 6.0 + 1e-9);
        CHECK((strip.side == Side::back) == (line[line.size() / 2].norm() < 9.0));
        on_the_back += strip.side == Side::back ? 1 : 0;
    }
    CHECK(on_the_back > 3);
    CHECK(on_the_back < static_cast<int>(pattern.strips.size()) / 2);
}

TEST_CASE("traced generator: lines go on to where their distance grows") {
    const GeneratedPattern pattern = generate_traced({.field = DirectionField::parallel,
                                                      .inner = 0,
                                                      .outer = 20,
                                                      .spacing = 2,
                                                      .outer_spacing = 4,
                                                      .length = 0});
    // Wherever there is room for a line there is one: nothing is farther from all lines than the largest
    // spacing.
    for (int i = -17; i <= 17; ++i)
        for (int j = -17; j <= 17; ++j) {
            const Vec2 p(i, j);
            if (p.norm() > 17.0) continue;
            double nearest = 1e9;
            for (const DrawnStrip& strip : pattern.strips)
                for (const Vec2& q : line_of(strip)) nearest = std::min(nearest, (p - q).norm());
            CAPTURE(i);
            CAPTURE(j);
            CHECK(nearest < 4.0);
        }
}

TEST_CASE("traced generator: contradictions are named") {
    CHECK(contains_text(problem_of("traced", {{"spacing_mm", "1.2"}}), "leave no room"));
    CHECK(contains_text(problem_of("traced", {{"inner_mm", "0"}}), "no direction in its middle"));
    CHECK(contains_text(problem_of("traced", {{"inner_mm", "30"}}), "not smaller than outer_mm"));
    CHECK(problem_of("traced", {{"inner_mm", "0"}, {"field", "parallel"}}).empty());
}

TEST_CASE("traced generator: a spiral over a very large disc is refused, not waited for") {
    CHECK(contains_text(problem_of("traced", {{"field", "circular"},
                                              {"turn_deg", "1"},
                                              {"inner_mm", "4"},
                                              {"outer_mm", "800"},
                                              {"length_mm", "0"},
                                              {"spacing_mm", "1.6"},
                                              {"outer_spacing_mm", "1.6"}}),
                        "more strips than anybody prints"));
}

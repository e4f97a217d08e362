#include "ruche/pattern/svg_export.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "ruche/pattern/generator_registry.hpp"

using namespace ruche;

namespace {

bool has_text(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Writes the SVG and reads it back.
Drawing read_back(const GeneratedPattern& generated) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("ruche-export-" + generated.name + ".svg");
    std::ofstream(path, std::ios::binary) << to_svg(generated);
    Drawing drawing = read_svg(path.string());
    std::filesystem::remove(path);
    return drawing;
}

/// The letter F: stem and two arms, no symmetry at all.
GeneratedPattern letter_f() {
    GeneratedPattern p{.name = "letter-f"};
    p.strips.push_back({.id = "stem", .lines = {{{{1, 0}, {1, 10}}, false}}, .width = 1.0});
    p.strips.push_back({.id = "top", .lines = {{{{1, 9.5}, {6, 9.5}}, false}}, .width = 1.0});
    p.strips.push_back({.id = "bar", .lines = {{{{1, 5}, {4, 5}}, false}}, .width = 1.0, .side = Side::back});
    return p;
}

}  // namespace

TEST_CASE("svg export: the page is in millimetres and y points down") {
    const std::string svg = to_svg(letter_f(), {.page_margin = 5});
    // x from 0.5 - 5 to 6.5 + 5, y from -0.5 - 5 to 10.5 + 5, to whole mm.
    CHECK(has_text(svg, "width=\"17mm\" height=\"22mm\" viewBox=\"0 0 17 22\""));
    CHECK(has_text(svg, "<path id=\"top\" fill=\"none\" stroke=\"#d9480f\" stroke-width=\"1\""));
    CHECK(has_text(svg, "d=\"M 6,6.5 L 11,6.5\""));  // 16 - 9.5 down, 5 to the right of 1
}

TEST_CASE("svg export: front, back and fabric are layers of their own") {
    GeneratedPattern p = letter_f();
    p.fabric = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}};
    const std::string svg = to_svg(p);
    const auto fabric = svg.find("inkscape:label=\"fabric\"");
    const auto back = svg.find("inkscape:label=\"back\"");
    const auto front = svg.find("inkscape:label=\"front\"");
    REQUIRE(front != std::string::npos);
    CHECK(fabric < back);
    CHECK(back < svg.find("id=\"bar\""));
    CHECK(svg.find("id=\"bar\"") < front);
    CHECK(front < svg.find("id=\"stem\""));
}

TEST_CASE("svg export: text from outside cannot break the file") {
    GeneratedPattern p = letter_f();
    p.name = "a & b";
    p.description = "file = <x>\"&\n\x01--";
    p.strips[0].id = "q\"><script>";
    const std::string svg = to_svg(p);
    CHECK(has_text(svg, "<title>a &amp; b</title>"));
    CHECK(has_text(svg, "&lt;x&gt;&quot;&amp;  --"));
    CHECK_FALSE(has_text(svg, "<script>"));
    CHECK_FALSE(has_text(svg, "\x01"));
}

TEST_CASE("svg export: an empty pattern is still a drawing") {
    CHECK(has_text(to_svg({.name = "nothing"}), "</svg>"));
}

TEST_CASE("svg export: read back, every generator's regions, layers and ids are the same") {
    const std::vector<std::pair<std::string, std::map<std::string, std::string>>> cases = {
        {"strip", {{"cap", "round"}}},
        {"staggered", {{"rows", "4"}, {"alternate_sides", "true"}}},
        {"radial", {}},
        {"stars", {}},
        {"hexagons", {{"radius_mm", "18"}}},
        {"hexagons", {{"radius_mm", "18"}, {"style", "filled"}}}};
    for (const auto& [name, options] : cases) {
        CAPTURE(name);
        const GeneratedPattern generated = generate(name, options);
        const Drawing direct = to_drawing(generated);
        const Drawing read = read_back(generated);
        CHECK(read.warnings.empty());
        REQUIRE(read.shapes.size() == direct.shapes.size());
        for (const Shape& shape : direct.shapes) {
            CAPTURE(shape.id);
            const auto same_id = [&](const Shape& s) { return s.id == shape.id; };
            const auto other = std::ranges::find_if(read.shapes, same_id);
            REQUIRE(other != read.shapes.end());
            CHECK(other->layer == shape.layer);
            CHECK(other->stroke_colour == shape.stroke_colour);
            CHECK(other->fill_colour == shape.fill_colour);
            CHECK(other->stroke_width == doctest::Approx(shape.stroke_width));
            REQUIRE(other->lines.size() == shape.lines.size());
            CHECK(other->closed == shape.closed);
            // The page's corner is the drawing's origin: compare with the shift between the first points,
            // which is the same for all.
            const Vec2 shift =
                read.shapes[0].lines[0][0] - std::ranges::find_if(direct.shapes, [&](const Shape& s) {
                                                 return s.id == read.shapes[0].id;
                                             })->lines[0][0];
            for (std::size_t l = 0; l < shape.lines.size(); ++l) {
                REQUIRE(other->lines[l].size() == shape.lines[l].size());
                for (std::size_t i = 0; i < shape.lines[l].size(); ++i)
                    CHECK((other->lines[l][i] - shift - shape.lines[l][i]).norm() < 2e-6);
            }
            const double ink = area(shape.stroked) + area(shape.filled);
            // Round caps are flattened by each side's own rule, within 0.01 mm.
            CHECK(area(other->stroked) + area(other->filled) ==
                  doctest::Approx(ink).epsilon(name == "strip" ? 1e-3 : 1e-5));
        }
    }
}

TEST_CASE("svg export: a letter F comes back as an F, not mirrored") {
    const Drawing read = read_back(letter_f());
    REQUIRE(read.shapes.size() == 3);
    const auto shape = [&](const char* id) {
        return *std::ranges::find_if(read.shapes, [&](const Shape& s) { return s.id == id; });
    };
    const Polyline stem = shape("stem").lines[0];
    const Polyline top = shape("top").lines[0];
    const Polyline bar = shape("bar").lines[0];
    CHECK(stem[1].y() - stem[0].y() == doctest::Approx(10));
    CHECK(top[1].x() - top[0].x() == doctest::Approx(5));
    CHECK(bar[0].y() - stem[0].y() == doctest::Approx(5));
    CHECK(bar[1].x() - stem[0].x() == doctest::Approx(3));
    CHECK(shape("bar").layer == "back");
}

TEST_CASE("generated pattern: the torus becomes a printed pattern without warnings") {
    const GeneratedPattern generated = generate("radial", {});
    const Pattern pattern = to_pattern(generated, {.thickness = 0.7});
    CHECK(pattern.strips.size() == 80);
    CHECK(pattern.warnings.empty());
    CHECK(pattern.strips[0].thickness == 0.7);
    double printed = 0;
    for (const Strip& strip : pattern.strips) printed += area(strip.region);
    const auto reach = [](double r) { return std::sqrt(r * r - 0.25); };
    CHECK(printed ==
          doctest::Approx(20 * (reach(34) - reach(12)) + 20 * (reach(34) - 16.5) + 40 * (reach(34) - 22))
              .epsilon(1e-6));
    CHECK(area(pattern.fabric) == doctest::Approx(M_PI * (34 * 34 - 12 * 12)).epsilon(2e-3));
}

TEST_CASE("generated pattern: strips on the back layer are printed on the other side") {
    const GeneratedPattern generated = generate("staggered", {{"rows", "2"}, {"alternate_sides", "true"}});
    for (const Side side : {Side::front, Side::back}) {
        const Pattern pattern = to_pattern(generated, {.side = side});
        CHECK(pattern.strips.front().side == side);
        CHECK(pattern.strips.back().side != side);
    }
}

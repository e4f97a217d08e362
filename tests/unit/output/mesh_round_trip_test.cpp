#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "ruche/meshing/print_mesh.hpp"
#include "ruche/output/export_surface.hpp"
#include "ruche/output/exporters.hpp"
#include "ruche/output/metrics.hpp"
#include "ruche/output/surface_fields.hpp"
#include "ruche/pattern/generator_registry.hpp"

using namespace ruche;

namespace {

PrintMesh drawn(const std::string& generator, const std::map<std::string, std::string>& options,
                double size = 1.0) {
    const PrintRules rules{.thickness = 0.7};
    return mesh_pattern(to_pattern(generate(generator, options), rules), {.size_mm = size});
}

/// The layout as it comes back from a file that Ruche wrote, or that somebody else wrote who knows thickness
/// alone.
PrintMesh read_back(const PrintMesh& layout, bool thickness_alone = false) {
    Result result;
    result.layout = layout;
    for (const Vec2& v : layout.mesh.vertices) result.shape.emplace_back(v.x(), v.y(), 0.0);
    std::string text = to_ply(layout_surface(result, surface_fields(result)));
    if (thickness_alone) {
        for (const std::string property : {"strip", "front_strip", "back_strip"}) {
            const std::string line = "property int " + property + "\n";
            text.replace(text.find(line), line.size(), "property int other\n");
        }
    }
    const auto path = std::filesystem::temp_directory_path() /
                      fmt::format("ruche-layout-{}.ply", reinterpret_cast<std::uintptr_t>(&layout));
    std::ofstream(path, std::ios::binary) << text;
    PrintMesh again = read_print_mesh(path.string());
    std::filesystem::remove(path);
    return again;
}

/// The layout rolled to a cylinder whose axis lies 20 degrees from y.
std::vector<Vec3> rolled(const PrintMesh& layout, double radius) {
    const Vec2 across(std::cos(0.349), std::sin(0.349));
    std::vector<Vec3> shape;
    for (const Vec2& v : layout.mesh.vertices) {
        const double u = across.dot(v);
        const double along = across.x() * v.y() - across.y() * v.x();
        shape.emplace_back(radius * std::sin(u / radius), along, radius * (std::cos(u / radius) - 1.0));
    }
    return shape;
}

const std::vector<std::pair<std::string, std::map<std::string, std::string>>> patterns = {
    {"strip", {{"length_mm", "20"}}},
    {"staggered", {{"rows", "3"}}},
    {"radial", {{"outer_mm", "20"}, {"rings", "12:6,16:6"}}},
    {"stars", {{"radius_mm", "16"}}}};

}  // namespace

TEST_CASE("mesh input: the mesh of a generated pattern has the strips of the pattern") {
    for (const auto& [name, options] : patterns) {
        CAPTURE(name);
        const PrintMesh layout = drawn(name, options);
        const PrintMesh again = read_back(layout);
        CHECK(again.mesh.vertices == layout.mesh.vertices);
        CHECK(again.mesh.triangles == layout.mesh.triangles);
        CHECK(again.print == layout.print);
        CHECK(again.strip == layout.strip);
        REQUIRE(again.strips.size() == layout.strips.size());
        for (std::size_t i = 0; i < layout.strips.size(); ++i) {
            CHECK(again.strips[i].id == layout.strips[i].id);
            CHECK(again.strips[i].side == layout.strips[i].side);
            CHECK(again.strips[i].thickness == layout.strips[i].thickness);
            CHECK(again.strips[i].centreline.size() == layout.strips[i].centreline.size());
        }
    }
}

TEST_CASE("mesh input: strips of a mesh file are as curved and as long as the drawing's") {
    // Both are measured at other points of the same facets of size h on a cylinder. Such points lie up to h^2
    // / 8 R inside of it, and a line of length L rises by L^2 / 8 R: curvatures may differ by a share of (h /
    // L)^2, lengths of facets by (h / R)^2 / 24. Lines differ by the grid of 1 nm on which borders lie, their
    // ends by a few times that.
    constexpr double radius = 30.0;
    constexpr double size = 0.25;
    for (const auto& [name, options] : patterns) {
        CAPTURE(name);
        const PrintMesh layout = drawn(name, options, size);
        const PrintMesh again = read_back(layout);
        const std::vector<Vec3> shape = rolled(layout, radius);
        const std::vector<StripMetrics> wanted = measure_strips(layout, shape);
        const std::vector<StripMetrics> found = measure_strips(again, shape);
        REQUIRE(found.size() == wanted.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            CAPTURE(wanted[i].id);
            const double line =
                wanted[i].printed_length / static_cast<double>(layout.strips[i].centreline.size());
            CHECK(std::abs(found[i].curvature - wanted[i].curvature) * radius < size * size / (line * line));
            CHECK(std::abs(found[i].printed_length - wanted[i].printed_length) < 2e-5);
            CHECK(std::abs(found[i].stretch - wanted[i].stretch) < size * size / (radius * radius) / 24);
        }
    }
}

TEST_CASE("mesh input: crossing strips on either side are both measured over their full length") {
    Pattern drawn;
    const auto add = [&](const std::string& id, const Vec2& half, Side side, double thickness) {
        const Vec2 across = 0.5 * Vec2(-half.y(), half.x()).normalized();
        const Polyline outline = {-half - across, half - across, half + across, across - half};
        drawn.strips.push_back({.id = id,
                                .region = {{outline, {}}},
                                .centreline = {{-half, half}},
                                .thickness = thickness,
                                .side = side});
    };
    add("front", Vec2(10, 0), Side::front, 0.6);
    add("back", Vec2(2, 8), Side::back, 0.9);
    const PrintMesh layout = mesh_pattern(finish_pattern(drawn, 2.0), {.size_mm = 0.5});
    const std::vector<Vec3> shape = rolled(layout, 30.0);
    const double length[] = {20.0, 2.0 * std::hypot(2.0, 8.0)};
    // By number, and by what hangs together on one side: without numbers the front comes first if its first
    // triangle does.
    for (const bool thickness_alone : {false, true}) {
        CAPTURE(thickness_alone);
        const PrintMesh again = read_back(layout, thickness_alone);
        if (!thickness_alone) CHECK(again.strip == layout.strip);
        REQUIRE(again.strips.size() == 2);
        const std::vector<StripMetrics> found = measure_strips(again, shape);
        const std::vector<StripMetrics> wanted = measure_strips(layout, shape);
        for (std::size_t i = 0; i < 2; ++i) {
            CAPTURE(again.strips[i].id);
            const std::size_t own = again.strips[i].side == Side::front ? 0 : 1;
            CHECK(again.strips[i].thickness == layout.strips[own].thickness);
            CHECK(again.strips[i].centreline.size() == 1);
            CHECK(wanted[own].printed_length == doctest::Approx(length[own]).epsilon(1e-6));
            CHECK(found[i].printed_length == doctest::Approx(length[own]).epsilon(1e-6));
            CHECK(found[i].curvature == doctest::Approx(wanted[own].curvature).epsilon(1e-3));
            CHECK(found[i].stretch == doctest::Approx(wanted[own].stretch).epsilon(1e-4));
        }
        CHECK(again.strips[0].side != again.strips[1].side);
    }
}

TEST_CASE("mesh input: without numbers of strips, what hangs together and is equally thick is a strip") {
    const PrintMesh layout = drawn("stars", {});
    const PrintMesh again = read_back(layout, true);
    REQUIRE(again.strips.size() == layout.strips.size());
    for (const MeshedStrip& strip : again.strips) {
        CHECK(strip.id.starts_with("strip-"));
        CHECK(strip.centreline.size() == 3);
    }
}

TEST_CASE("mesh input: moduli and names with blanks survive in a layout that Ruche wrote") {
    PrintMesh layout = drawn("strip", {{"length_mm", "20"}});
    for (Print& print : layout.print)
        if (!print.bare()) print.front_modulus = 26.5;
    layout.strips[0].id = "the \xc3\xbc\nstrip";
    const PrintMesh again = read_back(layout);
    CHECK(again.print == layout.print);
    CHECK(again.strips[0].id == "the \xc3\xbc strip");
}

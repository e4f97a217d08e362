#include "ruche/meshing/centre_edges.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "ruche/core/error.hpp"
#include "ruche/geometry/polyline.hpp"
#include "ruche/pattern/generator_registry.hpp"

using namespace ruche;

namespace {

Pattern generated(const std::string& name, const std::map<std::string, std::string>& options, double margin) {
    return to_pattern(generate(name, options, {}), {.thickness = 0.6, .margin = margin});
}

PrintMesh meshed(const Pattern& pattern, bool centre_lines) {
    return mesh_pattern(pattern, {.size_mm = 1.0, .centre_lines = centre_lines});
}

/// Every step of every line is an edge inside the mesh; returns their total length.
double length_of_edge_lines(const PrintMesh& layout) {
    std::set<std::pair<int, int>> inner;
    for (const Edge& edge : find_edges(layout.mesh).edges) {
        if (!edge.on_boundary()) inner.insert(std::minmax(edge.vertex[0], edge.vertex[1]));
    }
    double total = 0.0;
    for (const MeshedStrip& strip : layout.strips) {
        CHECK_FALSE(strip.edge_lines.empty());
        for (const MeshedStrip::EdgeLine& line : strip.edge_lines) {
            for (std::size_t k = 0; k + 1 < line.vertices.size(); ++k) {
                const int a = line.vertices[k];
                const int b = line.vertices[k + 1];
                CHECK(inner.contains(std::minmax(a, b)));
                total += (layout.mesh.vertices[b] - layout.mesh.vertices[a]).norm();
            }
        }
    }
    return total;
}

double drawn_length(const Pattern& pattern) {
    double total = 0.0;
    for (const Strip& strip : pattern.strips) {
        for (const Polyline& line : strip.centreline) total += length(line);
    }
    return total;
}

double printed_area(const PrintMesh& layout) {
    double area = 0.0;
    for (int t = 0; t < layout.mesh.triangle_count(); ++t)
        area += layout.print[t].bare() ? 0.0 : layout_area(layout.mesh, t);
    return area;
}

}  // namespace

TEST_CASE(
    "centre edges: strips are followed by edges from end to end, and print and fabric stay what they are") {
    const Pattern patterns[] = {generated("strip", {{"length_mm", "20"}, {"width_mm", "1.5"}}, 5.0),
                                generated("strip", {{"length_mm", "20"}, {"width_mm", "1.5"}}, 0.0),
                                generated("strip", {{"length_mm", "20"}, {"cap", "round"}}, 3.0),
                                generated("staggered", {{"rows", "3"}, {"strips_per_row", "2"}}, 2.0),
                                generated("radial", {}, 0.0)};
    for (const Pattern& pattern : patterns) {
        const PrintMesh with = meshed(pattern, true);
        const PrintMesh without = meshed(pattern, false);
        CHECK(length_of_edge_lines(with) == doctest::Approx(drawn_length(pattern)).epsilon(2e-3));
        CHECK(printed_area(with) == doctest::Approx(printed_area(without)).epsilon(1e-6));
        CHECK(with.strips.size() == without.strips.size());
        CHECK(without.strips[0].edge_lines.empty());
        // The lines cut strips in two: elements of half their width, not dust.
        CHECK(with.mesh.triangle_count() < 6 * without.mesh.triangle_count());
    }
}

TEST_CASE("centre edges: the width is the strip's") {
    const PrintMesh layout = meshed(generated("strip", {{"width_mm", "1.5"}}, 5.0), true);
    CHECK(layout.strips[0].edge_lines[0].width == doctest::Approx(1.5).epsilon(1e-3));
}

TEST_CASE("centre edges: filled stars have a line per arm that meet in one vertex") {
    const PrintMesh layout = meshed(generated("stars", {{"radius_mm", "14"}}, 0.0), true);
    for (const MeshedStrip& strip : layout.strips) {
        REQUIRE(strip.edge_lines.size() == 3);
        std::multiset<int> ends;
        for (const MeshedStrip::EdgeLine& line : strip.edge_lines)
            ends.insert({line.vertices.front(), line.vertices.back()});
        CHECK(std::ranges::any_of(ends, [&](int v) { return ends.count(v) == 3; }));
    }
}

TEST_CASE("centre edges: a strip without a centre line is an error that names it") {
    Pattern pattern = generated("strip", {}, 5.0);
    pattern.strips[0].id = "lonely";
    pattern.strips[0].centreline.clear();
    pattern.strips[0].centreline_found = false;
    CHECK_THROWS_WITH_AS(meshed(pattern, true), doctest::Contains("lonely"), InputError);
    CHECK_NOTHROW(meshed(pattern, false));
}

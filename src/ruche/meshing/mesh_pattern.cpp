#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/geometry/border_graph.hpp"
#include "ruche/geometry/mesh_order.hpp"
#include "ruche/geometry/polyline.hpp"
#include "ruche/meshing/branched_midlines.hpp"
#include "ruche/meshing/centre_edges.hpp"
#include "ruche/meshing/divide_triangles.hpp"
#include "ruche/meshing/point_locator.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/meshing/size_field.hpp"
#include "ruche/meshing/triangulate.hpp"

namespace ruche {

namespace {

constexpr double grid_snap = 2e-6;         // mm: the borders of a finished pattern stay as they are
constexpr int most_triangles = 2'000'000;  // minutes per Newton step; memory of some 20 GB
constexpr double unforeseen = 20.0;        // times the expected number of triangles: borders too close

void check(const Pattern& pattern, const MeshOptions& options) {
    const auto positive = [](double value, const char* key, const char* meaning) {
        if (value > 0.0 && std::isfinite(value)) return;
        throw InputError({.key = key}, fmt::format("{} is not a positive number", value), meaning);
    };
    positive(options.size_mm, "mesh.size_mm", "Edge length of the elements on plastic, mm.");
    positive(options.fabric_size_mm, "mesh.fabric_size_mm", "Edge length far from plastic, mm.");
    positive(options.elements_across, "mesh.elements_across", "Elements across the width of a strip.");
    if (!(options.grading >= 0.0) || !std::isfinite(options.grading)) {
        throw InputError({.key = "mesh.grading"}, fmt::format("{} is not a growth rate", options.grading),
                         "Growth of the edge length per length away from plastic: 0 or more.");
    }
    if (pattern.fabric.empty()) throw InputError({}, "the pattern has no fabric to mesh");
}

// The edge length that keeps a strip's curvature within 1 % of a converged one (theory page, section 5.3;
// bench/mesh_study.py), in proportion to `size_mm`. Elements must be small against the radius of curvature. A
// strip that is wide compared to its thickness also curls across its width, and how far it does changes its
// curvature along: there (size * width) must be small against (sheet thickness * radius) until the strip is
// so wide that only its rims curl.
double resolving_size(double width, double thickness, const MeshOptions& options) {
    // Of a narrow strip of Table 1's materials, mm: within a quarter from 0.3 to 1.2 mm of plastic.
    const double radius = 19.0 * thickness * thickness;
    constexpr double third_of_sheet = 0.38;  // mm
    const double along = radius / 4.5;
    const double across = std::max(third_of_sheet * radius / width, width / 12.0);
    constexpr double smallest_share = 0.35;  // thin plastic must not cost any number of elements
    return options.size_mm * std::clamp(std::min(along, across) / MeshOptions{}.size_mm, smallest_share, 1.0);
}

double size_on(const Polygon& polygon, double thickness, const MeshOptions& options) {
    const double width = strip_width(polygon);
    return std::min(width / options.elements_across, resolving_size(width, thickness, options));
}

SizeField size_field(const Pattern& pattern, const MeshOptions& options) {
    double finest = options.size_mm;
    for (const Strip& strip : pattern.strips) {
        for (const Polygon& polygon : strip.region)
            finest = std::min(finest, size_on(polygon, strip.thickness, options));
    }
    SizeField field(bounding_box(pattern.fabric),
                    {.far_size = std::max(options.fabric_size_mm, options.size_mm),
                     .grading = options.grading,
                     .finest = finest});
    for (const Strip& strip : pattern.strips) {
        for (const Polygon& polygon : strip.region)
            field.refine({polygon}, size_on(polygon, strip.thickness, options));
    }
    field.spread();
    return field;
}

// The graph's segments, those around plastic divided evenly: even triangles on strips, and the same on both
// of its sides. `origin` tells which segment of the graph each came from.
SegmentGraph divide(const BorderGraph& graph, const SizeField& sizes, std::vector<int>& origin) {
    SegmentGraph result;
    result.points = graph.points;
    for (int i = 0; i < static_cast<int>(graph.segments.size()); ++i) {
        const BorderGraph::Segment& s = graph.segments[i];
        const Vec2& a = graph.points[s.point[0]];
        const Vec2& b = graph.points[s.point[1]];
        const bool outline = s.regions.front() == 0;
        const bool plastic = s.regions.back() > 0;
        // A piece up to a fifth too long is better than two short ones.
        const double pieces = plastic ? std::ceil((b - a).norm() / sizes.at(0.5 * (a + b)) - 0.2) : 1.0;
        const int count = static_cast<int>(std::clamp(pieces, 1.0, 1.0 * most_triangles));
        int from = s.point[0];
        for (int k = 1; k <= count; ++k) {
            const int to = k == count ? s.point[1] : static_cast<int>(result.points.size());
            if (k < count) result.points.emplace_back(a + (b - a) * (static_cast<double>(k) / count));
            result.segments.push_back({from, to});
            result.outline.push_back(outline);
            origin.push_back(i);
            from = to;
        }
    }
    return result;
}

// Triangles of the mesh for one of the triangulation.
double parts_of_triangle(const MeshOptions& options) { return std::pow(4.0, options.subdivisions); }

Triangulation refined(const MeshOptions& options, const SegmentGraph& graph, const SizeField& sizes,
                      double expected) {
    const double most_undivided = most_triangles / parts_of_triangle(options);
    if (expected > most_undivided) {
        const double enough = options.size_mm * std::sqrt(expected / most_undivided);
        throw InputError({.key = "mesh.size_mm"},
                         fmt::format("the mesh would take about {:.2g} triangles; the limit is {:.2g}",
                                     expected * parts_of_triangle(options), 1.0 * most_triangles),
                         fmt::format("Choose mesh.size_mm = {:.2g} or larger (now {:.3g}), or a larger "
                                     "mesh.fabric_size_mm (now {:.3g}).",
                                     enough, options.size_mm, options.fabric_size_mm));
    }
    const double limit = std::min(most_undivided, unforeseen * expected + 200.0 * graph.points.size());
    try {
        return triangulate(
            graph, [&](const Vec2& p) { return sizes.at(p); }, static_cast<int>(limit));
    } catch (const InputError& error) {
        throw InputError(
            {.key = "mesh.size_mm"}, error.problem(),
            "Borders there are much closer to each other than the element size: join or separate "
            "them in the drawing, or choose a smaller mesh.size_mm.");
    }
}

// Which regions (0 = fabric, i + 1 = strip i) cover each piece of the plane: a border changes its own ones, a
// line (numbered from `region_count` on) none.
std::vector<std::vector<int>> regions_of_pieces(const Triangulation& triangulation, const BorderGraph& graph,
                                                const std::vector<int>& origin, int region_count) {
    struct Door {
        int piece, segment;
    };
    std::vector<std::vector<Door>> doors(triangulation.piece_count);
    for (std::size_t s = 0; s < origin.size(); ++s) {
        const auto [left, right] = triangulation.beside[s];
        doors[left].push_back({right, origin[s]});
        doors[right].push_back({left, origin[s]});
    }
    std::vector<std::vector<int>> regions(triangulation.piece_count);
    std::vector<char> known(triangulation.piece_count, 0);
    std::vector<int> open = {0};
    known[0] = 1;
    while (!open.empty()) {
        const int piece = open.back();
        open.pop_back();
        for (const Door& door : doors[piece]) {
            if (known[door.piece]) continue;
            known[door.piece] = 1;
            const std::vector<int>& border = graph.segments[door.segment].regions;
            const auto lines = std::lower_bound(border.begin(), border.end(), region_count);
            std::set_symmetric_difference(regions[piece].begin(), regions[piece].end(), border.begin(), lines,
                                          std::back_inserter(regions[door.piece]));
            open.push_back(door.piece);
        }
    }
    return regions;
}

StripPair strips_over(const std::vector<int>& regions, const std::vector<Strip>& strips) {
    StripPair pair;
    for (const int r : regions) {
        if (r == 0) continue;
        int& best = pair.on(strips[r - 1].side);
        if (best < 0 || strips[r - 1].thickness > strips[best].thickness) best = r - 1;
    }
    return pair;
}

Print print_of(const StripPair& pair, const std::vector<Strip>& strips) {
    Print print;
    if (pair.front >= 0) {
        print.front = strips[pair.front].thickness;
        print.front_modulus = strips[pair.front].youngs_modulus;
    }
    if (pair.back >= 0) {
        print.back = strips[pair.back].thickness;
        print.back_modulus = strips[pair.back].youngs_modulus;
    }
    return print;
}

// A sheet must not hang together at a single point: nothing could be said about how it bends there.
void check_manifold(const TriangleMesh& mesh) {
    std::vector<int> border_edges(mesh.vertices.size(), 0);
    for (const Edge& edge : find_edges(mesh).edges) {
        if (!edge.on_boundary()) continue;
        for (const int v : edge.vertex) {
            if (++border_edges[v] <= 2) continue;
            const Vec2& at = mesh.vertices[v];
            throw InputError(
                {},
                fmt::format("parts of the fabric touch at a single point, x = {:.5g}, y = {:.5g} mm", at.x(),
                            at.y()),
                "Let them overlap or keep them apart, or lay a margin of fabric around the print.");
        }
    }
}

void warn_about_size(PrintMesh& result, double expected) {
    constexpr double worth_a_word = 5.0;
    if (result.mesh.triangle_count() < worth_a_word * (expected + 100.0)) return;
    int smallest = 0;
    for (int t = 1; t < result.mesh.triangle_count(); ++t) {
        if (layout_area(result.mesh, t) < layout_area(result.mesh, smallest)) smallest = t;
    }
    const Vec2& at = result.mesh.vertices[result.mesh.triangles[smallest][0]];
    result.warnings.push_back(
        fmt::format("the mesh has {} triangles where about {:.0f} would do, because borders "
                    "are very close to each other, for example near x = {:.4g}, y = {:.4g} mm",
                    result.mesh.triangle_count(), expected, at.x(), at.y()));
}

/// What was drawn; of a region that nobody drew a line into, and that branches, all its branches.
std::vector<Polyline> centre_lines(const Strip& strip) {
    const auto branches = [](const Polygon& polygon) { return !branched_midlines(polygon).empty(); };
    const bool all_found = strip.centreline_found && std::ranges::any_of(strip.region, branches);
    return all_found ? middle_lines(strip.region) : strip.centreline;
}

std::vector<MeshedStrip> meshed_strips(const Pattern& pattern, const MeshOptions& options,
                                       const PrintMesh& layout) {
    const PointLocator locator(layout.mesh);
    std::vector<MeshedStrip> result;
    for (int s = 0; s < static_cast<int>(pattern.strips.size()); ++s) {
        const Strip& strip = pattern.strips[s];
        MeshedStrip meshed{.id = strip.id,
                           .side = strip.side,
                           .thickness = strip.thickness,
                           .centreline = {},
                           .youngs_modulus = strip.youngs_modulus,
                           .edge_lines = {}};
        const auto own = [&](int t) { return layout.strip[t].on(strip.side) == s; };
        double size = options.size_mm;
        for (const Polygon& polygon : strip.region)
            size = std::min(size, size_on(polygon, strip.thickness, options));
        size = std::ldexp(size, -options.subdivisions);
        for (const Polyline& line : centre_lines(strip)) {
            const double pieces = std::ceil(length(line) / (0.5 * size) - 1e-9);
            if (!(pieces >= 1.0 && pieces < most_triangles)) continue;
            std::vector<MeshPoint> points;
            for (const Vec2& p : resample(line, false, static_cast<int>(pieces) + 1)) {
                if (const std::optional<MeshPoint> at = locator.find(p, 0.5 * size, own))
                    points.push_back(*at);
            }
            if (points.size() >= 2) meshed.centreline.push_back(std::move(points));
        }
        result.push_back(std::move(meshed));
    }
    return result;
}

}  // namespace

MeshOptions undivided(MeshOptions options) {
    options.size_mm = std::ldexp(options.size_mm, -options.subdivisions);
    options.fabric_size_mm = std::ldexp(options.fabric_size_mm, -options.subdivisions);
    options.elements_across = std::ldexp(options.elements_across, options.subdivisions);
    options.subdivisions = 0;
    return options;
}

PrintMesh mesh_pattern(const Pattern& pattern, const MeshOptions& options) {
    check(pattern, options);
    std::vector<Region> regions = {pattern.fabric};
    for (const Strip& strip : pattern.strips) regions.push_back(strip.region);
    const SizeField sizes = size_field(pattern, options);
    CentreEdges centre_edges;
    if (options.centre_lines) {
        for (const Strip& strip : pattern.strips) centre_edges.add(strip, centre_lines(strip), sizes);
    }
    const BorderGraph graph = border_graph(regions, grid_snap, centre_edges.lines());
    std::vector<int> origin;
    const SegmentGraph segments = divide(graph, sizes, origin);
    const double expected = sizes.expected_triangles(pattern.fabric);
    Triangulation triangulation = refined(options, segments, sizes, expected);
    for (int i = 0; i < options.subdivisions; ++i) triangulation = divided(std::move(triangulation));
    if (triangulation.mesh.triangles.empty()) throw InputError({}, "the fabric's outline encloses no area");

    const std::vector<std::vector<int>> covered =
        regions_of_pieces(triangulation, graph, origin, static_cast<int>(regions.size()));
    const std::vector<int> order = spatial_order(triangulation.mesh);
    PrintMesh result;
    result.mesh = reordered(triangulation.mesh, order);
    check_manifold(result.mesh);
    for (const int t : order) {
        result.strip.push_back(strips_over(covered[triangulation.piece[t]], pattern.strips));
        result.print.push_back(print_of(result.strip.back(), pattern.strips));
    }
    result.strips = meshed_strips(pattern, options, result);
    centre_edges.find(result);
    result.outline_layer = pattern.outline_layer;
    result.warnings = pattern.warnings;
    warn_about_size(result, expected * parts_of_triangle(options));
    const int pieces = find_pieces(result.mesh).count;
    if (pieces > 1) {
        result.warnings.push_back(
            fmt::format("the fabric is in {} separate pieces, which move independently", pieces));
    }
    return result;
}

}  // namespace ruche

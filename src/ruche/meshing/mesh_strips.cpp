#include "ruche/meshing/mesh_strips.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ruche/geometry/polyline.hpp"
#include "ruche/meshing/point_locator.hpp"
#include "ruche/pattern/centreline.hpp"

namespace ruche {
namespace {

/// Numbers the components of equal print; -1 on bare fabric.
int number_components(PrintMesh& layout, const MeshEdges& edges) {
    const int count = layout.mesh.triangle_count();
    layout.strip.assign(count, -1);
    int components = 0;
    std::vector<int> open;
    for (int seed = 0; seed < count; ++seed) {
        if (layout.strip[seed] >= 0 || layout.print[seed].bare()) continue;
        layout.strip[seed] = components;
        open.push_back(seed);
        while (!open.empty()) {
            const int t = open.back();
            open.pop_back();
            for (const int e : edges.of_triangle[t]) {
                for (const int u : edges.edges[e].triangle) {
                    if (u < 0 || layout.strip[u] >= 0 || !(layout.print[u] == layout.print[seed])) continue;
                    layout.strip[u] = components;
                    open.push_back(u);
                }
            }
        }
        ++components;
    }
    return components;
}

/// The borders of every component as closed chains of points, the printed side on their left.
std::vector<std::vector<Polyline>> border_loops(const PrintMesh& layout, const MeshEdges& edges,
                                                int components) {
    std::vector<std::multimap<int, int>> next(components);  // per component: from vertex to vertex
    for (const Edge& edge : edges.edges) {
        for (int k = 0; k < 2; ++k) {
            if (edge.triangle[k] < 0) continue;
            const int own = layout.strip[edge.triangle[k]];
            const int other = edge.triangle[1 - k] < 0 ? -1 : layout.strip[edge.triangle[1 - k]];
            if (own >= 0 && own != other) next[own].emplace(edge.vertex[k], edge.vertex[1 - k]);
        }
    }
    std::vector<std::vector<Polyline>> loops(components);
    for (int c = 0; c < components; ++c) {
        while (!next[c].empty()) {
            Polyline loop;
            auto step = next[c].begin();
            while (step != next[c].end()) {
                loop.push_back(layout.mesh.vertices[step->first]);
                const int to = step->second;
                next[c].erase(step);
                step = next[c].find(to);
            }
            loops[c].push_back(std::move(loop));
        }
    }
    return loops;
}

/// Mean length of the edges inside and around each component.
std::vector<double> element_sizes(const PrintMesh& layout, const MeshEdges& edges, int components) {
    std::vector<double> sum(components, 0.0);
    std::vector<int> count(components, 0);
    for (const Edge& edge : edges.edges) {
        const int c = layout.strip[edge.triangle[0]];
        if (c < 0) continue;
        sum[c] += (layout.mesh.vertices[edge.vertex[0]] - layout.mesh.vertices[edge.vertex[1]]).norm();
        ++count[c];
    }
    for (int c = 0; c < components; ++c) sum[c] /= std::max(count[c], 1);
    return sum;
}

}  // namespace

void find_strips(PrintMesh& layout) {
    const MeshEdges edges = find_edges(layout.mesh);
    const int components = number_components(layout, edges);
    const std::vector<std::vector<Polyline>> loops = border_loops(layout, edges, components);
    const std::vector<double> sizes = element_sizes(layout, edges, components);
    layout.strips.assign(components, {});
    for (int t = layout.mesh.triangle_count() - 1; t >= 0; --t) {
        if (layout.strip[t] < 0) continue;
        MeshedStrip& strip = layout.strips[layout.strip[t]];
        const Print& print = layout.print[t];
        strip.side = print.front >= print.back ? Side::front : Side::back;
        strip.thickness = std::max(print.front, print.back);
    }
    const PointLocator locator(layout.mesh);
    for (int c = 0; c < components; ++c) {
        MeshedStrip& strip = layout.strips[c];
        strip.id = "strip-" + std::to_string(c + 1);
        const Region region = region_from_loops(loops[c], FillRule::nonzero);
        for (const Polygon& polygon : region) {
            for (const Polyline& line : cut_to_region({midline(polygon)}, {polygon})) {
                const double steps = std::ceil(2.0 * length(line) / std::max(sizes[c], 1e-9));
                if (!(steps >= 1.0 && steps < 1e7)) continue;
                std::vector<MeshPoint> points;
                for (const Vec2& x : resample(line, false, static_cast<int>(steps) + 1)) {
                    const auto at = locator.find(x, sizes[c], [&](int t) { return layout.strip[t] == c; });
                    if (at) points.push_back(*at);
                }
                if (points.size() >= 2) strip.centreline.push_back(std::move(points));
            }
        }
    }
}

}  // namespace ruche

#include "ruche/meshing/mesh_strips.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ruche/geometry/polyline.hpp"
#include "ruche/meshing/branched_midlines.hpp"
#include "ruche/meshing/point_locator.hpp"

namespace ruche {
namespace {

/// Numbers the strips; -1 on bare fabric. Returns the number that the file gave to each, -1 for none.
std::vector<int> number_strips(PrintMesh& layout, const MeshEdges& edges, const std::vector<int>& given) {
    const int count = layout.mesh.triangle_count();
    const auto given_to = [&](int t) {
        return given.empty() || layout.print[t].bare() ? -1 : given[static_cast<std::size_t>(t)];
    };
    std::map<int, int> by_given;
    for (int t = 0; t < count; ++t)
        if (given_to(t) >= 0) by_given[given_to(t)] = 0;
    std::vector<int> own;
    for (auto& [number, strip] : by_given) {
        strip = static_cast<int>(own.size());
        own.push_back(number);
    }
    layout.strip.assign(count, -1);
    std::vector<int> open;
    for (int seed = 0; seed < count; ++seed) {
        if (given_to(seed) >= 0) layout.strip[seed] = by_given[given_to(seed)];
        if (layout.strip[seed] >= 0 || layout.print[seed].bare()) continue;
        layout.strip[seed] = static_cast<int>(own.size());
        open.push_back(seed);
        while (!open.empty()) {
            const int t = open.back();
            open.pop_back();
            for (const int e : edges.of_triangle[t]) {
                for (const int u : edges.edges[e].triangle) {
                    if (u < 0 || layout.strip[u] >= 0 || given_to(u) >= 0) continue;
                    if (!(layout.print[u] == layout.print[seed])) continue;
                    layout.strip[u] = static_cast<int>(own.size());
                    open.push_back(u);
                }
            }
        }
        own.push_back(-1);
    }
    return own;
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

void find_strips(PrintMesh& layout, const std::vector<int>& number, const std::map<int, std::string>& names) {
    const MeshEdges edges = find_edges(layout.mesh);
    const std::vector<int> given = number_strips(layout, edges, number);
    const int count = static_cast<int>(given.size());
    const std::vector<std::vector<Polyline>> loops = border_loops(layout, edges, count);
    const std::vector<double> sizes = element_sizes(layout, edges, count);
    layout.strips.assign(count, {});
    for (int t = layout.mesh.triangle_count() - 1; t >= 0; --t) {
        if (layout.strip[t] < 0) continue;
        MeshedStrip& strip = layout.strips[layout.strip[t]];
        const Print& print = layout.print[t];
        strip.side = print.front >= print.back ? Side::front : Side::back;
        strip.thickness = std::max(print.front, print.back);
    }
    const PointLocator locator(layout.mesh);
    for (int c = 0; c < count; ++c) {
        MeshedStrip& strip = layout.strips[c];
        const auto name = names.find(given[c]);
        strip.id = given[c] >= 0 && name != names.end() ? name->second : "strip-" + std::to_string(c + 1);
        for (const Polyline& line : middle_lines(region_from_loops(loops[c], FillRule::nonzero))) {
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

}  // namespace ruche

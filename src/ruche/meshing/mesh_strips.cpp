#include "ruche/meshing/mesh_strips.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ruche/geometry/polyline.hpp"
#include "ruche/meshing/branched_midlines.hpp"
#include "ruche/meshing/point_locator.hpp"

namespace ruche {
namespace {

constexpr Side sides[] = {Side::front, Side::back};

/// What is printed on one side: thickness and modulus.
std::pair<double, double> print_on(const Print& print, Side side) {
    return side == Side::front ? std::pair(print.front, print.front_modulus)
                               : std::pair(print.back, print.back_modulus);
}

/// Numbers the strips; -1 on bare fabric. Returns the number that the file gave to each, -1 for none.
std::vector<int> number_strips(PrintMesh& layout, const MeshEdges& edges,
                               const std::vector<StripPair>& given) {
    const int count = layout.mesh.triangle_count();
    const auto printed = [&](int t, Side side) { return print_on(layout.print[t], side).first > 0.0; };
    const auto given_to = [&](int t, Side side) {
        return given.empty() || !printed(t, side) ? -1 : given[static_cast<std::size_t>(t)].on(side);
    };
    std::map<int, int> by_given;
    for (int t = 0; t < count; ++t) {
        for (const Side side : sides)
            if (given_to(t, side) >= 0) by_given[given_to(t, side)] = 0;
    }
    std::vector<int> own;
    for (auto& [number, strip] : by_given) {
        strip = static_cast<int>(own.size());
        own.push_back(number);
    }
    layout.strip.assign(count, {});
    for (int t = 0; t < count; ++t) {
        for (const Side side : sides)
            if (given_to(t, side) >= 0) layout.strip[t].on(side) = by_given[given_to(t, side)];
    }
    const auto open_to_number = [&](int t, Side side) {
        return printed(t, side) && layout.strip[t].on(side) < 0;
    };
    std::vector<int> open;
    const auto spread = [&](int seed, Side side) {
        layout.strip[seed].on(side) = static_cast<int>(own.size());
        open.push_back(seed);
        while (!open.empty()) {
            const int t = open.back();
            open.pop_back();
            for (const int e : edges.of_triangle[t]) {
                for (const int u : edges.edges[e].triangle) {
                    if (u < 0 || !open_to_number(u, side)) continue;
                    if (print_on(layout.print[u], side) != print_on(layout.print[seed], side)) continue;
                    layout.strip[u].on(side) = static_cast<int>(own.size());
                    open.push_back(u);
                }
            }
        }
        own.push_back(-1);
    };
    for (int seed = 0; seed < count; ++seed) {
        for (const Side side : sides)
            if (open_to_number(seed, side)) spread(seed, side);
    }
    return own;
}

/// Calls `use(strip)` for each strip on a pair of sides, once.
template <class Use>
void for_each_strip(const StripPair& pair, Use&& use) {
    if (pair.front >= 0) use(pair.front);
    if (pair.back >= 0 && pair.back != pair.front) use(pair.back);
}

/// The borders of every component as closed chains of points, the printed side on their left.
std::vector<std::vector<Polyline>> border_loops(const PrintMesh& layout, const MeshEdges& edges,
                                                int components) {
    std::vector<std::multimap<int, int>> next(components);  // per component: from vertex to vertex
    for (const Edge& edge : edges.edges) {
        for (int k = 0; k < 2; ++k) {
            if (edge.triangle[k] < 0) continue;
            const int beyond = edge.triangle[1 - k];
            const StripPair other = beyond < 0 ? StripPair{} : layout.strip[beyond];
            for_each_strip(layout.strip[edge.triangle[k]], [&](int own) {
                if (!other.has(own)) next[own].emplace(edge.vertex[k], edge.vertex[1 - k]);
            });
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
        const double length =
            (layout.mesh.vertices[edge.vertex[0]] - layout.mesh.vertices[edge.vertex[1]]).norm();
        for_each_strip(layout.strip[edge.triangle[0]], [&](int c) {
            sum[c] += length;
            ++count[c];
        });
    }
    for (int c = 0; c < components; ++c) sum[c] /= std::max(count[c], 1);
    return sum;
}

}  // namespace

int main_strip(const PrintMesh& layout, int triangle) {
    const StripPair& pair = layout.strip[triangle];
    if (pair.front < 0 || pair.back < 0) return std::max(pair.front, pair.back);
    const Print& print = layout.print[triangle];
    return print.back > print.front ? pair.back : pair.front;
}

void find_strips(PrintMesh& layout, const std::vector<StripPair>& number,
                 const std::map<int, std::string>& names) {
    const MeshEdges edges = find_edges(layout.mesh);
    const std::vector<int> given = number_strips(layout, edges, number);
    const int count = static_cast<int>(given.size());
    const std::vector<std::vector<Polyline>> loops = border_loops(layout, edges, count);
    const std::vector<double> sizes = element_sizes(layout, edges, count);
    layout.strips.assign(count, {});
    for (int t = layout.mesh.triangle_count() - 1; t >= 0; --t) {
        const Print& print = layout.print[t];
        const StripPair& pair = layout.strip[t];
        for_each_strip(pair, [&](int c) {
            const bool both = pair.front == c && pair.back == c;
            const bool back = both ? print.back > print.front : pair.back == c;
            const Side side = back ? Side::back : Side::front;
            layout.strips[c].side = side;
            layout.strips[c].thickness = print_on(print, side).first;
        });
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
                const auto at = locator.find(x, sizes[c], [&](int t) { return layout.strip[t].has(c); });
                if (at) points.push_back(*at);
            }
            if (points.size() >= 2) strip.centreline.push_back(std::move(points));
        }
    }
}

}  // namespace ruche

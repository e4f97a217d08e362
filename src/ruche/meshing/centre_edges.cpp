#include "ruche/meshing/centre_edges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ruche/core/error.hpp"
#include "ruche/geometry/polyline.hpp"
#include "ruche/meshing/point_locator.hpp"

namespace ruche {
namespace {

constexpr double on_line = 1e-5;  // mm: the mesh's points lie on a grid of 1e-6 mm

/// How far from p in the unit direction d the first border of the region is, if at most `reach`.
std::optional<double> distance_to_border(const Region& region, const Vec2& p, const Vec2& d, double reach) {
    std::optional<double> nearest;
    const auto loop = [&](const Polyline& points) {
        for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
            const Vec2 from = points[j] - p;
            const Vec2 along = points[i] - points[j];
            const double divisor = d.x() * along.y() - d.y() * along.x();
            const double t = (from.x() * along.y() - from.y() * along.x()) / divisor;
            const double s = (from.x() * d.y() - from.y() * d.x()) / divisor;
            if (t >= 0.0 && t <= reach && s >= 0.0 && s <= 1.0 && t < nearest.value_or(infinity)) nearest = t;
        }
    };
    for (const Polygon& polygon : region) {
        loop(polygon.outer);
        for (const Polyline& hole : polygon.holes) loop(hole);
    }
    return nearest;
}

/// A gap between a line's end and the border would only be filled with tiny triangles.
void close_gap(Polyline& line, bool at_end, const Region& region, double reach) {
    Vec2& end = at_end ? line.back() : line.front();
    const Vec2& before = at_end ? line[line.size() - 2] : line[1];
    const Vec2 direction = (end - before).normalized();
    if (const auto gap = distance_to_border(region, end, direction, reach)) end += *gap * direction;
}

double width_at(const Region& region, const Vec2& p) {
    for (const Polygon& polygon : region) {
        if (contains({polygon}, p)) return strip_width(polygon);
    }
    return strip_width(region.front());
}

/// How far along a line a point on it lies; nothing when it is beside it.
std::optional<double> place_on(const Polyline& line, const Vec2& p) {
    double before = 0.0;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const double length = (line[k + 1] - line[k]).norm();
        if (distance_to_segment(p, line[k], line[k + 1]) <= on_line) {
            const double t = (p - line[k]).dot(line[k + 1] - line[k]) / length;
            return before + std::clamp(t, 0.0, length);
        }
        before += length;
    }
    return std::nullopt;
}

std::vector<std::vector<int>> neighbours(const TriangleMesh& mesh) {
    std::vector<std::vector<int>> found(mesh.vertices.size());
    for (const Edge& edge : find_edges(mesh).edges) {
        found[edge.vertex[0]].push_back(edge.vertex[1]);
        found[edge.vertex[1]].push_back(edge.vertex[0]);
    }
    return found;
}

/// From vertex to vertex along a line; stops where no edge goes on.
std::vector<int> walk(const TriangleMesh& mesh, const std::vector<std::vector<int>>& next, int start,
                      const Polyline& line) {
    std::vector<int> way = {start};
    double at = 0.0;
    while (true) {
        int best = -1;
        double nearest = infinity;
        for (const int v : next[way.back()]) {
            const std::optional<double> place = place_on(line, mesh.vertices[v]);
            if (place && *place > at + on_line && *place < nearest) {
                nearest = *place;
                best = v;
            }
        }
        if (best < 0) break;
        way.push_back(best);
        at = nearest;
    }
    const bool closed = (line.front() - line.back()).norm() <= on_line;
    if (closed && way.size() > 2 && std::ranges::count(next[way.back()], start) > 0) way.push_back(start);
    return way;
}

}  // namespace

void CentreEdges::add(const Strip& strip, const std::vector<Polyline>& lines, const SizeField& sizes) {
    const int number = strip_count_++;
    const std::size_t before = lines_.size();
    for (const Polyline& drawn : lines) {
        if (drawn.size() < 2 || !(length(drawn) > 0.0)) continue;
        const double size = sizes.at(drawn.front());
        Polyline line = simplify(drawn, false, 0.02 * size);
        if ((line.front() - line.back()).norm() > on_line) {
            for (const bool at_end : {false, true}) close_gap(line, at_end, strip.region, 0.1 * size);
        }
        widths_.push_back(width_at(strip.region, line[line.size() / 2]));
        lines_.push_back(std::move(line));
        strips_.push_back(number);
    }
    if (lines_.size() > before) return;
    throw InputError({.key = "model.strips"},
                     fmt::format("strip '{}' has no centre line to be a rod", strip.id),
                     "Draw it as a line with a width, or choose model.strips = \"shell\".");
}

void CentreEdges::find(PrintMesh& layout) const {
    if (lines_.empty()) return;
    const PointLocator locator(layout.mesh);
    const std::vector<std::vector<int>> next = neighbours(layout.mesh);
    for (std::size_t k = 0; k < lines_.size(); ++k) {
        const Polyline& line = lines_[k];
        MeshedStrip& strip = layout.strips[strips_[k]];
        std::vector<int> way;
        if (const std::optional<MeshPoint> at = locator.find(line.front(), on_line)) {
            const int corner = static_cast<int>(std::max_element(at->weights, at->weights + 3) - at->weights);
            way = walk(layout.mesh, next, layout.mesh.triangles[at->triangle][corner], line);
        }
        double reached = 0.0;
        for (std::size_t i = 0; i + 1 < way.size(); ++i)
            reached += (layout.mesh.vertices[way[i + 1]] - layout.mesh.vertices[way[i]]).norm();
        if (std::abs(reached - length(line)) > 1e-3 * length(line)) {
            throw InputError(
                {.key = "model.strips"},
                fmt::format("the centre line of strip '{}' near x = {:.4g}, y = {:.4g} mm cannot be followed "
                            "by edges of the mesh",
                            strip.id, line.front().x(), line.front().y()),
                "It may leave the fabric or cross itself there; choose model.strips = \"shell\".");
        }
        strip.edge_lines.push_back({std::move(way), widths_[k]});
    }
}

}  // namespace ruche

#include "ruche/geometry/border_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <unordered_map>

#include "ruche/core/error.hpp"
#include "ruche/geometry/polyline.hpp"

namespace ruche {

namespace {

using Segment = BorderGraph::Segment;

constexpr double smallest_snap = 2e-6;
constexpr int most_passes = 60;

Vec2 rounded_to_grid(const Vec2& p) {
    return {std::round(p.x() * grid_per_mm) / grid_per_mm, std::round(p.y() * grid_per_mm) / grid_per_mm};
}

std::vector<int> odd_of_both(const std::vector<int>& a, const std::vector<int>& b) {
    std::vector<int> result;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

// Drops points that no segment uses and adds up segments between the same two points (modulo 2).
void compact(BorderGraph& graph) {
    std::vector<int> number(graph.points.size(), -1);
    std::map<std::array<int, 2>, std::size_t> known;
    std::vector<Segment> merged;
    for (Segment& s : graph.segments) {
        if (s.point[0] == s.point[1] || s.regions.empty()) continue;
        const std::array<int, 2> key = {std::min(s.point[0], s.point[1]), std::max(s.point[0], s.point[1])};
        const auto [entry, is_new] = known.try_emplace(key, merged.size());
        if (is_new) {
            merged.push_back(std::move(s));
        } else {
            Segment& same = merged[entry->second];
            same.regions = odd_of_both(same.regions, s.regions);
        }
    }
    std::erase_if(merged, [](const Segment& s) { return s.regions.empty(); });
    std::vector<Vec2> points;
    for (Segment& s : merged) {
        for (int& p : s.point) {
            if (number[p] < 0) {
                number[p] = static_cast<int>(points.size());
                points.push_back(graph.points[p]);
            }
            p = number[p];
        }
    }
    graph.points = std::move(points);
    graph.segments = std::move(merged);
}

// Points within `snap` of an earlier one become that one. Returns whether there were any.
bool merge_points(BorderGraph& graph, double snap) {
    const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / snap)); };
    const auto key = [](std::int64_t i, std::int64_t j) {
        return static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL + static_cast<std::uint64_t>(j);
    };
    std::unordered_multimap<std::uint64_t, int> kept;
    kept.reserve(graph.points.size());
    std::vector<int> target(graph.points.size());
    bool any = false;
    for (int p = 0; p < static_cast<int>(graph.points.size()); ++p) {
        const Vec2& at = graph.points[p];
        int nearest = -1;
        double distance = snap;
        for (std::int64_t i = cell(at.x()) - 1; i <= cell(at.x()) + 1; ++i) {
            for (std::int64_t j = cell(at.y()) - 1; j <= cell(at.y()) + 1; ++j) {
                const auto [first, last] = kept.equal_range(key(i, j));
                for (auto entry = first; entry != last; ++entry) {
                    const int q = entry->second;
                    const double d = (graph.points[q] - at).norm();
                    // The order in a hash table means nothing: ties go to the smaller number.
                    if (d < distance || (d == distance && (nearest < 0 || q < nearest))) {
                        distance = d;
                        nearest = q;
                    }
                }
            }
        }
        target[p] = nearest < 0 ? p : nearest;
        any = any || nearest >= 0;
        if (nearest < 0) kept.emplace(key(cell(at.x()), cell(at.y())), p);
    }
    if (any) {
        for (Segment& s : graph.segments) s.point = {target[s.point[0]], target[s.point[1]]};
        compact(graph);
    }
    return any;
}

// Calls visit(i, j) once for all pairs of segments whose boxes, widened by `reach`, overlap.
template <class Visit>
void for_near_pairs(const BorderGraph& graph, double reach, const Visit& visit) {
    struct Box {
        double x0, x1, y0, y1;
        int segment;
    };
    std::vector<Box> boxes;
    boxes.reserve(graph.segments.size());
    for (std::size_t i = 0; i < graph.segments.size(); ++i) {
        const Vec2& a = graph.points[graph.segments[i].point[0]];
        const Vec2& b = graph.points[graph.segments[i].point[1]];
        boxes.push_back({std::min(a.x(), b.x()) - reach, std::max(a.x(), b.x()) + reach,
                         std::min(a.y(), b.y()) - reach, std::max(a.y(), b.y()) + reach,
                         static_cast<int>(i)});
    }
    std::stable_sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.x0 < b.x0; });
    std::vector<Box> active;
    for (const Box& box : boxes) {
        std::erase_if(active, [&](const Box& old) { return old.x1 < box.x0; });
        for (const Box& old : active) {
            if (old.y0 <= box.y1 && box.y0 <= old.y1) visit(old.segment, box.segment);
        }
        active.push_back(box);
    }
}

struct Cut {
    double along;
    int point;
    bool operator<(const Cut& other) const {
        return along != other.along ? along < other.along : point < other.point;
    }
    bool operator==(const Cut& other) const { return point == other.point; }
};

/// One pass of splitting: segments at points that lie on them, and at crossings.
class Splitter {
  public:
    Splitter(BorderGraph& graph, double snap) : graph_(graph), snap_(snap), cuts_(graph.segments.size()) {}

    bool run() {
        for_near_pairs(graph_, 0.5 * snap_, [&](int i, int j) {
            const bool touched_i = cut_at_ends(i, j);
            const bool touched_j = cut_at_ends(j, i);
            if (!touched_i && !touched_j) cut_at_crossing(i, j);
        });
        return apply();
    }

  private:
    const Vec2& point(int segment, int end) const {
        return graph_.points[graph_.segments[segment].point[end]];
    }
    bool is_end(int segment, int p) const {
        return graph_.segments[segment].point[0] == p || graph_.segments[segment].point[1] == p;
    }

    // Splits segment i at the ends of j that lie on it.
    bool cut_at_ends(int i, int j) {
        bool any = false;
        for (const int p : graph_.segments[j].point) {
            if (is_end(i, p)) continue;
            const Vec2& at = graph_.points[p];
            if (distance_to_segment(at, point(i, 0), point(i, 1)) > snap_) continue;
            cuts_[i].push_back({(at - point(i, 0)).dot(point(i, 1) - point(i, 0)), p});
            any = true;
        }
        return any;
    }

    // After cut_at_ends no end is close to the other segment: the signs below are beyond rounding.
    void cut_at_crossing(int i, int j) {
        if (is_end(i, graph_.segments[j].point[0]) || is_end(i, graph_.segments[j].point[1])) return;
        const Vec2 a = point(i, 0);
        const Vec2 c = point(j, 0);
        const Vec2 along_i = point(i, 1) - a;
        const Vec2 along_j = point(j, 1) - c;
        if (cross(along_i, c - a) * cross(along_i, c + along_j - a) >= 0.0) return;
        if (cross(along_j, a - c) * cross(along_j, a + along_i - c) >= 0.0) return;
        const double t = cross(c - a, along_j) / cross(along_i, along_j);
        const Vec2 at = rounded_to_grid(a + t * along_i);
        const int p = static_cast<int>(graph_.points.size());
        graph_.points.push_back(at);
        cuts_[i].push_back({(at - a).dot(along_i), p});
        cuts_[j].push_back({(at - c).dot(along_j), p});
    }

    bool apply() {
        bool any = false;
        std::vector<Segment> split;
        split.reserve(graph_.segments.size());
        for (std::size_t i = 0; i < cuts_.size(); ++i) {
            std::vector<Cut>& cuts = cuts_[i];
            const Segment segment = graph_.segments[i];
            std::sort(cuts.begin(), cuts.end());
            cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
            any = any || !cuts.empty();
            int from = segment.point[0];
            for (const Cut& cut : cuts) {
                split.push_back({{from, cut.point}, segment.regions});
                from = cut.point;
            }
            split.push_back({{from, segment.point[1]}, segment.regions});
        }
        graph_.segments = std::move(split);
        if (any) compact(graph_);
        return any;
    }

    BorderGraph& graph_;
    double snap_;
    std::vector<std::vector<Cut>> cuts_;
};

// Merges and splits until nothing changes any more ("iterated snap rounding", Halperin and Packer 2002, with
// a tolerance instead of pixels).
void snap_together(BorderGraph& graph, double snap) {
    compact(graph);
    for (int pass = 0; pass < most_passes; ++pass) {
        const bool merged = merge_points(graph, snap);
        const bool split = Splitter(graph, snap).run();
        if (!merged && !split) return;
    }
    throw InputError({}, "the borders of the drawing are entangled and cannot be told apart",
                     fmt::format("Look for many lines closer than {} mm to each other.", snap));
}

void append_loop(BorderGraph& graph, const Polyline& loop, int region) {
    const int first = static_cast<int>(graph.points.size());
    const int count = static_cast<int>(loop.size());
    for (const Vec2& p : loop) graph.points.push_back(rounded_to_grid(p));
    for (int i = 0; i < count; ++i)
        graph.segments.push_back({{first + i, first + (i + 1) % count}, {region}});
}

void append_line(BorderGraph& graph, const Polyline& line, int number) {
    const int first = static_cast<int>(graph.points.size());
    for (const Vec2& p : line) graph.points.push_back(rounded_to_grid(p));
    for (int i = 0; i + 1 < static_cast<int>(line.size()); ++i)
        graph.segments.push_back({{first + i, first + i + 1}, {number}});
}

std::vector<std::vector<int>> segments_at_points(const BorderGraph& graph) {
    std::vector<std::vector<int>> at(graph.points.size());
    for (int i = 0; i < static_cast<int>(graph.segments.size()); ++i) {
        for (const int p : graph.segments[i].point) at[p].push_back(i);
    }
    return at;
}

/// A run of segments between two junctions (or around a loop without any): its points in order.
struct Chain {
    std::vector<int> points;
    std::vector<int> regions;
    bool closed = false;
};

std::vector<Chain> chains_of(const BorderGraph& graph) {
    const std::vector<std::vector<int>> at = segments_at_points(graph);
    const auto junction = [&](int p) {
        return at[p].size() != 2 || graph.segments[at[p][0]].regions != graph.segments[at[p][1]].regions;
    };
    std::vector<char> used(graph.segments.size(), 0);
    const auto follow = [&](int start, int segment) {
        Chain chain{{start}, graph.segments[segment].regions, false};
        int p = start;
        while (true) {
            used[segment] = 1;
            const std::array<int, 2>& ends = graph.segments[segment].point;
            p = ends[0] == p ? ends[1] : ends[0];
            if (p == start && !junction(p)) {
                chain.closed = true;
                return chain;
            }
            chain.points.push_back(p);
            if (junction(p)) return chain;
            segment = at[p][0] == segment ? at[p][1] : at[p][0];
        }
    };
    std::vector<Chain> chains;
    for (const bool from_junctions : {true, false}) {
        for (int p = 0; p < static_cast<int>(graph.points.size()); ++p) {
            if (junction(p) != from_junctions) continue;
            for (const int segment : at[p]) {
                if (!used[segment]) chains.push_back(follow(p, segment));
            }
        }
    }
    return chains;
}

// Largest distance of the points of `fine` from the chain `coarse`, a subsequence that begins with the same.
double largest_gap(const Polyline& fine, const Polyline& coarse, bool closed) {
    double largest = 0.0;
    std::size_t next = 1;
    for (std::size_t i = 1; i < fine.size(); ++i) {
        const bool last = next >= coarse.size();
        if (last && !closed) break;
        const Vec2& end = last ? coarse.front() : coarse[next];
        if (!last && fine[i] == end) {
            ++next;
        } else {
            largest = std::max(largest, distance_to_segment(fine[i], coarse[next - 1], end));
        }
    }
    return largest;
}

}  // namespace

BorderGraph border_graph(std::span<const Region> regions, double snap, std::span<const Polyline> lines) {
    BorderGraph graph;
    for (int r = 0; r < static_cast<int>(regions.size()); ++r) {
        for (const Polygon& polygon : regions[r]) {
            append_loop(graph, polygon.outer, r);
            for (const Polyline& hole : polygon.holes) append_loop(graph, hole, r);
        }
    }
    for (int k = 0; k < static_cast<int>(lines.size()); ++k)
        append_line(graph, lines[k], static_cast<int>(regions.size()) + k);
    snap_together(graph, std::max(snap, smallest_snap));
    return graph;
}

std::vector<double> simplify_borders(BorderGraph& graph, std::span<const double> tolerance, double snap) {
    BorderGraph result;
    result.points = graph.points;
    std::vector<double> largest(tolerance.size(), 0.0);
    for (const Chain& chain : chains_of(graph)) {
        double within = std::numeric_limits<double>::infinity();
        for (const int r : chain.regions) within = std::min(within, tolerance[r]);
        Polyline line;
        for (const int p : chain.points) line.push_back(graph.points[p]);
        const Polyline kept = simplify(line, chain.closed, within);
        std::vector<int> points;
        if (chain.closed && kept.size() < 3) {
            points = chain.points;  // smaller than the tolerance: stays as it is
        } else {
            const double gap = largest_gap(line, kept, chain.closed);
            for (const int r : chain.regions) largest[r] = std::max(largest[r], gap);
            for (std::size_t i = 0, k = 0; i < line.size() && k < kept.size(); ++i) {
                if (line[i] == kept[k]) {
                    points.push_back(chain.points[i]);
                    ++k;
                }
            }
        }
        for (std::size_t i = 1; i < points.size(); ++i) {
            result.segments.push_back({{points[i - 1], points[i]}, chain.regions});
        }
        if (chain.closed) result.segments.push_back({{points.back(), points.front()}, chain.regions});
    }
    snap_together(result, std::max(snap, smallest_snap));
    graph = std::move(result);
    return largest;
}

Region region_of(const BorderGraph& graph, int r) {
    std::vector<std::vector<int>> at(graph.points.size());
    std::vector<int> own;
    for (int i = 0; i < static_cast<int>(graph.segments.size()); ++i) {
        const Segment& s = graph.segments[i];
        if (!std::binary_search(s.regions.begin(), s.regions.end(), r)) continue;
        own.push_back(i);
        for (const int p : s.point) at[p].push_back(i);
    }
    // An even number of the region's segments meets at every point: each walk returns to its start.
    std::vector<char> used(graph.segments.size(), 0);
    std::vector<Polyline> loops;
    for (const int start : own) {
        if (used[start]) continue;
        Polyline loop;
        int segment = start;
        int p = graph.segments[start].point[0];
        while (segment >= 0) {
            used[segment] = 1;
            loop.push_back(graph.points[p]);
            const std::array<int, 2>& ends = graph.segments[segment].point;
            p = ends[0] == p ? ends[1] : ends[0];
            const auto next = std::find_if(at[p].begin(), at[p].end(), [&](int s) { return !used[s]; });
            segment = next == at[p].end() ? -1 : *next;
        }
        loops.push_back(std::move(loop));
    }
    return region_from_loops(loops, FillRule::evenodd);
}

}  // namespace ruche

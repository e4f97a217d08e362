#include "ruche/meshing/branched_midlines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "ruche/geometry/polyline.hpp"
#include "ruche/meshing/triangulate.hpp"
#include "ruche/pattern/centreline.hpp"

namespace ruche {
namespace {

constexpr double border_spacing = 0.25;  // of the strip's width
constexpr double shortest_branch = 2.0;  // radii of the junction's disc: what is shorter is a corner
constexpr double nearby = 1.5;           // radii: junctions so close are one
constexpr double junction_reach = 1.2;   // radii: so far the axis bends towards a junction
constexpr double end_reach = 1.8;        // half widths: so far it bends towards a corner at an end
constexpr double straight_on = 0.94;     // cosine of 20 degrees
constexpr std::size_t most_points = 20000;

/// The border's points, `spacing` apart at most, and its segments.
SegmentGraph border_of(const Polygon& polygon, double spacing) {
    SegmentGraph graph;
    const auto add = [&](const Polyline& loop) {
        const int first = static_cast<int>(graph.points.size());
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2& a = loop[i];
            const Vec2& b = loop[(i + 1) % loop.size()];
            const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
            for (int k = 0; k < pieces; ++k) graph.points.emplace_back(a + (b - a) * k / pieces);
        }
        const int end = static_cast<int>(graph.points.size());
        for (int i = first; i < end; ++i) graph.segments.push_back({i, i + 1 < end ? i + 1 : first});
    };
    add(polygon.outer);
    for (const Polyline& hole : polygon.holes) add(hole);
    graph.outline.assign(graph.segments.size(), true);
    return graph;
}

/// Where branches end: a junction (more than two of them) or a tip (one).
struct MidlineNode {
    Vec2 place;
    double radius = 0.0;  ///< of the largest disc inside that lies here
    int degree = 0;
};

/// A chain of midpoints of edges from one node to another.
struct Branch {
    std::array<int, 2> nodes = {-1, -1};
    Polyline points;
    double half_width = 0.0;  ///< median of half the lengths of the edges

    double reach(const std::vector<MidlineNode>& all) const {
        return length(points) + (points.front() - all[nodes[0]].place).norm() +
               (points.back() - all[nodes[1]].place).norm();
    }
    void reverse() {
        std::swap(nodes[0], nodes[1]);
        std::ranges::reverse(points);
    }
};

struct Skeleton {
    std::vector<MidlineNode> nodes;
    std::vector<Branch> branches;
};

/// Walks over the triangles from node to node.
class Walker {
  public:
    explicit Walker(const TriangleMesh& mesh)
        : mesh_(mesh), edges_(find_edges(mesh)), node_of_(mesh.triangles.size(), -1) {}

    Skeleton run() {
        for (int t = 0; t < mesh_.triangle_count(); ++t) {
            if (ways(t).size() == 2) continue;
            node_of_[t] = static_cast<int>(skeleton_.nodes.size());
            skeleton_.nodes.push_back(node_at(t));
        }
        for (int t = 0; t < mesh_.triangle_count(); ++t) {
            if (node_of_[t] < 0) continue;
            for (const int e : ways(t)) follow(t, e);
        }
        return std::move(skeleton_);
    }

  private:
    MidlineNode node_at(int t) const {
        const Triangle& tri = mesh_.triangles[t];
        const Vec2& a = mesh_.vertices[tri[0]];
        const Vec2& b = mesh_.vertices[tri[1]];
        const Vec2& c = mesh_.vertices[tri[2]];
        const double circumradius =
            (b - c).norm() * (c - a).norm() * (a - b).norm() / (4.0 * layout_area(mesh_, t));
        return {
            .place = (a + b + c) / 3.0, .radius = circumradius, .degree = static_cast<int>(ways(t).size())};
    }

    /// The edges of a triangle that lead on.
    std::vector<int> ways(int t) const {
        std::vector<int> found;
        for (const int e : edges_.of_triangle[t])
            if (!edges_.edges[e].on_boundary()) found.push_back(e);
        return found;
    }

    void follow(int t, int e) {
        Branch branch;
        branch.nodes[0] = node_of_[t];
        const int first = e;
        std::vector<double> half_widths;
        while (true) {
            const Edge& crossed = edges_.edges[e];
            const Vec2& a = mesh_.vertices[crossed.vertex[0]];
            const Vec2& b = mesh_.vertices[crossed.vertex[1]];
            branch.points.emplace_back(0.5 * (a + b));
            half_widths.push_back(0.5 * (b - a).norm());
            t = crossed.triangle[0] == t ? crossed.triangle[1] : crossed.triangle[0];
            if (node_of_[t] >= 0) break;
            const std::vector<int> on = ways(t);
            e = on[0] == e ? on[1] : on[0];
        }
        branch.nodes[1] = node_of_[t];
        // Each branch is found from both of its ends.
        if (std::pair(branch.nodes[1], e) < std::pair(branch.nodes[0], first)) return;
        const auto middle = half_widths.begin() + static_cast<std::ptrdiff_t>(half_widths.size() / 2);
        std::ranges::nth_element(half_widths, middle);
        branch.half_width = *middle;
        skeleton_.branches.push_back(std::move(branch));
    }

    const TriangleMesh& mesh_;
    MeshEdges edges_;
    std::vector<int> node_of_;
    Skeleton skeleton_;
};

/// Two branches that meet where nothing else does become one.
void unite_at(Skeleton& s, int node) {
    const auto ends_here = [&](const Branch& b) { return b.nodes[0] == node || b.nodes[1] == node; };
    const auto first = std::ranges::find_if(s.branches, ends_here);
    if (first == s.branches.end()) return;
    const auto second = std::find_if(first + 1, s.branches.end(), ends_here);
    if (second == s.branches.end()) return;  // one branch that is a loop
    if (first->nodes[1] != node) first->reverse();
    if (second->nodes[0] != node) second->reverse();
    first->nodes[1] = second->nodes[1];
    if (second->points.size() > first->points.size()) first->half_width = second->half_width;
    first->points.insert(first->points.end(), second->points.begin(), second->points.end());
    s.branches.erase(second);
}

/// Takes away the shortest branch that is only a corner. Returns whether there was one.
bool prune(Skeleton& s) {
    auto shortest = s.branches.end();
    double smallest = 0.0;
    for (auto branch = s.branches.begin(); branch != s.branches.end(); ++branch) {
        for (const int k : {0, 1}) {
            const MidlineNode& tip = s.nodes[branch->nodes[1 - k]];
            const MidlineNode& junction = s.nodes[branch->nodes[k]];
            if (tip.degree != 1 || junction.degree < 3) continue;
            const double reach = branch->reach(s.nodes);
            if (reach > shortest_branch * junction.radius) continue;
            if (shortest != s.branches.end() && reach >= smallest) continue;
            shortest = branch;
            smallest = reach;
        }
    }
    if (shortest == s.branches.end()) return false;
    const std::array<int, 2> nodes = shortest->nodes;
    s.branches.erase(shortest);
    for (const int node : nodes)
        if (--s.nodes[node].degree == 2) unite_at(s, node);
    return true;
}

/// Where four arms meet there are two junctions side by side.
void unite_near_junctions(Skeleton& s) {
    const auto is_gap = [&](const Branch& b) {
        const MidlineNode& one = s.nodes[b.nodes[0]];
        const MidlineNode& other = s.nodes[b.nodes[1]];
        return b.nodes[0] != b.nodes[1] && one.degree > 2 && other.degree > 2 &&
               b.reach(s.nodes) <= nearby * std::max(one.radius, other.radius);
    };
    for (auto gap = std::ranges::find_if(s.branches, is_gap); gap != s.branches.end();
         gap = std::ranges::find_if(s.branches, is_gap)) {
        const auto [kept, gone] = gap->nodes;
        s.branches.erase(gap);
        for (Branch& branch : s.branches) std::ranges::replace(branch.nodes, gone, kept);
        MidlineNode& node = s.nodes[kept];
        const MidlineNode& other = s.nodes[gone];
        // Weighted by the number of junctions that each stands for.
        const double own = node.degree - 2.0, its = other.degree - 2.0;
        node.place = (own * node.place + its * other.place) / (own + its);
        node.radius = std::max(node.radius, other.radius);
        node.degree += other.degree - 2;
    }
}

/// Where a line heads at its last point, over a length of at least `over` if it is as long: single steps are
/// noisy.
Vec2 heading(const Polyline& points, double over) {
    std::size_t i = points.size() - 1;
    while (i > 0 && (points.back() - points[i]).norm() < over) --i;
    return points.size() > 1 ? Vec2((points.back() - points[i]).normalized()) : Vec2::Zero();
}

/// Takes away what bends towards a junction or a corner, and lets a tip go on beyond the border: who cuts the
/// line to the region finds its end.
void straighten_last(Branch& branch, const MidlineNode& node) {
    const bool tip = node.degree == 1;
    const Vec2 from = tip ? branch.points.back() : node.place;
    const double bent = tip ? end_reach * branch.half_width : junction_reach * node.radius;
    while (branch.points.size() > 2 && (branch.points.back() - from).norm() < bent) branch.points.pop_back();
    if (!tip) return;
    const Vec2 ahead = heading(branch.points, branch.half_width);
    branch.points.emplace_back(branch.points.back() + (bent + branch.half_width) * ahead);
}

/// Numbers of ends: 2 b for the first, 2 b + 1 for the last of branch b.
class Lines {
  public:
    explicit Lines(Skeleton skeleton) : s_(std::move(skeleton)), partner_(2 * s_.branches.size(), -1) {
        for (Branch& branch : s_.branches) {
            for (int k = 0; k < 2; ++k) {
                branch.reverse();
                straighten_last(branch, s_.nodes[branch.nodes[1]]);
            }
        }
        for (int end = 0; end < end_count(); ++end) ahead_.push_back(heading_at(end));
        pair_ends();
    }

    std::vector<Polyline> run() {
        std::vector<Polyline> lines;
        std::vector<bool> done(s_.branches.size(), false);
        // From free ends first; what is left are loops.
        for (const bool loops : {false, true}) {
            for (int end = 0; end < end_count(); ++end) {
                if (done[end / 2] || (!loops && partner_[end] >= 0)) continue;
                lines.push_back(line_from(end, done));
            }
        }
        return lines;
    }

  private:
    int end_count() const { return static_cast<int>(partner_.size()); }
    const MidlineNode& node(int end) const { return s_.nodes[s_.branches[end / 2].nodes[end % 2]]; }
    Polyline points_up_to(int end) const {
        Polyline points = s_.branches[end / 2].points;
        if (end % 2 == 0) std::ranges::reverse(points);
        return points;
    }
    Vec2 heading_at(int end) const { return heading(points_up_to(end), s_.branches[end / 2].half_width); }

    /// Ends at one junction that go on in each other, the straightest first.
    void pair_ends() {
        std::vector<std::tuple<double, int, int>> pairs;
        for (int i = 0; i < end_count(); ++i) {
            for (int j = i + 1; j < end_count(); ++j) {
                if (&node(i) != &node(j)) continue;
                const double fit = -ahead_[i].dot(ahead_[j]);
                if (fit > straight_on) pairs.emplace_back(-fit, i, j);
            }
        }
        std::ranges::sort(pairs);
        for (const auto& [fit, i, j] : pairs) {
            if (partner_[i] >= 0 || partner_[j] >= 0) continue;
            partner_[i] = j;
            partner_[j] = i;
        }
    }

    /// Straight on to the foot of the junction's middle.
    void add_middle(int end, Polyline& line) const {
        if (node(end).degree < 3 || partner_[end] >= 0) return;
        const Vec2& last =
            s_.branches[end / 2].points[end % 2 == 0 ? 0 : s_.branches[end / 2].points.size() - 1];
        const double way = ahead_[end].dot(node(end).place - last);
        if (way > 0.0) line.emplace_back(last + way * ahead_[end]);
    }

    Polyline line_from(int end, std::vector<bool>& done) const {
        Polyline line;
        add_middle(end, line);
        while (!done[end / 2]) {
            done[end / 2] = true;
            const Polyline on = points_up_to(end ^ 1);
            line.insert(line.end(), on.begin(), on.end());
            end ^= 1;
            if (partner_[end] < 0) {
                add_middle(end, line);
                return line;
            }
            end = partner_[end];
        }
        line.push_back(line.front());  // a loop
        return line;
    }

    Skeleton s_;
    std::vector<int> partner_;
    std::vector<Vec2> ahead_;
};

}  // namespace

std::vector<Polyline> branched_midlines(const Polygon& polygon) {
    const SegmentGraph border = border_of(polygon, border_spacing * strip_width(polygon));
    if (border.points.size() > most_points) return {};
    const Triangulation triangulation = triangulate_coarsely(border);
    Skeleton skeleton = Walker(triangulation.mesh).run();
    while (prune(skeleton)) {
    }
    unite_near_junctions(skeleton);
    const bool branches = std::ranges::any_of(skeleton.branches, [&](const Branch& b) {
        return skeleton.nodes[b.nodes[0]].degree > 2 || skeleton.nodes[b.nodes[1]].degree > 2;
    });
    return branches ? Lines(std::move(skeleton)).run() : std::vector<Polyline>();
}

std::vector<Polyline> middle_lines(const Region& region) {
    std::vector<Polyline> all;
    for (const Polygon& polygon : region) {
        std::vector<Polyline> lines = branched_midlines(polygon);
        if (lines.empty()) lines.push_back(midline(polygon));
        for (Polyline& line : cut_to_region(lines, {polygon})) all.push_back(std::move(line));
    }
    return all;
}

}  // namespace ruche

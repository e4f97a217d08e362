#include "ruche/geometry/self_intersection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

__extension__ using Int128 = __int128;
using Grid = std::array<std::int64_t, 3>;

/// Positions on a grid of 2^38 steps over the shape's size: differences need 39 bits and a sign, a 3 x 3
/// determinant of them 3 * 39 + 3 bits, which 128 bits hold exactly.
class GridPositions {
  public:
    explicit GridPositions(std::span<const Vec3> positions)
        : points_(positions.size()), finite_(positions.size()) {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::max());
        Vec3 high = -low;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            finite_[i] = positions[i].allFinite() ? 1 : 0;
            if (!finite_[i]) continue;
            low = low.cwiseMin(positions[i]);
            high = high.cwiseMax(positions[i]);
        }
        const double size = std::max((high - low).maxCoeff(), 1e-300);
        const double scale = std::ldexp(1.0, 38) / size;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            if (!finite_[i]) continue;
            for (int k = 0; k < 3; ++k) points_[i][k] = std::llround((positions[i][k] - low[k]) * scale);
        }
    }

    const Grid& operator[](int vertex) const { return points_[vertex]; }
    bool finite(int vertex) const { return finite_[vertex]; }

    /// Sign of the volume of (a, b, c, d), exactly.
    int orientation(int a, int b, int c, int d) const {
        std::array<std::array<std::int64_t, 3>, 3> m;
        for (int k = 0; k < 3; ++k) {
            m[0][k] = points_[b][k] - points_[a][k];
            m[1][k] = points_[c][k] - points_[a][k];
            m[2][k] = points_[d][k] - points_[a][k];
        }
        const auto minor = [&](int i, int j) {
            return static_cast<Int128>(m[1][i]) * m[2][j] - static_cast<Int128>(m[1][j]) * m[2][i];
        };
        const Int128 det = m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1);
        return (det > 0) - (det < 0);
    }

  private:
    std::vector<Grid> points_;
    std::vector<char> finite_;
};

/// A triangle turned so that `corners[0]` is alone on its side of the other triangle's plane.
struct Straddling {
    Triangle corners;
    int side = 0;  ///< of corners[0]: +1 or -1; 0 = the triangle lies on one side, it does not straddle
};

Straddling straddling(const GridPositions& grid, const Triangle& tri, const Triangle& plane) {
    std::array<int, 3> signs;
    for (int i = 0; i < 3; ++i) {
        const bool shared = std::ranges::find(plane, tri[i]) != plane.end();
        signs[i] = shared ? 0 : grid.orientation(plane[0], plane[1], plane[2], tri[i]);
    }
    const auto above = std::ranges::count(signs, 1);
    const auto below = std::ranges::count(signs, -1);
    if (above == 0 || below == 0) return {tri, 0};
    const int side = above == 1 ? 1 : -1;
    const auto alone = std::ranges::find(signs, side) - signs.begin();
    return {{tri[alone], tri[(alone + 1) % 3], tri[(alone + 2) % 3]}, side};
}

/// Where the edges from the lone corner meet the other triangle's plane.
std::array<Vec3, 2> ends_on_plane(std::span<const Vec3> x, const Triangle& lone, const Triangle& plane) {
    const Vec3 normal = (x[plane[1]] - x[plane[0]]).cross(x[plane[2]] - x[plane[0]]);
    const double height = std::abs(normal.dot(x[lone[0]] - x[plane[0]]));
    std::array<Vec3, 2> ends;
    for (int i = 0; i < 2; ++i) {
        const double depth = std::abs(normal.dot(x[lone[i + 1]] - x[plane[0]]));
        const double t = height + depth > 0.0 ? height / (height + depth) : 0.5;
        ends[i] = (1.0 - t) * x[lone[0]] + t * x[lone[i + 1]];
    }
    return ends;
}

/// Do the insides of two triangles meet? They cut the line common to both planes in two intervals, which must
/// overlap by more than a point (Guigue and Devillers 2003, here with strict signs). `place` is set to the
/// middle of the overlap.
bool pass_through(const GridPositions& grid, std::span<const Vec3> x, const Triangle& first,
                  const Triangle& second, Vec3& place) {
    Straddling a = straddling(grid, first, second);
    if (a.side == 0) return false;
    Straddling b = straddling(grid, second, first);
    if (b.side == 0) return false;
    // Both lone corners on the positive side of the other triangle: turn the other one round where needed.
    if (a.side < 0) std::swap(b.corners[1], b.corners[2]);
    if (b.side < 0) std::swap(a.corners[1], a.corners[2]);
    const auto [p, q, r] = a.corners;
    const auto [s, t, u] = b.corners;
    if (grid.orientation(p, q, s, t) >= 0 || grid.orientation(p, r, u, s) >= 0) return false;

    const auto [a0, a1] = ends_on_plane(x, a.corners, b.corners);
    const auto [b0, b1] = ends_on_plane(x, b.corners, a.corners);
    std::array<Vec3, 4> ends = {a0, a1, b0, b1};
    const Vec3 along = a1 - a0;
    std::ranges::sort(ends, {}, [&](const Vec3& end) { return along.dot(end); });
    place = 0.5 * (ends[1] + ends[2]);
    return true;
}

struct Box {
    Grid low = {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(),
                std::numeric_limits<std::int64_t>::max()};
    Grid high = {-1, -1, -1};

    void add(const Grid& p) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    void add(const Box& box) {
        add(box.low);
        add(box.high);
    }
    bool meets(const Box& other) const {
        return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
               other.low[1] <= high[1] && low[2] <= other.high[2] && other.low[2] <= high[2];
    }
};

/// A binary tree of boxes over the triangles, split at the median of the longest side; its leaves are runs of
/// `order`.
class BoxTree {
  public:
    explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        // Triangles with a vertex that is not finite have the empty box and are left out.
        std::erase_if(order_, [&](int t) { return boxes_[t].high[0] < 0; });
        if (!order_.empty()) build(0, static_cast<int>(order_.size()));
    }

    /// Calls visit(u) for every triangle u > t whose box meets that of t.
    template <class Visit>
    void later_neighbours(int t, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::array<int, 64> stack;  // the tree is balanced: depth below 32
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (!node.box.meets(boxes_[t])) continue;
            if (node.right > 0) {
                stack[top++] = node.right;
                stack[top++] = static_cast<int>(&node - nodes_.data()) + 1;
                continue;
            }
            for (int i = node.begin; i < node.end; ++i) {
                const int u = order_[i];
                if (u > t && boxes_[u].meets(boxes_[t])) visit(u);
            }
        }
    }

    const std::vector<int>& order() const { return order_; }

  private:
    static constexpr int leaf_size = 4;

    struct Node {
        Box box;
        int right = 0;  ///< its left child follows it; 0 for a leaf
        int begin = 0;
        int end = 0;
    };

    void build(int begin, int end) {
        const int self = static_cast<int>(nodes_.size());
        Box box;
        for (int i = begin; i < end; ++i) box.add(boxes_[order_[i]]);
        nodes_.push_back({box, 0, begin, end});
        if (end - begin <= leaf_size) return;
        int axis = 0;
        for (int k = 1; k < 3; ++k) {
            if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
        }
        const auto centre = [&](int t) { return boxes_[t].low[axis] + boxes_[t].high[axis]; };
        const int middle = (begin + end) / 2;
        std::nth_element(
            order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
            [&](int s, int t) { return centre(s) != centre(t) ? centre(s) < centre(t) : s < t; });
        build(begin, middle);
        nodes_[self].right = static_cast<int>(nodes_.size());
        build(middle, end);
    }

    std::vector<Box> boxes_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

bool share_edge(const Triangle& a, const Triangle& b) {
    int shared = 0;
    for (const int v : a) shared += static_cast<int>(std::ranges::find(b, v) != b.end());
    return shared >= 2;
}

}  // namespace

std::vector<Intersection> find_self_intersections(std::span<const Vec3> positions,
                                                  std::span<const Triangle> triangles) {
    const GridPositions grid(positions);
    std::vector<Box> boxes(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!std::ranges::all_of(triangles[t], [&](int v) { return grid.finite(v); })) continue;
        for (const int v : triangles[t]) boxes[t].add(grid[v]);
    }
    const BoxTree tree(std::move(boxes));

    // Neighbours in the tree's order are neighbours in space: good for the cache, and even work per chunk.
    constexpr std::size_t chunk = 512;
    const std::vector<int>& order = tree.order();
    std::vector<std::vector<Intersection>> found((order.size() + chunk - 1) / chunk);
    parallel_for(found.size(), [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(order.size(), (c + 1) * chunk); ++i) {
            const int t = order[i];
            tree.later_neighbours(t, [&](int u) {
                if (share_edge(triangles[t], triangles[u])) return;
                Vec3 place;
                if (pass_through(grid, positions, triangles[t], triangles[u], place))
                    found[c].push_back({{t, u}, place});
            });
        }
    });
    std::vector<Intersection> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::ranges::sort(all, {}, &Intersection::triangles);
    return all;
}

}  // namespace ruche

#include "ruche/geometry/self_intersection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ruche/core/parallel.hpp"
#include "ruche/geometry/box_tree.hpp"

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

using GridBox = AxisBox<std::int64_t>;

bool share_edge(const Triangle& a, const Triangle& b) {
    int shared = 0;
    for (const int v : a) shared += static_cast<int>(std::ranges::find(b, v) != b.end());
    return shared >= 2;
}

}  // namespace

std::vector<Intersection> find_self_intersections(std::span<const Vec3> positions,
                                                  std::span<const Triangle> triangles) {
    const GridPositions grid(positions);
    std::vector<GridBox> boxes(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        // Triangles with a vertex that is not finite keep the empty box, which meets none.
        if (!std::ranges::all_of(triangles[t], [&](int v) { return grid.finite(v); })) continue;
        for (const int v : triangles[t]) boxes[t].add(grid[v]);
    }
    const BoxTree<std::int64_t> tree(std::move(boxes));

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

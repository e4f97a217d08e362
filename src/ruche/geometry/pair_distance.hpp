#pragma once

#include <Eigen/Core>
#include <array>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// Two parts of a surface and the order of their corners: a vertex and a triangle (v, a, b, c), a vertex and
/// an edge (v, a, b), two vertices (v, w), two edges (a, b, c, d). Corners that a kind does not have are
/// ignored.
enum class PairKind { vertex_triangle, vertex_edge, vertex_vertex, edge_edge };

using PairCorners = std::array<Vec3, 4>;

constexpr int corner_count(PairKind kind) {
    return kind == PairKind::vertex_vertex ? 2 : kind == PairKind::vertex_edge ? 3 : 4;
}

/// The shortest vector between two parts, r = sum_i c_i x_i with sum_i c_i = 0. `slopes` are the changes of c
/// along the directions in which the two closest points can move within their parts (`freedom` columns: 2 for
/// the inside of a triangle or of two edges, 1 for a vertex and an edge, 0 between two vertices).
struct ClosestPoints {
    Eigen::Vector4d coefficients = Eigen::Vector4d::Zero();
    Eigen::Matrix<double, 4, 2> slopes = Eigen::Matrix<double, 4, 2>::Zero();
    int freedom = 0;
};
ClosestPoints closest_points(PairKind kind, const PairCorners& x);

/// r for given closest points, mm.
Vec3 shortest_vector(const ClosestPoints& closest, const PairCorners& x);

/// Distance of two parts, mm.
double distance(PairKind kind, const PairCorners& x);

/// Derivatives of s = |r|^2 with respect to the corners (12 numbers). s is the minimum over the parameters l
/// of the closest points of phi(x, l) = |sum_i c_i(l) x_i|^2, so that
///
///     ds/dx_i       = 2 c_i r
///     d2s/dx_i dx_j = 2 c_i c_j I - 2 Q_i (J^T J)^-1 Q_j^T,   Q_i = c_i J + r (dc_i/dl)^T,   J = dr/dl
///
/// once continuously differentiable where the closest points reach a border of their part; second derivatives
/// jump there, and for two edges that become parallel.
Eigen::Matrix<double, 12, 1> squared_distance_gradient(const ClosestPoints& closest, const Vec3& r);
Eigen::Matrix<double, 12, 12> squared_distance_hessian(const ClosestPoints& closest, const Vec3& r,
                                                       const PairCorners& x);

/// How far the two parts can move on straight lines from `x` to `y` at the same time, as a fraction of the
/// way (1 = all of it), so that their distance, which is above `gap` at `x`, stays above it all the way.
/// Never too large; it ends where the distance is between 1 and 1.25 `gap`, or after 100 bounds on it
/// (additive continuous collision detection: Li, Kaufman, Jiang, Codimensional Incremental Potential Contact,
/// ACM Trans. Graph. 40, 2021).
double clear_fraction(PairKind kind, const PairCorners& x, const PairCorners& y, double gap);

}  // namespace ruche

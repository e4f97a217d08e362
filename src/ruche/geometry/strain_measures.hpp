#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "ruche/geometry/vectors.hpp"

/// The two strain measures that every energy is a function of, with exact first and second derivatives:
/// squared edge lengths and signed dihedral angles.
namespace ruche {

/// Position of the corners of a triangle, counter-clockwise seen from the front.
using Corners = std::array<Vec3, 3>;

/// L_i = squared length of edge i, which lies opposite corner i. Its derivative with respect to corner i+1 is
/// 2 (v_{i+1} - v_{i+2}), to corner i+2 the negative; its second derivative is 2 I on the diagonal blocks of
/// the two corners and -2 I between them.
inline Vec3 squared_edge_lengths(const Corners& v) {
    return {(v[2] - v[1]).squaredNorm(), (v[0] - v[2]).squaredNorm(), (v[1] - v[0]).squaredNorm()};
}

/// Green's strain of a triangle as (E11, E22, 2 E12) in the axes of its rest shape is M (L - L_rest), M
/// constant: this is M for corners at rest in the plane, counter-clockwise.
inline Mat3 green_strain_of_lengths(const std::array<Vec2, 3>& rest) {
    Mat2 edges;
    edges << rest[1] - rest[0], rest[2] - rest[0];
    const Mat2 d = edges.inverse();
    // C = d^T a d with a11 = L2, a22 = L1, a12 = (L1 + L2 - L0)/2; E = (C - I)/2.
    const auto strain_of_metric = [&](double a11, double a12, double a22) -> Vec3 {
        Mat2 a;
        a << a11, a12, a12, a22;
        const Mat2 c = d.transpose() * a * d;
        return {0.5 * c(0, 0), 0.5 * c(1, 1), c(0, 1)};
    };
    Mat3 m;
    m << strain_of_metric(0.0, -0.5, 0.0), strain_of_metric(0.0, 0.5, 1.0), strain_of_metric(1.0, 0.5, 0.0);
    return m;
}

/// The dihedral angle theta across the edge a-b of the triangles (a, b, c) and (b, a, d), both
/// counter-clockwise seen from the front, is 0 when flat and positive when d rises towards the front (a
/// valley). Its gradient and its second derivative are each a sum of two parts that live on the corners of
/// one triangle. With a triangle's corners in the order edge start, edge end, opposite corner, the gradient
/// with respect to corner i is q_i n / h, and the block of the second derivative between corner i and corner
/// j is
///
///   -[ q_i q_j (u n^T + n u^T) / h^2 + (q_i r_j e n^T + r_i q_j n e^T) / h + r_i r_j (u n^T + n u^T) / 2 ]
///
/// e: unit edge direction, n: unit normal, u = n x e, h: altitude onto the edge, t: the altitude's foot as a
/// fraction of the edge, q = (t-1, -t, 1), r = (-1, 1, 0) / |b - a|. (Derived by differentiating grad theta =
/// q_i n / h; equivalent to Tamstorf and Grinspun 2013.)
struct DihedralFrame {
    Vec3 e, n, u;
    double h = 1.0;
    Vec3 q, r;

    Vec3 gradient(int i) const { return (q[i] / h) * n; }

    /// Adds `weight` times the second derivative to the lower triangle of a matrix in which corner i has the
    /// three rows and columns from 3 slot[i] on.
    template <class Matrix>
    void add_second_derivative(double weight, const std::array<int, 3>& slot, Matrix& hessian) const {
        // The block of corners i and j is -weight (p n^T + n s^T), p = k u + l e, s = k u + m e.
        const Vec3 weighted = -weight * n;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j <= i; ++j) {
                const Vec3 along_u = (q[i] * q[j] / (h * h) + 0.5 * r[i] * r[j]) * u;
                const Vec3 p = along_u + (q[i] * r[j] / h) * e;
                const Vec3 s = along_u + (r[i] * q[j] / h) * e;
                const bool in_order = slot[i] >= slot[j];
                const Vec3& left = in_order ? p : s;
                const Vec3& right = in_order ? s : p;
                auto block = hessian.template block<3, 3>(3 * std::max(slot[i], slot[j]),
                                                          3 * std::min(slot[i], slot[j]));
                block.noalias() += left * weighted.transpose();
                block.noalias() += weighted * right.transpose();
            }
        }
    }
};

/// The frame at its edge a-b of a triangle (a, b, c) whose unit normal and area are known.
inline DihedralFrame dihedral_frame(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal,
                                    double twice_area) {
    DihedralFrame f;
    const Vec3 ab = b - a;
    const double per_length = 1.0 / ab.norm();
    f.e = per_length * ab;
    f.n = normal;
    f.u = f.n.cross(f.e);
    f.h = twice_area * per_length;
    const double t = (c - a).dot(f.e) * per_length;
    f.q = {t - 1.0, -t, 1.0};
    f.r = {-per_length, per_length, 0.0};
    return f;
}

/// The frame of triangle (a, b, c) at its edge a-b.
inline DihedralFrame dihedral_frame(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a);
    const double twice_area = normal.norm();
    return dihedral_frame(a, b, c, (1.0 / twice_area) * normal, twice_area);
}

/// theta from the frames of the two triangles at their common edge.
inline double dihedral_angle(const DihedralFrame& left, const DihedralFrame& right) {
    return std::atan2(right.n.cross(left.n).dot(left.e), left.n.dot(right.n));
}

/// tan(theta / 2) from the same, without a trigonometric function; infinite at |theta| = pi.
inline double half_angle_tangent(const DihedralFrame& left, const DihedralFrame& right) {
    return right.n.cross(left.n).dot(left.e) / (1.0 + left.n.dot(right.n));
}

}  // namespace ruche

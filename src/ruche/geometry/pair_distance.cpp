#include "ruche/geometry/pair_distance.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ruche {
namespace {

/// The point of the segment between corners `a` and `b` that is closest to corner `p`.
ClosestPoints vertex_to_edge(const PairCorners& x, int p, int a, int b) {
    const Vec3 along = x[b] - x[a];
    const double square = along.squaredNorm();
    const double t = square > 0.0 ? along.dot(x[p] - x[a]) / square : 0.0;
    ClosestPoints closest;
    closest.coefficients[p] = 1.0;
    if (t > 0.0 && t < 1.0) {
        closest.coefficients[a] = t - 1.0;
        closest.coefficients[b] = -t;
        closest.slopes(a, 0) = 1.0;
        closest.slopes(b, 0) = -1.0;
        closest.freedom = 1;
    } else {
        closest.coefficients[t > 0.0 ? b : a] = -1.0;
    }
    return closest;
}

template <std::size_t Count>
ClosestPoints nearest(const std::array<ClosestPoints, Count>& candidates, const PairCorners& x) {
    std::array<double, Count> squares;
    for (std::size_t i = 0; i < Count; ++i) squares[i] = shortest_vector(candidates[i], x).squaredNorm();
    return candidates[std::min_element(squares.begin(), squares.end()) - squares.begin()];
}

/// Minimises |r0 + u s + v t|; false when u and v are parallel to rounding.
bool minimise(const Vec3& r0, const Vec3& u, const Vec3& v, double& s, double& t) {
    const double uu = u.squaredNorm();
    const double vv = v.squaredNorm();
    const double uv = u.dot(v);
    const double det = uu * vv - uv * uv;
    constexpr double parallel = 1e-14;  // squared sine
    if (!(det > parallel * uu * vv)) return false;
    const double ru = r0.dot(u);
    const double rv = r0.dot(v);
    s = (uv * rv - vv * ru) / det;
    t = (uv * ru - uu * rv) / det;
    return true;
}

ClosestPoints vertex_to_triangle(const PairCorners& x) {
    double s = 0.0;
    double t = 0.0;
    if (minimise(x[0] - x[1], x[1] - x[2], x[1] - x[3], s, t) && s > 0.0 && t > 0.0 && s + t < 1.0) {
        ClosestPoints closest;
        closest.coefficients << 1.0, s + t - 1.0, -s, -t;
        closest.slopes << 0.0, 0.0, 1.0, 1.0, -1.0, 0.0, 0.0, -1.0;
        closest.freedom = 2;
        return closest;
    }
    return nearest<3>({vertex_to_edge(x, 0, 1, 2), vertex_to_edge(x, 0, 2, 3), vertex_to_edge(x, 0, 3, 1)},
                      x);
}

ClosestPoints edge_to_edge(const PairCorners& x) {
    double s = 0.0;
    double t = 0.0;
    if (minimise(x[0] - x[2], x[1] - x[0], x[2] - x[3], s, t) && s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
        ClosestPoints closest;
        closest.coefficients << 1.0 - s, s, t - 1.0, -t;
        closest.slopes << -1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, -1.0;
        closest.freedom = 2;
        return closest;
    }
    ClosestPoints closest = nearest<4>({vertex_to_edge(x, 0, 2, 3), vertex_to_edge(x, 1, 2, 3),
                                        vertex_to_edge(x, 2, 0, 1), vertex_to_edge(x, 3, 0, 1)},
                                       x);
    // Always from the second edge to the first.
    if (closest.coefficients.head<2>().sum() < 0.0) {
        closest.coefficients = -closest.coefficients;
        closest.slopes = -closest.slopes;
    }
    return closest;
}

}  // namespace

ClosestPoints closest_points(PairKind kind, const PairCorners& x) {
    switch (kind) {
        case PairKind::vertex_triangle:
            return vertex_to_triangle(x);
        case PairKind::vertex_edge:
            return vertex_to_edge(x, 0, 1, 2);
        case PairKind::edge_edge:
            return edge_to_edge(x);
        case PairKind::vertex_vertex:
            break;
    }
    ClosestPoints closest;
    closest.coefficients << 1.0, -1.0, 0.0, 0.0;
    return closest;
}

Vec3 shortest_vector(const ClosestPoints& closest, const PairCorners& x) {
    // Relative to one corner, so that a sheet far from the origin loses no digits.
    Vec3 r = Vec3::Zero();
    for (int i = 1; i < 4; ++i) {
        if (closest.coefficients[i] != 0.0) r += closest.coefficients[i] * (x[i] - x[0]);
    }
    return r;
}

double distance(PairKind kind, const PairCorners& x) {
    return shortest_vector(closest_points(kind, x), x).norm();
}

Eigen::Matrix<double, 12, 1> squared_distance_gradient(const ClosestPoints& closest, const Vec3& r) {
    Eigen::Matrix<double, 12, 1> gradient;
    for (int i = 0; i < 4; ++i) gradient.segment<3>(3 * i) = 2.0 * closest.coefficients[i] * r;
    return gradient;
}

Eigen::Matrix<double, 12, 12> squared_distance_hessian(const ClosestPoints& closest, const Vec3& r,
                                                       const PairCorners& x) {
    Eigen::Matrix<double, 12, 12> hessian = Eigen::Matrix<double, 12, 12>::Zero();
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const double product = 2.0 * closest.coefficients[i] * closest.coefficients[j];
            for (int c = 0; c < 3; ++c) hessian(3 * i + c, 3 * j + c) = product;
        }
    }
    if (closest.freedom == 0) return hessian;
    Eigen::Matrix<double, 3, 2> j = Eigen::Matrix<double, 3, 2>::Zero();
    for (int i = 1; i < 4; ++i) {
        for (int a = 0; a < closest.freedom; ++a) {
            if (closest.slopes(i, a) != 0.0) j.col(a) += closest.slopes(i, a) * (x[i] - x[0]);
        }
    }
    Eigen::Matrix<double, 12, 2> q;
    for (int i = 0; i < 4; ++i)
        q.middleRows<3>(3 * i) = closest.coefficients[i] * j + r * closest.slopes.row(i);
    if (closest.freedom == 1) {
        hessian.noalias() -= (2.0 / j.col(0).squaredNorm()) * q.col(0) * q.col(0).transpose();
    } else {
        const Mat2 inverse = (j.transpose() * j).inverse();
        hessian.noalias() -= 2.0 * q * inverse * q.transpose();
    }
    return hessian;
}

double clear_fraction(PairKind kind, const PairCorners& x, const PairCorners& y, double gap) {
    constexpr double step = 0.9;  // of the way that is certainly clear
    constexpr double near = 0.25;
    constexpr int most_steps = 100;
    const int corners = corner_count(kind);
    const int first = kind == PairKind::edge_edge ? 2 : 1;  // corners of the first part
    std::array<Vec3, 4> way;
    Vec3 mean = Vec3::Zero();
    for (int i = 0; i < corners; ++i) {
        way[i] = y[i] - x[i];
        mean += way[i] / corners;
    }
    // No two points of the two parts approach each other faster than this.
    double speeds[2] = {0.0, 0.0};
    for (int i = 0; i < corners; ++i) {
        double& speed = speeds[i < first ? 0 : 1];
        speed = std::max(speed, (way[i] - mean).norm());
    }
    const double speed = speeds[0] + speeds[1];
    const auto room_at = [&](double t) {
        PairCorners at = x;
        for (int i = 0; i < corners; ++i) at[i] += t * (way[i] - mean);
        return distance(kind, at) - gap;
    };
    const double room = room_at(0.0);
    if (room > speed) return 1.0;
    if (!(room > 0.0)) return 0.0;
    double t = 0.0;  // clear up to here
    double left = room;
    for (int i = 0; i < most_steps; ++i) {
        const double next = t + step * left / speed;
        if (next >= 1.0) return 1.0;
        left = room_at(next);
        if (!(left > near * gap)) return left > 0.0 ? next : t;
        t = next;
    }
    return t;
}

}  // namespace ruche

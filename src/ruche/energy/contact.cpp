#include "ruche/energy/contact.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace ruche {
namespace {

struct Scalar {
    double value = 0.0;
    double slope = 0.0;
    double curvature = 0.0;
};

/// b(u), u > 0.
Scalar barrier(double u) {
    if (u >= 1.0) return {};
    const double log = std::log(u);
    const double r = (u - 1.0) / u;
    return {-(u - 1.0) * (u - 1.0) * log, -2.0 * (u - 1.0) * log - (u - 1.0) * r,
            -2.0 * log - 4.0 * r + r * r};
}

/// m, a function of the directions u = b - a and v = d - c of two edges, with derivatives for the four
/// corners.
struct Mollifier {
    double value = 1.0;
    Eigen::Matrix<double, 12, 1> gradient = Eigen::Matrix<double, 12, 1>::Zero();
    Eigen::Matrix<double, 12, 12> hessian = Eigen::Matrix<double, 12, 12>::Zero();
};

Mollifier mollifier(const PairCorners& x, double parallel) {
    Mollifier m;
    const Vec3 u = x[1] - x[0];
    const Vec3 v = x[3] - x[2];
    const double cross = u.cross(v).squaredNorm();
    if (!(cross < parallel)) return m;
    const double c = cross / parallel;
    m.value = c * (2.0 - c);
    const double slope = 2.0 * (1.0 - c) / parallel;
    const double curvature = -2.0 / (parallel * parallel);
    // Of |u x v|^2 = u.u v.v - (u.v)^2 with respect to (u, v).
    const double uu = u.squaredNorm();
    const double vv = v.squaredNorm();
    const double uv = u.dot(v);
    Eigen::Matrix<double, 6, 1> g;
    g << 2.0 * (vv * u - uv * v), 2.0 * (uu * v - uv * u);
    Eigen::Matrix<double, 6, 6> h;
    h.topLeftCorner<3, 3>() = 2.0 * (vv * Mat3::Identity() - v * v.transpose());
    h.bottomRightCorner<3, 3>() = 2.0 * (uu * Mat3::Identity() - u * u.transpose());
    h.topRightCorner<3, 3>() = 2.0 * (2.0 * u * v.transpose() - v * u.transpose() - uv * Mat3::Identity());
    h.bottomLeftCorner<3, 3>() = h.topRightCorner<3, 3>().transpose();
    h = slope * h + curvature * g * g.transpose();
    g *= slope;
    static constexpr double sign[4] = {-1.0, 1.0, -1.0, 1.0};
    for (int i = 0; i < 4; ++i) {
        m.gradient.segment<3>(3 * i) = sign[i] * g.segment<3>(3 * (i / 2));
        for (int j = 0; j < 4; ++j)
            m.hessian.block<3, 3>(3 * i, 3 * j) = sign[i] * sign[j] * h.block<3, 3>(3 * (i / 2), 3 * (j / 2));
    }
    return m;
}

}  // namespace

PairCorners corners(const ContactPair& pair, const Unknowns& x) {
    PairCorners at = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (int i = 0; i < corner_count(pair.kind); ++i) at[i] = x.position(pair.vertices[i]);
    return at;
}

Local<12> ContactBarrier::evaluate(int element, const Unknowns& x, Order order) const {
    const ContactPair& pair = pairs_[element];
    const PairCorners at = corners(pair, x);
    const ClosestPoints closest = closest_points(pair.kind, at);
    const Vec3 r = shortest_vector(closest, at);
    const double scale = 1.0 / (pair.reach * pair.reach);
    const double u = scale * r.squaredNorm();
    Local<12> local(order);
    if (u >= 1.0) return local;
    const Scalar b = barrier(u);
    const double k = stiffness_ * pair.area;
    const Mollifier m = pair.kind == PairKind::edge_edge ? mollifier(at, pair.parallel) : Mollifier{};
    local.value = k * m.value * b.value;
    if (order == Order::value) return local;

    const Eigen::Matrix<double, 12, 1> gradient = scale * squared_distance_gradient(closest, r);
    local.gradient = (k * m.value * b.slope) * gradient + (k * b.value) * m.gradient;
    if (!order.wants_hessian()) return local;

    const double exact = order.exact_share();
    const double convex = k > 0.0 ? k : exact * k;
    local.hessian.noalias() = (convex * m.value * b.curvature) * gradient * gradient.transpose();
    if (order == Order::gauss_newton) return local;
    const double curved = exact * k;
    local.hessian += (curved * m.value * b.slope * scale) * squared_distance_hessian(closest, r, at);
    if (m.value != 1.0) {
        local.hessian.noalias() += (curved * b.slope) * gradient * m.gradient.transpose();
        local.hessian.noalias() += (curved * b.slope) * m.gradient * gradient.transpose();
        local.hessian += (curved * b.value) * m.hessian;
    }
    return local;
}

}  // namespace ruche

#include "ruche/energy/rod_edge.hpp"

#include <algorithm>
#include <cmath>

namespace ruche {
namespace {

struct Hinge {
    DihedralFrame left, right;
    double half_angle;  // theta / 2
    double phi;
};

Hinge hinge_of(const RodEdge::Element& rod, const Unknowns& x) {
    const Vec3 a = x.position(rod.vertices[0]);
    const Vec3 b = x.position(rod.vertices[1]);
    Hinge hinge{dihedral_frame(a, b, x.position(rod.vertices[2])),
                dihedral_frame(b, a, x.position(rod.vertices[3])), 0.0, 0.0};
    hinge.half_angle = 0.5 * dihedral_angle(hinge.left, hinge.right);
    hinge.phi = x.edge_unknown(rod.unknown - x.vertex_count) / rod.length;
    return hinge;
}

/// 4 k tan^2(beta / 2) and its derivatives.
struct HalfHinge {
    double value, slope, curvature;
    HalfHinge(double k, double beta) {
        const double tangent = std::tan(0.5 * beta);
        const double sec2 = 1.0 + tangent * tangent;
        value = 4.0 * k * tangent * tangent;
        slope = 4.0 * k * tangent * sec2;
        curvature = 2.0 * k * sec2 * (1.0 + 3.0 * tangent * tangent);
    }
};

}  // namespace

double RodEdge::max_fold(int element, const Unknowns& x) const {
    const Hinge hinge = hinge_of(elements_[element], x);
    return std::abs(hinge.half_angle) + std::abs(hinge.phi);
}

Local<13> RodEdge::evaluate(int element, const Unknowns& x, Order order) const {
    const Element& rod = elements_[element];
    const Vec3 d = x.position(rod.vertices[1]) - x.position(rod.vertices[0]);
    const double length2 = rod.length * rod.length;
    const double strain = 0.5 * (d.squaredNorm() / length2 - 1.0);
    const double stretching = rod.stretching_stiffness * rod.length;
    const Hinge hinge = hinge_of(rod, x);
    const HalfHinge left(rod.hinge_stiffness, hinge.half_angle - hinge.phi);
    const HalfHinge right(rod.hinge_stiffness, hinge.half_angle + hinge.phi);
    Local<13> local(order);
    local.value = 0.5 * stretching * strain * strain + left.value + right.value;
    if (order == Order::value) return local;

    // Corner order of each triangle in the element's vertices: (a, b, c) and (b, a, d).
    static constexpr std::array<int, 3> left_slot = {0, 1, 2};
    static constexpr std::array<int, 3> right_slot = {1, 0, 3};
    using Vector = Eigen::Matrix<double, 13, 1>;
    Vector strain_slope = Vector::Zero();
    strain_slope.segment<3>(0) = -d / length2;
    strain_slope.segment<3>(3) = d / length2;
    Vector half_angle = Vector::Zero();
    for (int i = 0; i < 3; ++i) {
        half_angle.segment<3>(3 * left_slot[i]) += 0.5 * hinge.left.gradient(i);
        half_angle.segment<3>(3 * right_slot[i]) += 0.5 * hinge.right.gradient(i);
    }
    Vector left_fold = half_angle;
    Vector right_fold = half_angle;
    left_fold[12] = -1.0 / rod.length;
    right_fold[12] = 1.0 / rod.length;
    local.gradient = stretching * strain * strain_slope + left.slope * left_fold + right.slope * right_fold;
    if (!order.wants_hessian()) return local;

    local.hessian = stretching * strain_slope * strain_slope.transpose() +
                    left.curvature * left_fold * left_fold.transpose() +
                    right.curvature * right_fold * right_fold.transpose();
    if (order == Order::gauss_newton) return local;
    const Mat3 geometric = order.exact_share() * stretching * strain / length2 * Mat3::Identity();
    local.hessian.block<3, 3>(0, 0) += geometric;
    local.hessian.block<3, 3>(3, 3) += geometric;
    local.hessian.block<3, 3>(3, 0) -= geometric;
    const double slope = 0.5 * order.exact_share() * (left.slope + right.slope);
    hinge.left.add_second_derivative(slope, left_slot, local.hessian);
    hinge.right.add_second_derivative(slope, right_slot, local.hessian);
    return local;
}

}  // namespace ruche

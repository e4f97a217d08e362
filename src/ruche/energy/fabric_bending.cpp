#include "ruche/energy/fabric_bending.hpp"

#include <cmath>

namespace ruche {

Local<12> FabricBending::evaluate(int element, const Unknowns& x, Order order) const {
    const Hinge& hinge = hinges_[element];
    const Vec3 a = x.position(hinge.vertices[0]);
    const Vec3 b = x.position(hinge.vertices[1]);
    const DihedralFrame left = dihedral_frame(a, b, x.position(hinge.vertices[2]));
    const DihedralFrame right = dihedral_frame(b, a, x.position(hinge.vertices[3]));
    const double tangent = half_angle_tangent(left, right);
    const double k = hinge.stiffness;
    Local<12> local(order);
    local.value = 2.0 * k * tangent * tangent;
    if (order == Order::value) return local;

    // Local corner order of each triangle in the hinge's vertices: (a, b, c) and (b, a, d).
    static constexpr std::array<int, 3> left_slot = {0, 1, 2};
    static constexpr std::array<int, 3> right_slot = {1, 0, 3};
    const double sec2 = 1.0 + tangent * tangent;
    const double slope = 2.0 * k * tangent * sec2;
    Eigen::Matrix<double, 12, 1> theta = Eigen::Matrix<double, 12, 1>::Zero();
    for (int i = 0; i < 3; ++i) {
        theta.segment<3>(3 * left_slot[i]) += left.gradient(i);
        theta.segment<3>(3 * right_slot[i]) += right.gradient(i);
    }
    local.gradient = slope * theta;
    if (!order.wants_hessian()) return local;

    const double curvature = k * sec2 * (1.0 + 3.0 * tangent * tangent);
    add_lower_product<12>(curvature * theta, theta, local.hessian);
    if (order == Order::gauss_newton) return local;
    left.add_second_derivative(order.exact_share() * slope, left_slot, local.hessian);
    right.add_second_derivative(order.exact_share() * slope, right_slot, local.hessian);
    return local;
}

}  // namespace ruche

#include "ruche/energy/loads.hpp"

namespace ruche {

Eigen::VectorXd lumped_mass(int vertex_count, const std::vector<AreaMass>& triangles) {
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(vertex_count);
    for (const AreaMass& triangle : triangles) {
        for (const int v : triangle.vertices) mass[v] += triangle.mass / 3.0;
    }
    return mass;
}

Local<3> TableContact::evaluate(int element, const Unknowns& x, Order order) const {
    Local<3> local(order);
    const double gap = plane_.up.dot(x.position(element)) - plane_.height;
    if (!(gap < 0.0)) return local;
    const double k = stiffness_[element];
    local.value = 0.5 * k * gap * gap;
    if (order == Order::value) return local;
    local.gradient = k * gap * plane_.up;
    if (order.wants_hessian()) local.hessian = k * plane_.up * plane_.up.transpose();
    return local;
}

}  // namespace ruche

#include "ruche/energy/fabric_membrane.hpp"

#include <Eigen/LU>
#include <cmath>

namespace ruche {
namespace {

Corners corners(const std::array<int, 3>& vertices, const Unknowns& x) {
    return {x.position(vertices[0]), x.position(vertices[1]), x.position(vertices[2])};
}

}  // namespace

FabricMembrane::FabricMembrane(const FabricLaw& law, double thickness, const std::vector<Element>& elements)
    : law_(law) {
    elements_.reserve(elements.size());
    for (const Element& element : elements) {
        const auto& p = element.relaxed;
        Mat2 edges;
        edges << p[1] - p[0], p[2] - p[0];
        Prepared prepared;
        prepared.vertices = element.vertices;
        prepared.volume = thickness * 0.5 * edges.determinant();
        prepared.relaxed_lengths = {(p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm(),
                                    (p[1] - p[0]).squaredNorm()};
        prepared.strain_of_lengths = green_strain_of_lengths(p);
        elements_.push_back(prepared);
    }
}

Vec3 FabricMembrane::green_strain(int element, const Unknowns& x) const {
    const Prepared& e = elements_[element];
    return e.strain_of_lengths * (squared_edge_lengths(corners(e.vertices, x)) - e.relaxed_lengths);
}

Local<9> FabricMembrane::evaluate(int element, const Unknowns& x, Order order) const {
    const Prepared& e = elements_[element];
    const Corners v = corners(e.vertices, x);
    const FabricResponse response = law_(e.strain_of_lengths * (squared_edge_lengths(v) - e.relaxed_lengths));
    Local<9> local(order);
    local.value = e.volume * response.energy;
    if (order == Order::value || !std::isfinite(local.value)) return local;

    const Vec3 slopes = e.volume * (e.strain_of_lengths.transpose() * response.stress);
    const Eigen::Matrix<double, 3, 9> lengths = edge_length_gradient(v);
    local.gradient = lengths.transpose() * slopes;
    if (!order.wants_hessian()) return local;

    const Mat3 tangent = response.mean_tangent(order.gauss_newton_share());
    const Mat3 in_lengths = e.volume * (e.strain_of_lengths.transpose() * tangent * e.strain_of_lengths);
    const Eigen::Matrix<double, 3, 9> weighted = in_lengths * lengths;
    for (int i = 0; i < 3; ++i)
        add_lower_product<9>(lengths.row(i).transpose(), weighted.row(i).transpose(), local.hessian);
    if (order != Order::gauss_newton) add_edge_length_curvature(order.exact_share() * slopes, local.hessian);
    return local;
}

}  // namespace ruche

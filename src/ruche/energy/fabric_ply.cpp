#include "ruche/energy/fabric_ply.hpp"

#include <cmath>

namespace ruche {
namespace {

/// Gauss-Legendre on [-1, 1].
struct Quadrature {
    std::array<double, FabricPly::points> at;
    std::array<double, FabricPly::points> weight;  // of a sum of 1
};
const Quadrature& quadrature() {
    static const Quadrature three = {{-std::sqrt(0.6), 0.0, std::sqrt(0.6)},
                                     {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0}};
    return three;
}

}  // namespace

FabricPly::FabricPly(const Layer& layer) {
    const auto& p = layer.relaxed;
    const Vec2 e1 = p[1] - p[0];
    const Vec2 e2 = p[2] - p[0];
    volume_ = (layer.z1 - layer.z0) * 0.5 * (e1.x() * e2.y() - e1.y() * e2.x());
    const auto lengths = [](const std::array<Vec2, 3>& v) -> Vec3 {
        return {(v[2] - v[1]).squaredNorm(), (v[0] - v[2]).squaredNorm(), (v[1] - v[0]).squaredNorm()};
    };
    const Mat3 of_lengths = green_strain_of_lengths(p);
    frame_strain_ = of_lengths * (lengths(layer.layout) - lengths(p));
    Mat3 others = Mat3::Ones();
    others.diagonal().setZero();
    for (int q = 0; q < points; ++q) {
        const double z = 0.5 * (layer.z0 + layer.z1) + 0.5 * (layer.z1 - layer.z0) * quadrature().at[q];
        strain_of_deviation_[q] << of_lengths, -4.0 * z * of_lengths * others;
    }
}

Vec3 FabricPly::green_strain(int point, const FormVector& deviation) const {
    return frame_strain_ + strain_of_deviation_[point] * deviation;
}

FabricPly::Response FabricPly::evaluate(const FabricLaw& law, const FormVector& deviation,
                                        Order order) const {
    Response sum;
    for (int q = 0; q < points; ++q) {
        const FabricResponse r = law(green_strain(q, deviation));
        const double volume = quadrature().weight[q] * volume_;
        const auto& of_deviation = strain_of_deviation_[q];
        sum.energy += volume * r.energy;
        if (order == Order::value) continue;
        sum.stress += volume * (of_deviation.transpose() * r.stress);
        if (!order.wants_hessian()) continue;
        const Mat3 tangent = r.mean_tangent(order.gauss_newton_share());
        sum.tangent += volume * (of_deviation.transpose() * tangent * of_deviation);
    }
    return sum;
}

}  // namespace ruche

#include "ruche/study/calibration/pull.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace ruche {

/// Strain (E_dd, E_tt, 2 E_dt) in axes d, t, at an angle to the fabric's, to fabric axes.
static Mat3 to_fabric_axes(double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    Mat3 m;
    m << c * c, s * s, -c * s,  //
        s * s, c * c, c * s,    //
        2.0 * c * s, -2.0 * c * s, c * c - s * s;
    return m;
}

/// A descent direction: Newton's, with the free tangent made positive definite where it is not.
static Vec2 descent(const Mat2& tangent, const Vec2& force) {
    const double mean = 0.5 * tangent.trace();
    const double apart = std::hypot(0.5 * (tangent(0, 0) - tangent(1, 1)), tangent(0, 1));
    const double smallest = mean - apart;
    const double wanted = 1e-3 * (std::abs(mean) + apart);
    const double shift = smallest < wanted ? wanted - smallest : 0.0;
    return -(tangent + shift * Mat2::Identity()).inverse() * force;
}

Pull::Pull(const Material& material, const FabricLaw::Options& options, double angle_deg)
    : material_(material),
      options_(options),
      law_(material, options),
      turn_(to_fabric_axes(angle_deg * std::numbers::pi / 180.0)) {}

PullPoint Pull::at(double strain, bool derivatives) {
    PullPoint point;
    strain_[0] = strain;
    FabricResponse response = law_(turn_ * strain_);
    if (!std::isfinite(response.energy)) {
        strain_.tail<2>().setZero();
        response = law_(turn_ * strain_);
    }
    for (int iteration = 0; iteration < 100; ++iteration) {
        const Vec3 stress = turn_.transpose() * response.stress;
        const Mat3 tangent = turn_.transpose() * response.tangent * turn_;
        const Vec2 step = descent(tangent.bottomRightCorner<2, 2>(), stress.tail<2>());
        double length = 1.0;
        Vec3 next = strain_;
        next.tail<2>() += step;
        FabricResponse there = law_(turn_ * next);
        // So close to the optimum differences of the energy are rounding, and Newton's step is right.
        const bool close = step.norm() < 1e-6;
        while (!close && !(there.energy <= response.energy) && length > 1e-9) {
            length *= 0.5;
            next.tail<2>() = strain_.tail<2>() + length * step;
            there = law_(turn_ * next);
        }
        if (!std::isfinite(there.energy)) return point;
        const bool stuck = length <= 1e-9;
        strain_ = next;
        response = there;
        if (step.norm() < 1e-13 * (1.0 + std::abs(strain))) {
            point.found = true;
            break;
        }
        if (stuck) break;
    }
    const Vec3 stress = turn_.transpose() * response.stress;
    point.found = point.found || stress.tail<2>().norm() < 1e-9 * stress.norm();
    point.stress = stress[0];
    point.transverse = strain_[1];
    point.shear = strain_[2];
    if (!derivatives || !point.found) return point;
    const Mat3 tangent = turn_.transpose() * response.tangent * turn_;
    const Mat2 flexibility = tangent.bottomRightCorner<2, 2>().inverse();
    const Vec2 free_by_strain = -flexibility * tangent.block<2, 1>(1, 0);
    point.stress_by_strain = tangent(0, 0) + tangent.block<1, 2>(0, 1).dot(free_by_strain);
    point.transverse_by_strain = free_by_strain[0];
    const StressByParameter by_parameter =
        turn_.transpose() * stress_by_parameter(material_, options_, turn_ * strain_);
    const Eigen::Matrix<double, 2, static_cast<int>(law_parameter_count)> free =
        -flexibility * by_parameter.bottomRows<2>();
    point.transverse_by_parameter = free.row(0);
    point.stress_by_parameter = by_parameter.row(0) + tangent.block<1, 2>(0, 1) * free;
    return point;
}

}  // namespace ruche

#include "ruche/material/fabric_law.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ruche {
namespace {

/// One log term: energy, stress and tangent of beta [(gamma - E) log((gamma - E)/gamma) + E], continued
/// quadratically beyond E = limit.
struct LogTerm {
    double energy, stress, tangent;
};

LogTerm log_term(double beta, double gamma, double limit, double strain) {
    const double e = std::min(strain, limit);
    const double rest = gamma - e;
    const double log_ratio = std::log(rest / gamma);
    LogTerm term{beta * (rest * log_ratio + e), -beta * log_ratio, beta / rest};
    const double beyond = strain - e;
    if (beyond > 0.0) {
        term.energy += term.stress * beyond + 0.5 * term.tangent * beyond * beyond;
        term.stress += term.tangent * beyond;
    }
    return term;
}

bool positive_definite(const Mat3& m) {
    return m(0, 0) > 0.0 && m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0) > 0.0 && m.determinant() > 0.0;
}

}  // namespace

Mat3 FabricResponse::mean_tangent(double semidefinite_share) const {
    if (semidefinite_share == 0.0 || positive_definite(tangent)) return tangent;
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(tangent);
    if (eigen.eigenvalues()[0] >= 0.0) return tangent;
    const Vec3 kept = eigen.eigenvalues().cwiseMax((1.0 - semidefinite_share) * eigen.eigenvalues());
    return eigen.eigenvectors() * kept.asDiagonal() * eigen.eigenvectors().transpose();
}

FabricLaw::FabricLaw(const Material& m, const Options& options)
    : beta_{m.beta_1, m.beta_2},
      gamma_{m.gamma_1, m.gamma_2},
      log_extension_(options.log_extension),
      share_(m.neo_hookean_share) {
    const double nu = m.fabric_poissons_ratio;
    const double plane = 1.0 / (1.0 - nu * nu);
    const double coupling = nu * std::sqrt(m.alpha_1 * m.alpha_2) * plane;
    elasticity_ << m.alpha_1 * plane, coupling, 0.0,  //
        coupling, m.alpha_2 * plane, 0.0,             //
        0.0, 0.0, m.alpha_3 * (options.tensor_shear ? 0.5 : 1.0);
    lambda_ = m.fabric_youngs_modulus * nu * plane;
    mu_ = m.fabric_youngs_modulus / (2.0 * (1.0 + nu));
}

FabricResponse FabricLaw::operator()(const Vec3& e) const {
    FabricResponse r;
    const double own = 1.0 - share_;
    const Vec3 linear_stress = elasticity_ * e;
    r.energy = own * 0.5 * e.dot(linear_stress);
    r.stress = own * linear_stress;
    r.tangent = own * elasticity_;
    for (int i = 0; i < 2; ++i) {
        const LogTerm term = log_term(beta_[i], gamma_[i], strain_limit(i), e[i]);
        r.energy += own * term.energy;
        r.stress[i] += own * term.stress;
        r.tangent(i, i) += own * term.tangent;
    }
    if (share_ == 0.0) return r;

    // Neo-Hookean part in terms of the right Cauchy-Green tensor C = 2 E + I; j2 = det C = J^2.
    const double c11 = 2.0 * e[0] + 1.0;
    const double c22 = 2.0 * e[1] + 1.0;
    const double c12 = e[2];
    const double j2 = c11 * c22 - c12 * c12;
    if (!(j2 > 0.0) || c11 <= 0.0) {
        r.energy = infinity;
        return r;
    }
    // ln J without cancellation near J = 1: det C - 1 = 2 tr E + 4 E11 E22 - (2 E12)^2.
    const double log_j = 0.5 * std::log1p(2.0 * (e[0] + e[1]) + 4.0 * e[0] * e[1] - c12 * c12);
    const double invariant = 2.0 * (e[0] + e[1]);  // tr C - 2
    r.energy += share_ * (0.5 * mu_ * (invariant - 2.0 * log_j) + 0.5 * lambda_ * log_j * log_j);
    // d ln J / dE_voigt = g / j2 with g = (c22, c11, -c12); dg/dE has three entries.
    const Vec3 g(c22, c11, -c12);
    const Vec3 d_log_j = g / j2;
    Mat3 dd_log_j = -2.0 * d_log_j * d_log_j.transpose();
    dd_log_j(0, 1) += 2.0 / j2;
    dd_log_j(1, 0) += 2.0 / j2;
    dd_log_j(2, 2) -= 1.0 / j2;
    const double slope = lambda_ * log_j - mu_;
    r.stress += share_ * (mu_ * Vec3(1.0, 1.0, 0.0) + slope * d_log_j);
    r.tangent += share_ * (slope * dd_log_j + lambda_ * d_log_j * d_log_j.transpose());
    return r;
}

}  // namespace ruche

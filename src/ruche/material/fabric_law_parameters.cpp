#include "ruche/material/fabric_law_parameters.hpp"

#include <cmath>

namespace ruche {
namespace {

/// Stress of a log term over beta, and the derivative of that with respect to gamma.
struct LogStress {
    double value, by_gamma;
};

LogStress log_stress(double gamma, double extension, double strain) {
    if (strain <= gamma - extension)
        return {-std::log1p(-strain / gamma), 1.0 / gamma - 1.0 / (gamma - strain)};
    return {-std::log(extension / gamma) + (strain - gamma + extension) / extension,
            1.0 / gamma - 1.0 / extension};
}

/// dS/dnu of the Neo-Hookean term: mu (1, 1, 0) + (lambda ln J - mu) d ln J/dE with mu' and lambda'.
Vec3 neo_hookean_by_nu(double youngs_modulus, double nu, const Vec3& e) {
    const double plane = 1.0 / (1.0 - nu * nu);
    const double mu = -youngs_modulus / (2.0 * (1.0 + nu) * (1.0 + nu));
    const double lambda = youngs_modulus * plane * (1.0 + 2.0 * nu * nu * plane);
    const double c11 = 2.0 * e[0] + 1.0;
    const double c22 = 2.0 * e[1] + 1.0;
    const double j2 = c11 * c22 - e[2] * e[2];
    const double log_j = 0.5 * std::log1p(2.0 * (e[0] + e[1]) + 4.0 * e[0] * e[1] - e[2] * e[2]);
    return mu * Vec3(1.0, 1.0, 0.0) + (lambda * log_j - mu) / j2 * Vec3(c22, c11, -e[2]);
}

}  // namespace

StressByParameter stress_by_parameter(const Material& m, const FabricLaw::Options& options, const Vec3& e) {
    const double own = 1.0 - m.neo_hookean_share;
    const double nu = m.fabric_poissons_ratio;
    const double plane = 1.0 / (1.0 - nu * nu);
    const double root = std::sqrt(m.alpha_1 * m.alpha_2);
    const double by_1 = 0.5 * root / m.alpha_1;  // d root / d alpha_1
    const double by_2 = 0.5 * root / m.alpha_2;
    const LogStress first = log_stress(m.gamma_1, options.log_extension, e[0]);
    const LogStress second = log_stress(m.gamma_2, options.log_extension, e[1]);
    StressByParameter d = StressByParameter::Zero();
    d.col(0) = plane * Vec3(e[0] + nu * by_1 * e[1], nu * by_1 * e[0], 0.0);
    d.col(1) = plane * Vec3(nu * by_2 * e[1], e[1] + nu * by_2 * e[0], 0.0);
    d(2, 2) = e[2] * (options.tensor_shear ? 0.5 : 1.0);
    d(0, 3) = first.value;
    d(1, 4) = second.value;
    d(0, 5) = m.beta_1 * first.by_gamma;
    d(1, 6) = m.beta_2 * second.by_gamma;
    const Vec3 linear(m.alpha_1 * e[0] + nu * root * e[1], m.alpha_2 * e[1] + nu * root * e[0], 0.0);
    d.col(7) = 2.0 * nu * plane * plane * linear + plane * root * Vec3(e[1], e[0], 0.0);
    d *= own;
    if (m.neo_hookean_share != 0.0)
        d.col(7) += m.neo_hookean_share * neo_hookean_by_nu(m.fabric_youngs_modulus, nu, e);
    return d;
}

}  // namespace ruche

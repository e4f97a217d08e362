#pragma once

#include "ruche/geometry/vectors.hpp"
#include "ruche/material/material.hpp"

namespace ruche {

/// Energy density of bare fabric per relaxed volume (MPa), its second Piola-Kirchhoff stress and its tangent.
struct FabricResponse {
    double energy = 0.0;
    Vec3 stress = Vec3::Zero();
    Mat3 tangent = Mat3::Zero();

    /// The tangent, or that with its negative eigenvalues set to zero (the log terms and C are convex, ln J
    /// is not), or the weighted mean of both, with this share of the latter.
    Mat3 mean_tangent(double semidefinite_share) const;
};

/// The paper's law for the bare fabric (eqs 1-5), a function of Green's strain in fabric axes, Voigt notation
/// (E11, E22, 2 E12):
///
///     Psi~ = (1 - eps) Psi + eps Psi_NH
///     S    = C E - sum_i beta_i log((gamma_i - E_ii) / gamma_i) e_i
///     Psi  = E^T C E / 2 + sum_i beta_i [(gamma_i - E_ii) log((gamma_i - E_ii) / gamma_i) + E_ii]
///     Psi_NH = mu/2 (tr F^T F - 2 - 2 ln J) + lambda/2 (ln J)^2
///
/// Beyond E_ii = gamma_i - delta the stress of the log terms goes on linearly (C^1), so the law is defined
/// for all strains with J > 0; the energy is infinite where J^2 = det(2 E + I) <= 0 and eps > 0.
class FabricLaw {
  public:
    struct Options {
        double log_extension = 1e-3;  ///< delta
        bool tensor_shear = false;    ///< alpha_3 acts on E12 instead of on 2 E12
    };

    explicit FabricLaw(const Material& material) : FabricLaw(material, Options{}) {}
    FabricLaw(const Material& material, const Options& options);

    /// Energy always; stress and tangent too (they cost little).
    FabricResponse operator()(const Vec3& green_strain) const;

    /// C of eq. 2, MPa, without the log terms and the blend.
    const Mat3& elasticity() const { return elasticity_; }
    double gamma(int axis) const { return gamma_[axis]; }
    /// E_ii beyond which the linear extension begins.
    double strain_limit(int axis) const { return gamma_[axis] - log_extension_; }

  private:
    Mat3 elasticity_;
    std::array<double, 2> beta_;
    std::array<double, 2> gamma_;
    double log_extension_;
    double share_;  // eps
    double mu_;
    double lambda_;
};

}  // namespace ruche

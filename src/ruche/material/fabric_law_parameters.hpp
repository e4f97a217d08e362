#pragma once

#include "ruche/material/fabric_law.hpp"

namespace ruche {

/// The parameters of the fabric's law that tension tests may determine, in the order of the derivatives
/// below.
inline constexpr std::size_t law_parameter_count = 8;
inline constexpr std::array<double Material::*, law_parameter_count> law_parameters = {
    &Material::alpha_1, &Material::alpha_2, &Material::alpha_3, &Material::beta_1,
    &Material::beta_2,  &Material::gamma_1, &Material::gamma_2, &Material::fabric_poissons_ratio};

/// Derivative of the second Piola-Kirchhoff stress (Voigt, fabric axes) with respect to `law_parameters` at a
/// strain with J > 0: that of S in fabric_law.hpp, its linear extension beyond gamma_i - delta and the
/// Neo-Hookean share (through Poisson's ratio) included. alpha_1 and alpha_2 must be positive.
using StressByParameter = Eigen::Matrix<double, 3, static_cast<int>(law_parameter_count)>;
StressByParameter stress_by_parameter(const Material& material, const FabricLaw::Options& options,
                                      const Vec3& green_strain);

}  // namespace ruche

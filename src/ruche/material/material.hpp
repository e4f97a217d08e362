#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/fields.hpp"

namespace ruche {

/// Fabric and plastic in the units of the program (mm, N, MPa); the two densities in the units people know.
/// Defaults: paper Table 1 (s = 1.7); thickness and density of the fabric are not given there.
struct Material {
    double fabric_thickness = 0.46;      ///< h_f, relaxed, mm
    double fabric_areal_density = 0.20;  ///< relaxed, kg/m^2
    double alpha_1 = 0.024161;           ///< MPa, eq. 2
    double alpha_2 = 0.090890;
    double alpha_3 = 0.063419;
    double beta_1 = 0.029676;  ///< MPa, eq. 1
    double beta_2 = 0.020512;
    double gamma_1 = 0.9626;  ///< limit Green strain, eq. 1
    double gamma_2 = 0.9637;
    double fabric_poissons_ratio = 0.3;   ///< nu_f
    double fabric_youngs_modulus = 1.05;  ///< E_f, MPa: fabric inside the laminate and the Neo-Hookean term
    double fabric_bending_stiffness = 9.57e-3;  ///< k_B, N mm
    double neo_hookean_share = 0.01;            ///< eps, eq. 5
    double plastic_youngs_modulus = 72.3;       ///< E_p, MPa
    double plastic_density = 1210.0;            ///< kg/m^3
    double laminate_poissons_ratio = 0.4;       ///< nu_b
};

template <>
std::span<const Field<Material>> fields<Material>();

}  // namespace ruche

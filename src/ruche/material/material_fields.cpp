#include "ruche/material/material.hpp"

namespace ruche {

template <>
std::span<const Field<Material>> fields<Material>() {
    using M = Material;
    static const Field<M> table[] = {
        {"fabric_thickness_mm", &M::fabric_thickness, "mm", 1e-3, 20,
         "Thickness of the relaxed fabric. Measure a stack of ten layers between two plates."},
        {"fabric_areal_density_kg_per_m2", &M::fabric_areal_density, "kg/m^2", 0, 20,
         "Mass of the relaxed fabric per area. Only matters under gravity; 0 has no weight."},
        {"alpha_1_mpa", &M::alpha_1, "MPa", 0, 1e5,
         "Linear stiffness of the fabric along its first axis (paper eq. 2)."},
        {"alpha_2_mpa", &M::alpha_2, "MPa", 0, 1e5,
         "Linear stiffness of the fabric along its second axis (paper eq. 2)."},
        {"alpha_3_mpa", &M::alpha_3, "MPa", 0, 1e5, "Shear stiffness of the fabric (paper eq. 2)."},
        {"beta_1_mpa", &M::beta_1, "MPa", 0, 1e5,
         "Strength of the fabric's locking along its first axis (paper eq. 1)."},
        {"beta_2_mpa", &M::beta_2, "MPa", 0, 1e5,
         "Strength of the fabric's locking along its second axis (paper eq. 1)."},
        {"gamma_1", &M::gamma_1, "", 1e-3, 100,
         "Green strain at which the fabric locks along its first axis; the largest pre-stretch is "
         "sqrt(1 + 2 gamma)."},
        {"gamma_2", &M::gamma_2, "", 1e-3, 100,
         "Green strain at which the fabric locks along its second axis; the largest pre-stretch is "
         "sqrt(1 + 2 gamma)."},
        {"fabric_poissons_ratio", &M::fabric_poissons_ratio, "", -0.99, 0.99,
         "Poisson's ratio of the fabric in its plane."},
        {"fabric_youngs_modulus_mpa", &M::fabric_youngs_modulus, "MPa", 0, 1e5,
         "Young's modulus of the fabric under plastic and in the Neo-Hookean term."},
        {"fabric_bending_stiffness_n_mm", &M::fabric_bending_stiffness, "N mm", 0, 1e5,
         "Bending stiffness k_B of the fabric, as a cantilever test measures it."},
        {"neo_hookean_share", &M::neo_hookean_share, "", 0, 1,
         "Share of the Neo-Hookean term in the fabric's energy (paper eq. 5). With 0 nothing keeps fabric "
         "from collapsing to zero area."},
        {"plastic_youngs_modulus_mpa", &M::plastic_youngs_modulus, "MPa", 1e-3, 1e6,
         "Young's modulus of the printed plastic."},
        {"plastic_density_kg_per_m3", &M::plastic_density, "kg/m^3", 0, 30000,
         "Density of the printed plastic. Only matters under gravity; 0 has no weight."},
        {"laminate_poissons_ratio", &M::laminate_poissons_ratio, "", -0.99, 0.99,
         "Common Poisson's ratio of the plies where plastic lies on fabric; the paper takes the mean of "
         "fabric and plastic."},
    };
    return table;
}

}  // namespace ruche

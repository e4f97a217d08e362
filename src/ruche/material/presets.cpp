#include "ruche/material/presets.hpp"

namespace ruche {

/// Units and corrections: Table 1 gives alpha and beta in Pa; see the theory page.
static constexpr std::string_view spandex_tpu95a =
    R"(# Fabric and plastic of Jourdan et al., "Simulation of printed-on-fabric assemblies", Table 1.
name = "spandex-tpu95a"
description = "Spandex knit stretched by 70 % with TPU 95A printed on it"

[[set]]
prestretch = 1.7
fabric_thickness_mm            = { value = 0.46, source = "assumed: not in the paper; the thickness that k_B = E_f h^3 / (12 (1 - nu_f^2)) implies" }
fabric_areal_density_kg_per_m2 = { value = 0.20, source = "assumed: not in the paper; typical of such knits" }
alpha_1_mpa                    = { value = 0.024161, source = "paper Table 1" }
alpha_2_mpa                    = { value = 0.090890, source = "paper Table 1" }
alpha_3_mpa                    = { value = 0.063419, source = "paper Table 1" }
beta_1_mpa                     = { value = 0.029676, source = "paper Table 1" }
beta_2_mpa                     = { value = 0.020512, source = "paper Table 1" }
gamma_1                        = { value = 0.9626, source = "paper Table 1" }
gamma_2                        = { value = 0.9637, source = "paper Table 1" }
fabric_poissons_ratio          = { value = 0.3, source = "paper Table 1" }
fabric_youngs_modulus_mpa      = { value = 1.05, source = "paper Table 1" }
fabric_bending_stiffness_n_mm  = { value = 9.57e-3, source = "paper Table 1" }
neo_hookean_share              = { value = 0.01, source = "paper Table 1" }
plastic_youngs_modulus_mpa     = { value = 72.3, source = "paper Table 1" }
plastic_density_kg_per_m3      = { value = 1210.0, source = "assumed: not in the paper; typical of TPU 95A" }
laminate_poissons_ratio        = { value = 0.4, source = "paper Table 1: mean of the fabric's 0.3 and the plastic's 0.5" }
)";

std::span<const Preset> presets() {
    static constexpr Preset all[] = {{"spandex-tpu95a", spandex_tpu95a}};
    return all;
}

}  // namespace ruche

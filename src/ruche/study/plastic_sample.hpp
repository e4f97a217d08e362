#pragma once

#include <span>
#include <vector>

#include "ruche/material/material.hpp"

namespace ruche {

/// A flat strip of printed plastic alone, between clamps.
struct PlasticSample {
    double length_mm = 150.0;  ///< between the clamps
    double width_mm = 10.0;
    double thickness_mm = 1.0;
    double element_size_mm = 2.0;
};

struct PlasticResponse {
    std::vector<double> force_N;  ///< NaN where no equilibrium was found
    bool converged = true;
};

/// Equilibria at the given engineering strains. The law of printed plastic is linear in Green's strain, so
/// the nominal stress is E_p (strain + 3/2 strain^2 + 1/2 strain^3), apart from what the clamps hold across.
/// Throws InputError for a sample without size.
[[nodiscard]] PlasticResponse simulate_plastic(const PlasticSample& sample, const Material& material,
                                               std::span<const double> strains);

}  // namespace ruche

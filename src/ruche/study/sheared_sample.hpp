#pragma once

#include <span>
#include <vector>

#include "ruche/material/material.hpp"

namespace ruche {

/// A piece of fabric between two parallel clamps of which one moves along itself (paper 5.2).
struct ShearedSample {
    double length_mm = 60.0;       ///< from clamp to clamp, at rest
    double width_mm = 60.0;        ///< along the clamps
    double angle_deg = 0.0;        ///< from the fabric's first axis to the direction from clamp to clamp
    double element_size_mm = 3.0;  ///< force within 0.1 % of its limit at a twentieth of the width
};

struct ShearedResponse {
    std::vector<double> force_N;  ///< along the clamps; NaN where no equilibrium was found
    bool converged = true;        ///< all of them are certified equilibria
};

/// Equilibria of the bare fabric with one clamp moved sideways by `shears` times the length, in the fabric's
/// plane, the clamps' distance kept. The two free sides relax, so the force is that of less than the whole
/// width: a square answers markedly softer than alpha_3 times shear alone. Throws InputError for a sample
/// without size.
[[nodiscard]] ShearedResponse simulate_sheared(const ShearedSample& sample, const Material& material,
                                               std::span<const double> shears);

}  // namespace ruche

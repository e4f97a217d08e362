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
    double element_size_mm = 1.5;  ///< force within 0.4 % of its limit at a fortieth of the width
};

struct ShearedResponse {
    std::vector<double> force_N;  ///< along the clamps; NaN where no equilibrium was found
    bool converged = true;        ///< all of them are certified equilibria
};

/// Equilibria of the bare fabric with one clamp moved sideways by `shears` times the length, in the fabric's
/// plane, the clamps' distance kept. The two free sides relax and the piece bends as well, like a short beam:
/// with the paper's fabric a square answers with 0.47 (at 0 degrees) and 0.60 (at 90) of what alpha_3 times
/// shear makes alone. Throws InputError for a sample without size.
[[nodiscard]] ShearedResponse simulate_sheared(const ShearedSample& sample, const Material& material,
                                               std::span<const double> shears);

}  // namespace ruche

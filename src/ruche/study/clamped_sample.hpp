#pragma once

#include <span>
#include <vector>

#include "ruche/material/material.hpp"

namespace ruche {

/// A fabric strip between clamps: measured geometry, orientation, and what the simulator says it answers.
struct ClampedSample {
    double length_mm = 110.0;      ///< between the clamps, at rest
    double width_mm = 20.0;        ///< at rest; of a dogbone its narrow part
    double angle_deg = 0.0;        ///< from the fabric's first axis to the pull
    double element_size_mm = 2.0;  ///< force within 0.05 % of its limit at a tenth of the width
    double grip_width_mm = 0.0;    ///< of a dogbone, at the clamps; 0 = a straight strip
    double gauge_length_mm = 0.0;  ///< of a dogbone: length of the narrow part
};

struct ClampedResponse {
    std::vector<double> force_N;       ///< that the clamp pulls with; NaN where no equilibrium was found
    std::vector<double> mid_width_mm;  ///< half-way between the clamps
    bool converged = true;             ///< all of them are certified equilibria
};

/// Equilibria of the bare fabric at the given engineering strains (displacement over length; any order;
/// solved from the largest down). Throws InputError for a sample without size and strains not above -1.
[[nodiscard]] ClampedResponse simulate_clamped(const ClampedSample& sample, const Material& material,
                                               std::span<const double> strains);

}  // namespace ruche

#pragma once

#include "ruche/material/material.hpp"

namespace ruche {

/// A strip of bare fabric clamped at one end that hangs under its own weight (paper 5.3).
struct CantileverSample {
    double length_mm = 50.0;  ///< beyond the clamp
    double width_mm = 20.0;
    double angle_deg = 0.0;  ///< from the fabric's first axis to the strip
    int columns = 40;        ///< of elements along the strip
};

/// The rectangle that the strip's side view just fits into.
struct CantileverResponse {
    double x_mm = 0.0;       ///< from the clamp to the tip, horizontally
    double y_mm = 0.0;       ///< from the clamp down to the tip
    bool converged = false;  ///< a certified equilibrium
};

/// The equilibrium under gravity (9.81 m/s^2). Tip: mean over the strip's width. Throws InputError for a
/// strip without size, or one that weighs nothing.
[[nodiscard]] CantileverResponse simulate_cantilever(const CantileverSample& sample,
                                                     const Material& material);

}  // namespace ruche

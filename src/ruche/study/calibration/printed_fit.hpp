#pragma once

#include "ruche/study/calibration/calibration.hpp"

namespace ruche {

/// Adjusts h_f, E_f or E_p in all sets of the card until the simulated radii of the printed samples meet the
/// measured ones: the value with the smallest sum of ((ln R_simulated - ln R_measured) / error)^2, by
/// Gauss-Newton steps in its logarithm, each radius by a whole release of the sample's scene. A campaign
/// without tension tests begins with the card of [printed_fit]. Puts the value, with its interval and source,
/// into the card.
void fit_printed_samples(Calibration& calibration, const Control& control);

}  // namespace ruche

#pragma once

#include <string>

#include "ruche/study/calibration/calibration.hpp"

namespace ruche {

/// A self-contained HTML page of what was measured and fitted: the values with their intervals, warnings, and
/// the paper's Figs 3 to 6 with the user's data (cycles with the branch used, stress over strain of fabric
/// and plastic with the fits, shear, master curve).
std::string calibration_page(const Calibration& calibration);

}  // namespace ruche

#pragma once

#include <string>

#include "ruche/study/calibration/calibration.hpp"

namespace ruche {

/// SVG plots of a calibration, one after the other; empty where there is nothing to show.
std::string cycle_plots(const CalibratedSet& set);
std::string law_plots(const CalibratedSet& set);
std::string shear_plots(const Calibration& calibration);
std::string bending_plots(const Calibration& calibration);
std::string plastic_plots(const Calibration& calibration);

}  // namespace ruche

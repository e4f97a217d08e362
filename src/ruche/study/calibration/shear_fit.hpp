#pragma once

#include <span>
#include <string>
#include <vector>

#include "ruche/material/material.hpp"
#include "ruche/study/calibration/campaign.hpp"

namespace ruche {

/// One shear test and the line through its linear part.
struct ShearCurve {
    ShearTest test;
    std::vector<double> strain;  ///< 2 E12 = d / height, of the chosen branch
    std::vector<double> stress;  ///< f / (width h_f), MPa
    double range = 0.0;          ///< strain up to which it counts as linear
    double slope = 0.0;          ///< dS12 / d(2 E12) there, MPa
    double slope_error = 0.0;
    double intercept = 0.0;
    std::vector<std::string> warnings;
};

/// Reads a shear test (paper 5.2) and fits a line. The linear range is the longest from zero strain in which
/// a quadratic curve bends away from its tangent by less than a tenth of the stress or is lost in the noise,
/// and at least a fifth of what was measured; a test may state it.
[[nodiscard]] ShearCurve read_shear_curve(const ShearTest& test, double fabric_thickness_mm);

/// alpha_3 from several tests, with a 95 % interval from the scatter along the curves and between them.
struct ShearModulus {
    double value = 0.0;
    double low = 0.0, high = 0.0;
};

/// The paper's reading: alpha_3 is the mean slope.
[[nodiscard]] ShearModulus mean_slope_of(std::span<const ShearCurve> curves);

/// With what the sample's free sides take away and the Neo-Hookean share eps: the slope k of a test is
/// k = share ((1 - eps) alpha_3 + eps mu), where share is the slope of the simulated sample (its measured
/// size, the rest of the material as given) over that of simple shear.
[[nodiscard]] ShearModulus corrected_shear_modulus(std::span<const ShearCurve> curves,
                                                   const Material& material);

}  // namespace ruche

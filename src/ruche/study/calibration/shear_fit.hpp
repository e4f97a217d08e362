#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

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

/// Reads a shear test (paper 5.2) and fits a line. The linear range is the longest from zero strain in which a
/// quadratic curve bends away from its tangent by less than a tenth of the stress or is lost in the noise, and at
/// least a fifth of what was measured; a test may state it.
[[nodiscard]] ShearCurve read_shear_curve(const ShearTest& test, double fabric_thickness_mm);

/// The shear modulus of several tests: the mean of their slopes, each over what the sample's free sides take away
/// (`share`, the simulated force over that of simple shear; 1 for the paper's reading).
struct ShearModulus {
    double value = 0.0;
    double low = 0.0, high = 0.0;  ///< 95 % interval from the scatter along the curves and between them
};
[[nodiscard]] ShearModulus shear_modulus(std::span<const ShearCurve> curves, std::span<const double> share);

}  // namespace ruche

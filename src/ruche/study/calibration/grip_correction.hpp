#pragma once

#include "ruche/study/calibration/law_fit.hpp"
#include "ruche/study/calibration/tension_curve.hpp"

namespace ruche {

/// What the grips of each sample change: force and mid width of the simulated clamped sample (its measured
/// length, width and angle) over those of the homogeneous law, at Chebyshev points of stretch and stress,
/// interpolated to the rows. The ratio is within some per cent of one and hardly depends on the parameters,
/// so a fit alternates: fit the homogeneous law times the ratio, simulate at the new parameters, until they
/// rest. Where the simulator finds no equilibrium the ratio is that of the neighbouring points.
void correct_for_grips(std::vector<LawCurve>& curves, std::span<const TensionCurve> tests,
                       const Material& material, double element_size_mm);

/// The polynomial through (nodes, values) at x, in barycentric form (Berrut, Trefethen 2004).
double interpolate(std::span<const double> nodes, std::span<const double> values, double x);

}  // namespace ruche

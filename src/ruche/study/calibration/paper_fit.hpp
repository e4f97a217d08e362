#pragma once

#include "ruche/study/calibration/law_fit.hpp"

namespace ruche {

/// The paper's decoupled fit (5.1): each axis by itself with the closure E22 = -nu_f E11.
struct PaperFit {
    Material material;
    std::array<AxisFit, 2> axis;                  ///< alpha~, beta, gamma as fitted
    std::array<ParameterEstimate, 7> parameters;  ///< alpha_1, alpha_2, alpha_3 (open), beta, gamma
};

/// Fits the curves at 0 and 90 degrees (several of an orientation together) with
///
///     S_ii = alpha~_i E_ii - beta_i log((gamma_i - E_ii)/gamma_i)
///     alpha~_i = (alpha_i - nu_f^2 sqrt(alpha_1 alpha_2)) / (1 - nu_f^2)
///
/// (eq. 12 with its missing 1/(1 - nu_f^2)), and solves the second line for alpha_1 and alpha_2. Knows
/// neither the Neo-Hookean share nor the grips. alpha_3 is left as it is in `start`. Intervals are those of
/// the profile likelihood of alpha~, beta and gamma; those of alpha hold what both axes' fits leave open, at
/// the given Poisson's ratio. Throws InputError when there is no curve within five degrees of an axis.
[[nodiscard]] PaperFit fit_as_in_the_paper(std::span<const LawCurve> curves, const Material& start);

/// alpha from alpha~ (both axes) by Newton's method; alpha~_i >= 0.
std::array<double, 2> alpha_from_tilde(const std::array<double, 2>& tilde, double nu);

}  // namespace ruche

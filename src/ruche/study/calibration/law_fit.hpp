#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "ruche/study/calibration/pull.hpp"

namespace ruche {

/// What a fit of the fabric's law sees of a tension test.
struct LawCurve {
    std::string name;
    double angle_deg = 0.0;
    std::vector<double> stretch;
    std::vector<double> nominal_stress;  ///< MPa
    std::vector<double> transverse;      ///< Green strain across; empty when not measured
    /// What the sample's grips change: the simulated sample's force over that of the homogeneous law, and the
    /// same for the width, per row; empty for a homogeneous sample.
    std::vector<double> force_ratio, width_ratio;
    /// The force was given (hung masses) and the stretch read: the error is the stretch's.
    bool by_force = false;
};

struct LawFitOptions {
    Material start;            ///< values of what is not fitted; those of the others are not used
    bool fit_poisson = false;  ///< with the widths; else start's Poisson's ratio is taken as it is
    /// Profile likelihood and leaving orientations out, a hundred further fits; else intervals are those of
    /// the law made linear at the optimum.
    bool intervals = true;
};

/// One parameter of the fit.
struct ParameterEstimate {
    std::size_t parameter = 0;  ///< index into law_parameters
    double value = 0.0;
    double low = 0.0, high = 0.0;  ///< 95 % interval
    /// The profile likelihood is flat to one side: the data set no such end, which is then the fit's bound.
    bool low_open = false, high_open = false;
    bool identifiable() const { return !low_open && !high_open; }
};

/// Two parameters that the data hardly tell apart.
struct Correlation {
    std::size_t first = 0, second = 0;
    double value = 0.0;
};

/// How well the readings determine the law along one of their curves: half the width of the 95 % interval of
/// its stress (of its stretch where masses were hung), from the derivatives at the optimum.
struct CurveBand {
    double over_full_scale = 0.0;  ///< the widest, over the curve's largest stress (stretch beyond 1)
    double over_value = 0.0;       ///< the widest over the stress there, from a tenth of the strain on
};

/// How well one orientation is predicted by a fit to the others.
struct LeftOutOrientation {
    double angle_deg = 0.0;
    double error = 0.0;   ///< rms of the stress over the largest stress of its curves
    double fitted = 0.0;  ///< the same when it takes part in the fit
};

struct LawFit {
    Material material;
    bool converged = false;
    std::string message;
    std::vector<ParameterEstimate> parameters;
    std::vector<Correlation> correlations;  ///< beyond 0.95 in size, largest first
    std::vector<double> rms;                ///< per curve: of the stress over its largest
    std::vector<CurveBand> bands;           ///< per curve; empty without intervals
    std::vector<LeftOutOrientation> left_out;
    double independent_share = 1.0;  ///< 1 over the number of rows that resemble each other
};

/// The law's nominal stress and transverse Green strain along a curve; NaN where it has none.
struct LawPrediction {
    std::vector<double> nominal_stress, transverse;
};
LawPrediction predict(const Material& material, const LawCurve& curve);

/// All orientations at once: alpha_1 to gamma_2 (and nu_f) that meet every row of every curve in the
/// least-squares sense, the material point's transverse and shear strain free, Neo-Hookean share included.
/// Of a curve by force the stretches are met: (lambda(P) - lambda) times the mean slope of the curve, so that
/// it is a stress as well. Rows are weighted with their standard deviation: the noise of their curve (from
/// differences of neighbours; what the curves have in common counts where they have few rows) and one misfit
/// of the law for all. Intervals are those of the profile
/// likelihood at 95 %, widened for rows whose residuals resemble their neighbours'.
[[nodiscard]] LawFit fit_law(std::span<const LawCurve> curves, const LawFitOptions& options);

/// alpha~, beta and gamma of S = alpha~ E - beta log((gamma - E)/gamma) (paper eq. 12) for one curve: linear
/// in the first two, so only gamma is searched for.
struct AxisFit {
    double alpha = 0.0, beta = 0.0, gamma = 0.0;
    double rms = 0.0;  ///< of S, MPa
};
AxisFit fit_axis(std::span<const double> green, std::span<const double> stress);

}  // namespace ruche

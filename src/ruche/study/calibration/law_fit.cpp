#include "ruche/study/calibration/law_fit.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "ruche/study/calibration/law_problem.hpp"
#include "ruche/study/calibration/profile.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

LeastSquaresFit fit_with_weights(LawProblem& law) {
    LeastSquaresFit fit;
    for (const Eigen::VectorXd& start : law.starts()) {
        LeastSquaresFit other = minimise(law.problem(), start);
        const bool better = other.converged && (!fit.converged || other.sum_of_squares < fit.sum_of_squares);
        if (fit.p.size() == 0 || better) fit = std::move(other);
    }
    for (int round = 0; round < 2; ++round) {
        law.weigh(fit);
        fit = minimise(law.problem(), fit.p);
    }
    return fit;
}

double profile_threshold(const LawProblem& law, double correlation) {
    const double t = student_t(0.95, law.problem().residual_count / correlation - law.parameter_count());
    return t * t * correlation;
}

/// Intervals of all parameters; begins again from a better optimum when a profile comes across one.
std::vector<ParameterEstimate> estimate(LawProblem& law, LeastSquaresFit& fit, double correlation) {
    for (int attempt = 0;; ++attempt) {
        std::vector<ParameterEstimate> estimates;
        Eigen::VectorXd better;
        for (int i = 0; i < law.parameter_count() && better.size() == 0; ++i) {
            const ProfileInterval interval =
                profile_interval(law.problem(), fit, i, profile_threshold(law, correlation));
            estimates.push_back({law.parameter(i), fit.p[i], interval.low, interval.high, interval.low_open,
                                 interval.high_open});
            if (attempt < 3) better = interval.better;
        }
        if (better.size() == 0) return estimates;
        fit = minimise(law.problem(), better);
    }
}

std::vector<Correlation> strong_correlations(const LawProblem& law, const LeastSquaresFit& fit) {
    const Covariance c = covariance(law.problem(), fit);
    std::vector<Correlation> strong;
    for (int i = 0; i < law.parameter_count(); ++i) {
        for (int j = i + 1; j < law.parameter_count(); ++j)
            if (std::abs(c.correlation(i, j)) > 0.95)
                strong.push_back({law.parameter(i), law.parameter(j), c.correlation(i, j)});
    }
    std::sort(strong.begin(), strong.end(),
              [](const auto& a, const auto& b) { return std::abs(a.value) > std::abs(b.value); });
    return strong;
}

std::vector<CurveBand> bands(const LawProblem& law, const LeastSquaresFit& fit, double correlation) {
    const Covariance c = covariance(law.problem(), fit);
    const Eigen::VectorXd half = std::sqrt(profile_threshold(law, correlation)) * c.deviation;
    const Eigen::MatrixXd squared = half.asDiagonal() * c.correlation * half.asDiagonal();
    std::vector<CurveBand> result;
    for (std::size_t i = 0; i < law.curve_count(); ++i) result.push_back(law.band(fit, squared, i));
    return result;
}

/// Rms over the curves of an orientation, of a fit in which it may have had no part.
double error_of(const LawProblem& law, const LeastSquaresFit& fit, std::span<const LawCurve> curves,
                double angle) {
    LeastSquaresFit all = fit;
    if (!law.problem().evaluate(all.p, all.residuals, nullptr)) return std::nan("");
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (curves[i].angle_deg != angle) continue;
        sum += std::pow(law.relative_rms(all, i), 2.0);
        ++count;
    }
    return std::sqrt(sum / count);
}

std::vector<LeftOutOrientation> leave_out(LawProblem& law, const LeastSquaresFit& fit,
                                          std::span<const LawCurve> curves) {
    std::set<double> angles;
    for (const LawCurve& curve : curves) angles.insert(curve.angle_deg);
    std::vector<LeftOutOrientation> result;
    if (angles.size() < 4) return result;  // three orientations are needed for a fit
    for (const double angle : angles) {
        law.leave_out(angle);
        const LeastSquaresFit without = minimise(law.problem(), fit.p);
        law.leave_out(infinity);
        result.push_back({angle, error_of(law, without, curves, angle), error_of(law, fit, curves, angle)});
    }
    return result;
}

}  // namespace

LawPrediction predict(const Material& material, const LawCurve& curve) {
    LawPrediction prediction;
    Pull pull(material, {}, curve.angle_deg);
    for (std::size_t i = 0; i < curve.stretch.size(); ++i) {
        const PullPoint point = pull.at(green_strain(curve.stretch[i]), false);
        const double force = curve.force_ratio.empty() ? 1.0 : curve.force_ratio[i];
        const double width = curve.width_ratio.empty() ? 1.0 : curve.width_ratio[i];
        const double none = std::nan("");
        prediction.nominal_stress.push_back(point.found ? curve.stretch[i] * force * point.stress : none);
        prediction.transverse.push_back(point.found ? green_strain(width * stretch_of(point.transverse))
                                                    : none);
    }
    return prediction;
}

LawFit fit_law(std::span<const LawCurve> curves, const LawFitOptions& options) {
    LawProblem law(curves, options);
    LeastSquaresFit fit = fit_with_weights(law);
    const double correlation = law.correlation(fit);
    LawFit result;
    if (options.intervals) {
        result.parameters = estimate(law, fit, correlation);
        result.correlations = strong_correlations(law, fit);
        result.bands = bands(law, fit, correlation);
        result.left_out = leave_out(law, fit, curves);
    } else {
        const Eigen::VectorXd half =
            covariance(law.problem(), fit).deviation * std::sqrt(profile_threshold(law, correlation));
        for (int i = 0; i < law.parameter_count(); ++i)
            result.parameters.push_back({law.parameter(i), fit.p[i], fit.p[i] - half[i], fit.p[i] + half[i]});
    }
    result.material = law.material(fit.p);
    result.converged = fit.converged;
    result.message = fit.message;
    result.independent_share = 1.0 / correlation;
    for (std::size_t i = 0; i < curves.size(); ++i) result.rms.push_back(law.relative_rms(fit, i));
    return result;
}

}  // namespace ruche

#include "ruche/study/calibration/law_problem.hpp"

#include <algorithm>
#include <cmath>

#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

constexpr std::size_t alpha_1 = 0, alpha_3 = 2, beta_1 = 3, gamma_1 = 5, poisson = 7;

double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// The curve whose pull is nearest to a fabric axis.
const LawCurve& nearest(std::span<const LawCurve> curves, int axis) {
    const auto along = [&](const LawCurve& c) {
        const double turn = c.angle_deg * 3.14159265358979 / 180.0;
        return std::abs(axis == 0 ? std::cos(turn) : std::sin(turn));
    };
    return *std::max_element(curves.begin(), curves.end(),
                             [&](const auto& a, const auto& b) { return along(a) < along(b); });
}

}  // namespace

LawProblem::LawProblem(std::span<const LawCurve> curves, const LawFitOptions& options)
    : curves_(curves), options_(options) {
    for (std::size_t i = 0; i < law_parameter_count; ++i)
        if (i != poisson || options.fit_poisson) free_.push_back(i);
    double stress = 0.0;
    double strain = 0.0;
    int count = 0;
    for (const LawCurve& curve : curves) {
        Rows rows{.begin = count, .stress = static_cast<int>(curve.stretch.size())};
        rows.transverse = static_cast<int>(curve.transverse.size());
        rows.stress_scale = largest(curve.nominal_stress);
        rows.mean_slope = rows.stress_scale / (largest(curve.stretch) - 1.0);
        rows_.push_back(rows);
        count += rows.stress + rows.transverse;
        stress = std::max(stress, rows.stress_scale);
        strain = std::max(strain, green_strain(largest(curve.stretch)));
    }
    // One per cent of what is largest: equal weights to begin with.
    for (Rows& rows : rows_) {
        rows.stress_deviation = 0.01 * stress;
        rows.transverse_deviation = 0.01 * strain;
    }
    const auto size = static_cast<Eigen::Index>(free_.size());
    problem_.residual_count = count;
    problem_.low.resize(size);
    problem_.high.resize(size);
    for (Eigen::Index k = 0; k < size; ++k) {
        const std::size_t i = free_[static_cast<std::size_t>(k)];
        const double stiffness = stress / strain;
        if (i <= alpha_3) {
            problem_.low[k] = 1e-4 * stiffness;
            problem_.high[k] = 1e3 * stiffness;
        } else if (i < gamma_1) {
            problem_.low[k] = 0.0;
            problem_.high[k] = 1e3 * stiffness;
        } else if (i < poisson) {
            const int axis = static_cast<int>(i - gamma_1);
            const LawCurve& along = nearest(curves, axis);
            const double reached = green_strain(largest(along.stretch));
            // A stretch that was read may lie beyond the limit, one that was set may not.
            problem_.low[k] = reached * (along.by_force ? 0.8 : 1.0 + 1e-5);
            problem_.high[k] = 25.0 * reached;
        } else {
            problem_.low[k] = -0.5;
            problem_.high[k] = 0.95;
        }
    }
    problem_.evaluate = [this](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
        return evaluate(p, r, j);
    };
}

std::vector<Eigen::VectorXd> LawProblem::starts() const {
    std::array<AxisFit, 2> fitted, shared;
    for (int axis = 0; axis < 2; ++axis) {
        const LawCurve& curve = nearest(curves_, axis);
        std::vector<double> green, stress;
        for (std::size_t i = 0; i < curve.stretch.size(); ++i) {
            green.push_back(green_strain(curve.stretch[i]));
            stress.push_back(curve.nominal_stress[i] / curve.stretch[i]);
        }
        const auto k = static_cast<std::size_t>(axis);
        fitted[k] = fit_axis(green, stress);
        // Near rest S = (alpha~ + beta/gamma) E: a half each, with a quarter of the secant up to the end, to
        // which the locking adds much.
        const double reached = *std::max_element(green.begin(), green.end());
        const double secant = *std::max_element(stress.begin(), stress.end()) / reached;
        shared[k] = {.alpha = 0.25 * secant, .beta = 0.25 * secant * reached, .gamma = 1.03 * reached};
    }
    return {start(fitted), start(shared)};
}

Eigen::VectorXd LawProblem::start(const std::array<AxisFit, 2>& axes) const {
    Material m = options_.start;
    const double nu = options_.fit_poisson ? 0.3 : m.fabric_poissons_ratio;
    m.fabric_poissons_ratio = nu;
    for (std::size_t k = 0; k < 2; ++k) {
        m.*law_parameters[alpha_1 + k] = std::max(axes[k].alpha, 0.02 * axes[k].beta);
        m.*law_parameters[beta_1 + k] = axes[k].beta;
        m.*law_parameters[gamma_1 + k] = axes[k].gamma;
    }
    m.alpha_3 = std::sqrt(m.alpha_1 * m.alpha_2) / (1.0 + nu);
    Eigen::VectorXd p(free_.size());
    for (std::size_t k = 0; k < free_.size(); ++k)
        p[static_cast<Eigen::Index>(k)] = m.*law_parameters[free_[k]];
    return p.cwiseMax(problem_.low).cwiseMin(problem_.high);
}

Material LawProblem::material(const Eigen::VectorXd& p) const {
    Material m = options_.start;
    for (std::size_t k = 0; k < free_.size(); ++k)
        m.*law_parameters[free_[k]] = p[static_cast<Eigen::Index>(k)];
    return m;
}

bool LawProblem::evaluate(const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) const {
    const Material m = material(p);
    // Not in parallel: a curve takes a fraction of a millisecond, less than to wake a thread on a busy
    // machine.
    for (std::size_t i = 0; i < curves_.size(); ++i)
        if (!evaluate_curve(i, m, r, jacobian)) return false;
    return true;
}

bool LawProblem::evaluate_curve(std::size_t index, const Material& m, Eigen::VectorXd& r,
                                Eigen::MatrixXd* jacobian) const {
    const LawCurve& curve = curves_[index];
    const Rows& rows = rows_[index];
    if (rows.left_out) {
        r.segment(rows.begin, rows.stress + rows.transverse).setZero();
        if (jacobian != nullptr) jacobian->middleRows(rows.begin, rows.stress + rows.transverse).setZero();
        return true;
    }
    Pull pull(m, {}, curve.angle_deg);
    for (int i = 0; i < rows.stress; ++i) {
        const auto row = static_cast<std::size_t>(i);
        Answer answer;
        const bool found = curve.by_force ? answer_to_force(pull, curve, row, rows.mean_slope, answer)
                                          : answer_to_stretch(pull, curve, row, jacobian != nullptr, answer);
        if (!found) return false;
        const int a = rows.begin + i;
        r[a] = answer.residual / rows.stress_deviation;
        const int b = rows.begin + rows.stress + i;
        const double width = curve.width_ratio.empty() ? 1.0 : curve.width_ratio[row];
        if (rows.transverse > 0) {
            const double model = green_strain(width * stretch_of(answer.transverse));
            r[b] = (model - curve.transverse[row]) / rows.transverse_deviation;
        }
        for (std::size_t k = 0; jacobian != nullptr && k < free_.size(); ++k) {
            const auto column = static_cast<Eigen::Index>(k);
            const auto parameter = static_cast<Eigen::Index>(free_[k]);
            (*jacobian)(a, column) = answer.residual_by_parameter[parameter] / rows.stress_deviation;
            if (rows.transverse > 0)
                (*jacobian)(b, column) =
                    width * width * answer.transverse_by_parameter[parameter] / rows.transverse_deviation;
        }
    }
    return true;
}

bool LawProblem::answer_to_stretch(Pull& pull, const LawCurve& curve, std::size_t row, bool derivatives,
                                   Answer& answer) {
    const double stretch = curve.stretch[row];
    const PullPoint point = pull.at(green_strain(stretch), derivatives);
    const double ratio = curve.force_ratio.empty() ? 1.0 : curve.force_ratio[row];
    answer.residual = ratio * stretch * point.stress - curve.nominal_stress[row];
    answer.residual_by_parameter = ratio * stretch * point.stress_by_parameter;
    answer.transverse = point.transverse;
    answer.transverse_by_parameter = point.transverse_by_parameter;
    return point.found;
}

/// Newton's method for the stretch at which the law pulls as hard as the row says, kept between bounds.
bool LawProblem::answer_to_force(Pull& pull, const LawCurve& curve, std::size_t row, double slope,
                                 Answer& answer) {
    const double ratio = curve.force_ratio.empty() ? 1.0 : curve.force_ratio[row];
    double low = 0.9;
    double high = 2.0 * largest(curve.stretch);
    double stretch = curve.stretch[row];
    for (int iteration = 0; iteration < 100; ++iteration) {
        const PullPoint point = pull.at(green_strain(stretch), true);
        if (!point.found) return false;
        const double missing = curve.nominal_stress[row] - ratio * stretch * point.stress;
        // P = lambda S(E): dP/dlambda = S + lambda^2 dS/dE.
        const double by_stretch = ratio * (point.stress + stretch * stretch * point.stress_by_strain);
        const double newton = missing / by_stretch;
        if (std::abs(newton) > 1e-12) {
            (missing > 0.0 ? low : high) = stretch;
            const double next = stretch + newton;
            stretch = next > low && next < high ? next : 0.5 * (low + high);
            continue;
        }
        answer.residual = slope * (stretch - curve.stretch[row]);
        answer.residual_by_parameter = -slope * ratio * stretch / by_stretch * point.stress_by_parameter;
        answer.transverse = point.transverse;
        // dE_tt/dp = (dE_tt/dp)_lambda, and what the stretch that moves with p adds is dE_tt/dE lambda
        // dlambda/dp.
        answer.transverse_by_parameter =
            point.transverse_by_parameter +
            point.transverse_by_strain * stretch * answer.residual_by_parameter / slope;
        return true;
    }
    return false;
}

std::vector<double> LawProblem::block(const Eigen::VectorXd& r, int begin, int count, double scale) const {
    std::vector<double> values(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) values[static_cast<std::size_t>(i)] = scale * r[begin + i];
    return values;
}

/// Per curve the variance of its noise; what is beyond that is the law's misfit, the same for all.
void LawProblem::weigh(const LeastSquaresFit& fit, const Kind& kind, double floor) {
    double misfit = 0.0;
    std::vector<Variance> noise;
    std::vector<std::size_t> curves;
    // Lengths that were read are alike as lengths: rows by force have them as stresses.
    const auto unit = [&](std::size_t i) {
        return curves_[i].by_force && !kind.behind ? rows_[i].mean_slope : 1.0;
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Rows& rows = rows_[i];
        const int count = rows.*kind.count;
        if (count == 0) continue;
        const int begin = rows.begin + (kind.behind ? rows.stress : 0);
        const std::vector<double> values = block(fit.residuals, begin, count, rows.*kind.deviation / unit(i));
        double mean_square = 0.0;
        for (const double v : values) mean_square += v * v / count;
        noise.push_back(noise_variance(values));
        misfit += mean_square - noise.back().value;
        curves.push_back(i);
    }
    if (curves.empty()) return;
    misfit = std::max(misfit / static_cast<double>(curves.size()), 0.0);
    const std::vector<double> variances = moderated(noise);
    for (std::size_t k = 0; k < curves.size(); ++k) {
        const std::size_t i = curves[k];
        rows_[i].*kind.deviation = std::max(unit(i) * std::sqrt(variances[k] + misfit), floor);
    }
}

void LawProblem::weigh(const LeastSquaresFit& fit) {
    double stress = 0.0;
    for (const Rows& rows : rows_) stress = std::max(stress, rows.stress_scale);
    weigh(fit, {&Rows::stress, &Rows::stress_deviation, false}, 1e-9 * stress);
    weigh(fit, {&Rows::transverse, &Rows::transverse_deviation, true}, 1e-9);
}

double LawProblem::correlation(const LeastSquaresFit& fit) const {
    std::vector<std::vector<double>> stresses;
    stresses.reserve(rows_.size());
    for (const Rows& rows : rows_) stresses.push_back(block(fit.residuals, rows.begin, rows.stress, 1.0));
    return correlation_length(stresses);
}

double LawProblem::relative_rms(const LeastSquaresFit& fit, std::size_t curve) const {
    const Rows& rows = rows_[curve];
    return fit.residuals.segment(rows.begin, rows.stress).norm() / std::sqrt(rows.stress) *
           rows.stress_deviation / rows.stress_scale;
}

CurveBand LawProblem::band(const LeastSquaresFit& fit, const Eigen::MatrixXd& squared,
                           std::size_t index) const {
    const Rows& rows = rows_[index];
    const LawCurve& curve = curves_[index];
    const double most = largest(curve.stretch) - 1.0;
    CurveBand band;
    for (int i = 0; i < rows.stress; ++i) {
        const auto row = static_cast<std::size_t>(i);
        const Eigen::RowVectorXd by_parameter = rows.stress_deviation * fit.jacobian.row(rows.begin + i);
        const double half = std::sqrt(std::max(0.0, by_parameter.dot(by_parameter * squared)));
        band.over_full_scale = std::max(band.over_full_scale, half / rows.stress_scale);
        const double residual = rows.stress_deviation * fit.residuals[rows.begin + i];
        const double strain = curve.stretch[row] - 1.0;
        const double value =
            residual + (curve.by_force ? rows.mean_slope * strain : curve.nominal_stress[row]);
        if (strain >= 0.1 * most && value > 0.0) band.over_value = std::max(band.over_value, half / value);
    }
    return band;
}

void LawProblem::leave_out(double angle_deg) {
    for (std::size_t i = 0; i < curves_.size(); ++i) rows_[i].left_out = curves_[i].angle_deg == angle_deg;
}

}  // namespace ruche

#include "ruche/study/calibration/paper_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/study/calibration/least_squares.hpp"
#include "ruche/study/calibration/profile.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

struct AxisData {
    std::vector<double> green, stress;
};

AxisData data_of_axis(std::span<const LawCurve> curves, int axis) {
    AxisData data;
    for (const LawCurve& curve : curves) {
        const double turn = std::remainder(curve.angle_deg - 90.0 * axis, 180.0);
        if (std::abs(turn) > 5.0) continue;
        for (std::size_t i = 0; i < curve.stretch.size(); ++i) {
            data.green.push_back(green_strain(curve.stretch[i]));
            data.stress.push_back(curve.nominal_stress[i] / curve.stretch[i]);
        }
    }
    if (data.green.empty())
        throw InputError({},
                         axis == 0 ? "no tension test along the fabric's first axis (angle_deg = 0)"
                                   : "no tension test along the fabric's second axis (angle_deg = 90)",
                         "The paper's procedure fits each axis by itself and needs both.");
    return data;
}

/// Intervals of alpha~, beta and gamma of one axis.
std::array<ProfileInterval, 3> intervals(const AxisData& data, const AxisFit& fit) {
    const double largest = *std::max_element(data.green.begin(), data.green.end());
    const double deviation =
        std::max(fit.rms, 1e-12 * *std::max_element(data.stress.begin(), data.stress.end()));
    LeastSquares problem;
    problem.residual_count = static_cast<int>(data.green.size());
    problem.low = Eigen::Vector3d(0.0, 0.0, largest * (1.0 + 1e-6));
    problem.high = Eigen::Vector3d(1e5, 1e5, 25.0 * largest);
    problem.evaluate = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
        for (int i = 0; i < problem.residual_count; ++i) {
            const double e = data.green[static_cast<std::size_t>(i)];
            const double l = -std::log1p(-e / p[2]);
            r[i] = (p[0] * e + p[1] * l - data.stress[static_cast<std::size_t>(i)]) / deviation;
            if (jacobian != nullptr)
                jacobian->row(i) =
                    Eigen::RowVector3d(e, l, p[1] * (1.0 / p[2] - 1.0 / (p[2] - e))) / deviation;
        }
        return true;
    };
    const LeastSquaresFit best = minimise(problem, Eigen::Vector3d(fit.alpha, fit.beta, fit.gamma));
    const std::vector<double> residuals(best.residuals.begin(), best.residuals.end());
    const double correlation = correlation_length(std::array{residuals});
    const double t = student_t(0.95, problem.residual_count / correlation - 3.0);
    std::array<ProfileInterval, 3> result;
    for (int i = 0; i < 3; ++i)
        result[static_cast<std::size_t>(i)] = profile_interval(problem, best, i, t * t * correlation);
    return result;
}

}  // namespace

std::array<double, 2> alpha_from_tilde(const std::array<double, 2>& tilde, double nu) {
    // In the square roots a_i: a_i^2 - nu^2 a_1 a_2 = (1 - nu^2) alpha~_i.
    const double share = nu * nu;
    Eigen::Vector2d a(std::sqrt(tilde[0]), std::sqrt(tilde[1]));
    for (int iteration = 0; iteration < 50; ++iteration) {
        const Eigen::Vector2d f(a[0] * a[0] - share * a[0] * a[1] - (1.0 - share) * tilde[0],
                                a[1] * a[1] - share * a[0] * a[1] - (1.0 - share) * tilde[1]);
        Eigen::Matrix2d slope;
        slope << 2.0 * a[0] - share * a[1], -share * a[0], -share * a[1], 2.0 * a[1] - share * a[0];
        if (slope.determinant() == 0.0) break;
        const Eigen::Vector2d step = slope.inverse() * f;
        a -= step;
        if (step.norm() < 1e-16 * a.norm()) break;
    }
    return {a[0] * a[0], a[1] * a[1]};
}

PaperFit fit_as_in_the_paper(std::span<const LawCurve> curves, const Material& start) {
    PaperFit result{.material = start};
    std::array<std::array<ProfileInterval, 3>, 2> interval;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const AxisData data = data_of_axis(curves, static_cast<int>(axis));
        result.axis[axis] = fit_axis(data.green, data.stress);
        interval[axis] = intervals(data, result.axis[axis]);
    }
    const double nu = start.fabric_poissons_ratio;
    const auto alpha = [&](double first, double second) { return alpha_from_tilde({first, second}, nu); };
    const std::array<double, 2> best = alpha(result.axis[0].alpha, result.axis[1].alpha);
    Material& m = result.material;
    m.alpha_1 = best[0];
    m.alpha_2 = best[1];
    m.beta_1 = result.axis[0].beta;
    m.beta_2 = result.axis[1].beta;
    m.gamma_1 = result.axis[0].gamma;
    m.gamma_2 = result.axis[1].gamma;
    const auto estimate = [&](std::size_t parameter, const ProfileInterval& i, double low, double high) {
        result.parameters[parameter] = {parameter,  m.*law_parameters[parameter], low, high, i.low_open,
                                        i.high_open};
    };
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto& [tilde, beta, gamma] = interval[axis];
        // alpha_i depends on both fits, which are independent: their deviations add in quadrature.
        const std::size_t across = 1 - axis;
        const auto deviation = [&](std::size_t of, double value) {
            std::array<double, 2> both = {result.axis[0].alpha, result.axis[1].alpha};
            both[of] = value;
            return alpha(both[0], both[1])[axis] - best[axis];
        };
        const ProfileInterval& other = interval[across][0];
        const double down = std::hypot(deviation(axis, tilde.low), deviation(across, other.low));
        const double up = std::hypot(deviation(axis, tilde.high), deviation(across, other.high));
        estimate(axis, tilde, best[axis] - down, best[axis] + up);
        estimate(3 + axis, beta, beta.low, beta.high);
        estimate(5 + axis, gamma, gamma.low, gamma.high);
    }
    result.parameters[2] = {2, m.alpha_3, m.alpha_3, m.alpha_3, true, true};
    return result;
}

}  // namespace ruche

#include <algorithm>
#include <cmath>

#include "ruche/study/calibration/law_fit.hpp"
#include "ruche/study/calibration/least_squares.hpp"

namespace ruche {
namespace {

/// The best non-negative alpha~ and beta for a given gamma.
AxisFit at_gamma(std::span<const double> green, std::span<const double> stress, double gamma) {
    double ee = 0.0, el = 0.0, ll = 0.0, es = 0.0, ls = 0.0, ss = 0.0;
    for (std::size_t i = 0; i < green.size(); ++i) {
        const double e = green[i];
        const double l = -std::log1p(-e / gamma);
        ee += e * e;
        el += e * l;
        ll += l * l;
        es += e * stress[i];
        ls += l * stress[i];
        ss += stress[i] * stress[i];
    }
    const double determinant = ee * ll - el * el;
    AxisFit fit{.gamma = gamma};
    if (determinant > 1e-12 * ee * ll) {
        fit.alpha = (ll * es - el * ls) / determinant;
        fit.beta = (ee * ls - el * es) / determinant;
    }
    if (fit.alpha < 0.0 || fit.beta < 0.0 || determinant <= 1e-12 * ee * ll) {
        const double only_alpha = ss - es * es / ee;
        const double only_beta = ss - ls * ls / ll;
        fit.alpha = only_alpha <= only_beta ? std::max(es / ee, 0.0) : 0.0;
        fit.beta = only_alpha <= only_beta ? 0.0 : std::max(ls / ll, 0.0);
    }
    const double sum = ss + fit.alpha * fit.alpha * ee + fit.beta * fit.beta * ll +
                       2.0 * (fit.alpha * fit.beta * el - fit.alpha * es - fit.beta * ls);
    fit.rms = std::sqrt(std::max(sum, 0.0) / static_cast<double>(green.size()));
    return fit;
}

}  // namespace

AxisFit fit_axis(std::span<const double> green, std::span<const double> stress) {
    const double largest = *std::max_element(green.begin(), green.end());
    AxisFit start = at_gamma(green, stress, 20.0 * largest);
    for (double excess = 1e-3; excess < 19.0; excess *= 1.25) {
        const AxisFit trial = at_gamma(green, stress, largest * (1.0 + excess));
        if (trial.rms < start.rms) start = trial;
    }
    LeastSquares problem;
    problem.residual_count = static_cast<int>(green.size());
    problem.low = Eigen::Vector3d(0.0, 0.0, largest * (1.0 + 1e-6));
    problem.high = Eigen::Vector3d(1e5, 1e5, 25.0 * largest);
    const double scale = *std::max_element(stress.begin(), stress.end());
    problem.evaluate = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
        for (int i = 0; i < problem.residual_count; ++i) {
            const double e = green[static_cast<std::size_t>(i)];
            const double l = -std::log1p(-e / p[2]);
            r[i] = (p[0] * e + p[1] * l - stress[static_cast<std::size_t>(i)]) / scale;
            if (jacobian != nullptr)
                jacobian->row(i) = Eigen::RowVector3d(e, l, p[1] * (1.0 / p[2] - 1.0 / (p[2] - e))) / scale;
        }
        return true;
    };
    const LeastSquaresFit fit = minimise(problem, Eigen::Vector3d(start.alpha, start.beta, start.gamma));
    return {fit.p[0], fit.p[1], fit.p[2],
            scale * std::sqrt(fit.sum_of_squares / static_cast<double>(green.size()))};
}

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace ruche {

/// A bounded non-linear least-squares problem: the p in [low, high] with the smallest |r(p)|^2.
struct LeastSquares {
    int residual_count = 0;
    Eigen::VectorXd low, high;
    /// Residuals at p and, unless null, their exact derivatives (residuals by parameters). False where the
    /// model has no value: the step is then shortened.
    std::function<bool(const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian)> evaluate;
};

struct LeastSquaresFit {
    Eigen::VectorXd p;
    double sum_of_squares = 0.0;
    Eigen::VectorXd residuals;
    Eigen::MatrixXd jacobian;
    bool converged = false;
    std::string message;  ///< why it stopped
};

/// Levenberg-Marquardt with bounds (Ceres) from `start`, which is moved into the bounds. Parameters in `held`
/// keep their value. `tolerance`: relative change of the sum of squares at which it stops.
[[nodiscard]] LeastSquaresFit minimise(const LeastSquares& problem, const Eigen::VectorXd& start,
                                       const std::vector<int>& held = {}, double tolerance = 1e-15);

}  // namespace ruche

#pragma once

#include "ruche/study/calibration/least_squares.hpp"

namespace ruche {

/// Where the profile likelihood of a parameter stays within a threshold.
struct ProfileInterval {
    double low = 0.0;
    double high = 0.0;
    bool low_open = false;   ///< the threshold is not reached down to the bound: the data set no lower end
    bool high_open = false;  ///< nor an upper one
    bool flat() const { return low_open || high_open; }
    /// A point of the profile with a smaller sum of squares than the fit it began with, if there was one.
    Eigen::VectorXd better;
};

/// Profile-likelihood interval of parameter `index`: all values at which the best fit of the *other*
/// parameters has a sum of squares of at most that of `best` plus `threshold` (Venzon, Moolgavkar 1988). The
/// residuals are in units of their standard deviation; threshold = t^2 of the confidence wanted.
[[nodiscard]] ProfileInterval profile_interval(const LeastSquares& problem, const LeastSquaresFit& best,
                                               int index, double threshold);

/// Standard deviations and correlations of the parameters from the derivatives at the optimum (residuals in
/// units of their standard deviation); those at a bound and those without influence have 0.
struct Covariance {
    Eigen::VectorXd deviation;
    Eigen::MatrixXd correlation;
};
Covariance covariance(const LeastSquares& problem, const LeastSquaresFit& fit);

}  // namespace ruche

#pragma once

#include <span>
#include <vector>

namespace ruche {

/// Two-sided quantile of Student's t: |t| stays below it with the given confidence.
double student_t(double confidence, double degrees_of_freedom);

struct Spread {
    double mean = 0.0;
    double deviation = 0.0;  ///< of a single value, with n - 1; 0 for one value
    int count = 0;
};
Spread spread(std::span<const double> values);

/// Half the width of the 95 % interval of the mean; 0 for one value, about which nothing is known.
double half_width_of_mean(const Spread& s);

/// An estimated variance, and how much is known about it: that of `freedom` independent squares.
struct Variance {
    double value = 0.0;
    double freedom = 0.0;
};

/// Variance of white noise on a smooth curve: half the mean squared difference of neighbours (von Neumann
/// 1941; with n values it scatters as that of 2 (n-1)^2 / (3n-4) independent ones).
Variance noise_variance(std::span<const double> residuals);

/// Variances of the same kind that are known from few values each, drawn towards what they have in common
/// (Smyth 2004): as far as they scatter no more than such estimates do. What is known well keeps its value.
/// Some that are 0, as in files without noise, leave all as they are.
std::vector<double> moderated(std::span<const Variance> variances);

/// By what factor neighbours that resemble each other reduce the number of independent residuals:
/// 1 + 2 sum_k rho_k, the sum up to the first autocorrelation that is not above its scatter for white noise,
/// 1/sqrt(n), at most a tenth of a curve. 1 for white noise. Of several curves together.
double correlation_length(std::span<const std::vector<double>> curves);

/// y = intercept + slope x.
struct Line {
    double intercept = 0.0;
    double slope = 0.0;
    double rms = 0.0;          ///< of the residuals
    double slope_error = 0.0;  ///< standard error, neighbours' resemblance counted
};
/// Least squares; needs two different x.
Line fit_line(std::span<const double> x, std::span<const double> y);

}  // namespace ruche

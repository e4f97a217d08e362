#include "ruche/study/calibration/statistics.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>

namespace ruche {

double student_t(double confidence, double degrees_of_freedom) {
    const boost::math::students_t distribution(std::max(1.0, degrees_of_freedom));
    return boost::math::quantile(distribution, 0.5 + 0.5 * confidence);
}

Spread spread(std::span<const double> values) {
    Spread s{.count = static_cast<int>(values.size())};
    for (const double v : values) s.mean += v / static_cast<double>(values.size());
    for (const double v : values) s.deviation += (v - s.mean) * (v - s.mean);
    s.deviation = values.size() > 1 ? std::sqrt(s.deviation / static_cast<double>(values.size() - 1)) : 0.0;
    return s;
}

double half_width_of_mean(const Spread& s) {
    if (s.count < 2) return 0.0;
    return student_t(0.95, s.count - 1) * s.deviation / std::sqrt(static_cast<double>(s.count));
}

Variance noise_variance(std::span<const double> r) {
    if (r.size() < 2) return {};
    double sum = 0.0;
    for (std::size_t i = 1; i < r.size(); ++i) sum += (r[i] - r[i - 1]) * (r[i] - r[i - 1]);
    const auto n = static_cast<double>(r.size());
    return {0.5 * sum / (n - 1.0), 2.0 * (n - 1.0) * (n - 1.0) / (3.0 * n - 4.0)};
}

/// x with trigamma(x) = value, which falls from infinity to 0.
static double inverse_trigamma(double value) {
    double low = std::log(1e-6);
    double high = std::log(1e9);
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (boost::math::trigamma(std::exp(middle)) > value ? low : high) = middle;
    }
    return std::exp(0.5 * (low + high));
}

std::vector<double> moderated(std::span<const Variance> variances) {
    std::vector<double> values;
    values.reserve(variances.size());
    for (const Variance& v : variances) values.push_back(v.value);
    if (values.size() < 2 || *std::min_element(values.begin(), values.end()) <= 0.0) return values;
    // log s^2 has the mean log sigma^2 + digamma(f/2) - log(f/2) and the variance trigamma(f/2).
    std::vector<double> logs;
    double of_estimates = 0.0;
    double squares = 0.0;
    double freedom = 0.0;
    for (const Variance& v : variances) {
        const double half = 0.5 * v.freedom;
        logs.push_back(std::log(v.value) - boost::math::digamma(half) + std::log(half));
        of_estimates += boost::math::trigamma(half) / static_cast<double>(variances.size());
        squares += v.freedom * v.value;
        freedom += v.freedom;
    }
    const Spread s = spread(logs);
    const double of_sigma = s.deviation * s.deviation - of_estimates;
    // They differ by no more than chance: one variance for all.
    if (of_sigma <= 0.0) return std::vector<double>(values.size(), squares / freedom);
    const double half = inverse_trigamma(of_sigma);
    const double common = std::exp(s.mean + boost::math::digamma(half) - std::log(half));
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] =
            (2.0 * half * common + variances[i].freedom * values[i]) / (2.0 * half + variances[i].freedom);
    return values;
}

double correlation_length(std::span<const std::vector<double>> curves) {
    double variance = 0.0;
    std::size_t rows = 0;
    std::size_t longest = 0;
    for (const std::vector<double>& r : curves) {
        for (const double v : r) variance += v * v;
        rows += r.size();
        longest = std::max(longest, r.size());
    }
    if (rows < 10 || variance == 0.0) return 1.0;
    const double scatter = 1.0 / std::sqrt(static_cast<double>(rows));
    double length = 1.0;
    for (std::size_t lag = 1; lag <= longest / 10; ++lag) {
        double sum = 0.0;
        for (const std::vector<double>& r : curves)
            for (std::size_t i = lag; i < r.size(); ++i) sum += r[i] * r[i - lag];
        if (sum <= scatter * variance) break;
        length += 2.0 * sum / variance;
    }
    return length;
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
    const auto n = static_cast<double>(x.size());
    const double mean_x = spread(x).mean;
    const double mean_y = spread(y).mean;
    double xx = 0.0;
    double xy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    Line line{.slope = xy / xx};
    line.intercept = mean_y - line.slope * mean_x;
    std::vector<double> residuals(x.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        residuals[i] = y[i] - line.intercept - line.slope * x[i];
        sum += residuals[i] * residuals[i];
    }
    line.rms = std::sqrt(sum / n);
    if (x.size() > 2)
        line.slope_error =
            std::sqrt(sum / (n - 2.0) / xx * std::max(1.0, correlation_length(std::array{residuals})));
    return line;
}

}  // namespace ruche

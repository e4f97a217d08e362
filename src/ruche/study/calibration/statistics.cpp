#include "ruche/study/calibration/statistics.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
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

double noise_variance(std::span<const double> r) {
    if (r.size() < 2) return 0.0;
    double sum = 0.0;
    for (std::size_t i = 1; i < r.size(); ++i) sum += (r[i] - r[i - 1]) * (r[i] - r[i - 1]);
    return 0.5 * sum / static_cast<double>(r.size() - 1);
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

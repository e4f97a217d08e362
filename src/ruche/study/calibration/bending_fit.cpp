#include "ruche/study/calibration/bending_fit.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <map>

#include "ruche/study/calibration/elastica.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

struct Measured {
    double length = 0.0, chord = 0.0, aspect = 0.0;
};

double chord_of(double load) {
    const Cantilever c = cantilever(std::clamp(load, 1e-6, 1e4));
    return std::atan2(c.drop, c.reach);
}

/// d chord / d ln load.
double slope_of(double load) {
    constexpr double step = 1e-3;
    return (chord_of(load * std::exp(step)) - chord_of(load * std::exp(-step))) / (2.0 * step);
}

double sum_of_squares(const std::vector<Measured>& points, double weight, double stiffness) {
    double sum = 0.0;
    for (const Measured& p : points)
        sum += std::pow(chord_of(weight * std::pow(p.length, 3.0) / stiffness) - p.chord, 2.0);
    return sum;
}

}  // namespace

BendingFit fit_bending(std::span<const CantileverTest> tests, double areal_density) {
    const double weight = areal_density * 9.80665e-6;  // N/mm^2
    std::map<std::pair<double, std::string>, std::vector<Measured>> by_group;
    for (const CantileverTest& test : tests) {
        for (std::size_t i = 0; i < test.length_mm.size(); ++i)
            by_group[{test.angle_deg, test.side}].push_back(
                {test.length_mm[i], std::atan2(test.y_mm[i], test.x_mm[i]), test.y_mm[i] / test.x_mm[i]});
    }
    BendingFit result;
    double scatter = 0.0;
    int count = 0;
    for (const auto& [key, points] : by_group) {
        BendingGroup group{.angle_deg = key.first, .side = key.second};
        // Each point alone gives a k_B; the common one lies between the extremes.
        double low = infinity;
        double high = 0.0;
        for (const Measured& p : points) {
            const double alone =
                weight * std::pow(p.length, 3.0) / cantilever_of_chord(std::clamp(p.chord, 1e-4, 1.5)).load;
            low = std::min(low, alone);
            high = std::max(high, alone);
        }
        if (high > low * (1.0 + 1e-12)) {
            const auto cost = [&](double log_k) { return sum_of_squares(points, weight, std::exp(log_k)); };
            group.stiffness = std::exp(
                boost::math::tools::brent_find_minima(cost, std::log(low), std::log(high), 40).first);
        } else {
            group.stiffness = low;
        }
        const double sum = sum_of_squares(points, weight, group.stiffness);
        double information = 0.0;
        for (const Measured& p : points) {
            const double load = weight * std::pow(p.length, 3.0) / group.stiffness;
            information += std::pow(slope_of(load), 2.0);
            group.points.push_back({load, p.aspect});
        }
        group.chord_rms = std::sqrt(sum / static_cast<double>(points.size()));
        group.relative_error = 1.0 / std::sqrt(information);  // times the scatter, below
        scatter += sum;
        count += static_cast<int>(points.size());
        result.groups.push_back(group);
    }
    const int groups = static_cast<int>(result.groups.size());
    if (groups == 0) return result;
    const int freedom = count - groups;
    const double deviation = freedom > 0 ? std::sqrt(scatter / freedom) : 0.0;
    double variance = 0.0;
    result.smallest = infinity;
    for (BendingGroup& group : result.groups) {
        group.relative_error *= deviation;
        variance += std::pow(group.relative_error * group.stiffness / groups, 2.0);
        result.stiffness += group.stiffness / groups;
        result.smallest = std::min(result.smallest, group.stiffness);
        result.largest = std::max(result.largest, group.stiffness);
    }
    result.has_interval = freedom > 0;
    const double half = freedom > 0 ? student_t(0.95, freedom) * std::sqrt(variance) : 0.0;
    result.low = std::max(result.stiffness - half, 0.0);
    result.high = result.stiffness + half;
    return result;
}

}  // namespace ruche

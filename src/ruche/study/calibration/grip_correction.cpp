#include "ruche/study/calibration/grip_correction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/core/parallel.hpp"
#include "ruche/study/clamped_sample.hpp"

namespace ruche {
namespace {

/// The coordinate in which the ratio is a smooth curve: stretch plus homogeneous stress, each over its
/// largest. In stretch alone the ratio has a singularity just behind the last row, where the fabric locks,
/// and polynomials converge slowly; there the stress grows as the logarithm of what is left, which takes the
/// singularity away.
class SmoothCoordinate {
  public:
    SmoothCoordinate(const Material& material, double angle_deg, double largest_stretch)
        : pull_(material, {}, angle_deg),
          largest_stretch_(largest_stretch),
          largest_stress_(stress(largest_stretch)) {}

    /// Nominal stress of the homogeneous law, MPa; NaN where it has none.
    double stress(double stretch) {
        const PullPoint point = pull_.at(green_strain(stretch), false);
        return point.found ? stretch * point.stress : std::nan("");
    }
    double transverse_stretch(double stretch) {
        return stretch_of(pull_.at(green_strain(stretch), false).transverse);
    }
    double operator()(double stretch) {
        return stretch / largest_stretch_ + stress(stretch) / largest_stress_;
    }
    double stretch_at(double coordinate, double low, double high) {
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (low + high);
            ((*this)(middle) < coordinate ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

  private:
    Pull pull_;
    double largest_stretch_;
    double largest_stress_;
};

/// Stretches at the Chebyshev points of the second kind of the coordinate on [low, high], the ends included.
std::vector<double> chebyshev(SmoothCoordinate& coordinate, double low, double high) {
    constexpr int count = 8;
    const double first = coordinate(low);
    const double last = coordinate(high);
    std::vector<double> stretches = {high};
    for (int i = 1; i < count - 1; ++i) {
        const double c = std::cos(std::numbers::pi * i / (count - 1));
        stretches.push_back(
            coordinate.stretch_at(0.5 * (first + last) + 0.5 * (last - first) * c, low, high));
    }
    stretches.push_back(low);
    return stretches;
}

/// A stretch that was read at the largest load may lie beyond what the law can do: that which it does.
double stretch_under_load(const LawCurve& curve, const Material& material, double read) {
    const double load = *std::max_element(curve.nominal_stress.begin(), curve.nominal_stress.end());
    Pull pull(material, {}, curve.angle_deg);
    double low = 1.0;
    double high = 1.5 * read;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (middle * pull.at(green_strain(middle), false).stress < load ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

void correct(LawCurve& curve, const TensionCurve& test, const Material& material, double element_size) {
    curve.force_ratio.clear();
    curve.width_ratio.clear();
    const bool dogbone = test.test.grips == Grips::dogbone;
    if (dogbone && test.test.grip_width_mm == 0.0) return;
    const auto [low, high] = std::minmax_element(curve.stretch.begin(), curve.stretch.end());
    const double most = curve.by_force ? stretch_under_load(curve, material, *high) : *high;
    const double least = std::max(*low, 1.0 + 0.02 * (most - 1.0));  // at rest the ratio is 0/0
    SmoothCoordinate coordinate(material, curve.angle_deg, most);
    const std::vector<double> stretches = chebyshev(coordinate, least, most);
    std::vector<double> strains;
    strains.reserve(stretches.size());
    for (const double s : stretches) strains.push_back(s - 1.0);
    const ClampedSample sample{.length_mm = test.rest_length,
                               .width_mm = test.test.width_mm,
                               .angle_deg = test.test.angle_deg,
                               .element_size_mm = element_size,
                               .grip_width_mm = dogbone ? test.test.grip_width_mm : 0.0,
                               .gauge_length_mm = dogbone ? test.test.gauge_length_mm : 0.0};
    const ClampedResponse response = simulate_clamped(sample, material, strains);
    std::vector<double> nodes, force, width;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        const double free = coordinate.stress(stretches[i]) * test.test.width_mm * material.fabric_thickness;
        if (!std::isfinite(response.force_N[i]) || !(free > 0.0)) continue;
        nodes.push_back(coordinate(stretches[i]));
        force.push_back(response.force_N[i] / free);
        width.push_back(response.mid_width_mm[i] /
                        (test.test.width_mm * coordinate.transverse_stretch(stretches[i])));
    }
    if (nodes.size() < 3) return;
    const auto [first, last] = std::minmax_element(nodes.begin(), nodes.end());
    for (const double stretch : curve.stretch) {
        const double x = std::clamp(coordinate(std::clamp(stretch, least, most)), *first, *last);
        curve.force_ratio.push_back(interpolate(nodes, force, x));
        curve.width_ratio.push_back(interpolate(nodes, width, x));
    }
}

}  // namespace

double interpolate(std::span<const double> nodes, std::span<const double> values, double x) {
    double above = 0.0;
    double below = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (x == nodes[i]) return values[i];
        double weight = 1.0;
        for (std::size_t j = 0; j < nodes.size(); ++j)
            if (j != i) weight /= nodes[i] - nodes[j];
        above += weight / (x - nodes[i]) * values[i];
        below += weight / (x - nodes[i]);
    }
    return above / below;
}

void correct_for_grips(std::vector<LawCurve>& curves, std::span<const TensionCurve> tests,
                       const Material& material, double element_size) {
    parallel_for(curves.size(), [&](std::size_t i) { correct(curves[i], tests[i], material, element_size); });
}

}  // namespace ruche

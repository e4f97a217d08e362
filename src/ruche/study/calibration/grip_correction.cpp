#include "ruche/study/calibration/grip_correction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/core/parallel.hpp"
#include "ruche/study/clamped_sample.hpp"

namespace ruche {
namespace {

constexpr int node_count = 8;

/// Chebyshev points of the second kind on [low, high], the ends included.
std::vector<double> chebyshev(double low, double high) {
    std::vector<double> nodes;
    for (int i = 0; i < node_count; ++i) {
        const double c = std::cos(std::numbers::pi * i / (node_count - 1));
        nodes.push_back(0.5 * (low + high) + 0.5 * (high - low) * c);
    }
    return nodes;
}

void correct(LawCurve& curve, const TensionCurve& test, const Material& material, double element_size) {
    curve.force_ratio.clear();
    curve.width_ratio.clear();
    const bool dogbone = test.test.grips == Grips::dogbone;
    if (dogbone && test.test.grip_width_mm == 0.0) return;
    const auto [low, high] = std::minmax_element(curve.stretch.begin(), curve.stretch.end());
    const double least = std::max(*low, 1.0 + 0.02 * (*high - 1.0));  // at rest the ratio is 0/0
    std::vector<double> stretches = chebyshev(least, *high);
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
    Pull pull(material, {}, curve.angle_deg);
    std::vector<double> nodes, force, width;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        const PullPoint point = pull.at(green_strain(stretches[i]), false);
        const double free = stretches[i] * point.stress * test.test.width_mm * material.fabric_thickness;
        if (!point.found || !std::isfinite(response.force_N[i]) || free <= 0.0) continue;
        nodes.push_back(stretches[i]);
        force.push_back(response.force_N[i] / free);
        width.push_back(response.mid_width_mm[i] / (test.test.width_mm * stretch_of(point.transverse)));
    }
    if (nodes.size() < 3) return;
    const auto [first, last] = std::minmax_element(nodes.begin(), nodes.end());
    for (const double stretch : curve.stretch) {
        const double x = std::clamp(stretch, *first, *last);
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

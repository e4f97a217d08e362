#include "ruche/study/virtual_test/virtual_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <stdexcept>

#include "ruche/core/parallel.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/study/cantilever_sample.hpp"
#include "ruche/study/clamped_sample.hpp"
#include "ruche/study/plastic_sample.hpp"
#include "ruche/study/sheared_sample.hpp"

namespace ruche {
namespace {

/// From 0 to `largest`, closer together towards the end, where the fabric locks.
std::vector<double> graded(double largest, int count) {
    std::vector<double> points;
    for (int i = 0; i < count; ++i) {
        const double left = 1.0 - static_cast<double>(i) / (count - 1);
        points.push_back(largest * (1.0 - std::pow(left, 1.5)));
    }
    return points;
}

std::vector<double> times(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
}

void require(bool converged, const std::string& what) {
    if (!converged)
        throw std::runtime_error(
            fmt::format("{}: the simulator found no certified equilibrium; the card's values may lie outside "
                        "of what a fabric can be",
                        what));
}

constexpr int tension_points = 48;
constexpr int shear_points = 16;

VirtualCurve tension(const VirtualSamples& s, const Material& material, double angle) {
    const ClampedSample sample{.length_mm = s.length,
                               .width_mm = s.width,
                               .angle_deg = angle,
                               .element_size_mm = s.width / s.elements_across,
                               .grip_width_mm = s.grip_width,
                               .gauge_length_mm = s.gauge_length};
    const std::vector<double> strains = graded(s.prestretch - 1.0, tension_points);
    ClampedResponse response = simulate_clamped(sample, material, strains);
    require(response.converged, fmt::format("tension at {} degrees", angle));
    return {"tension", angle, times(strains, s.length), std::move(response.force_N),
            std::move(response.mid_width_mm)};
}

VirtualCurve shear(const VirtualSamples& s, const Material& material, double angle) {
    const ShearedSample sample{.length_mm = s.shear_side,
                               .width_mm = s.shear_side,
                               .angle_deg = angle,
                               .element_size_mm = s.shear_side / (4 * s.elements_across)};
    const std::vector<double> shears = graded(s.shear, shear_points);
    ShearedResponse response = simulate_sheared(sample, material, shears);
    require(response.converged, fmt::format("shear at {} degrees", angle));
    return {"shear", angle, times(shears, s.shear_side), std::move(response.force_N), {}};
}

VirtualCurve plastic(const VirtualSamples& s, const Material& material) {
    const PlasticSample sample{.length_mm = s.plastic_length,
                               .width_mm = s.plastic_width,
                               .thickness_mm = s.plastic_thickness,
                               .element_size_mm = s.plastic_width / 5.0};
    const std::vector<double> strains = graded(s.plastic_strain, shear_points);
    PlasticResponse response = simulate_plastic(sample, material, strains);
    require(response.converged, "tension of plastic");
    return {"plastic", 0.0, times(strains, s.plastic_length), std::move(response.force_N), {}};
}

VirtualDroop droop(const VirtualSamples& s, const Material& material, double angle, double length) {
    const CantileverResponse response = simulate_cantilever(
        {.length_mm = length, .width_mm = s.cantilever_width, .angle_deg = angle}, material);
    require(response.converged, fmt::format("cantilever of {} mm at {} degrees", length, angle));
    return {angle, length, response.x_mm, response.y_mm};
}

/// One simulation each; the places of their results in `result` are made here, in the order of the files.
std::vector<std::function<void()>> jobs(VirtualCurves& result) {
    const VirtualSamples& s = result.samples;
    std::vector<std::function<VirtualCurve()>> curves;
    const Material& material = result.material;
    if (includes(s, "tension"))
        for (const double angle : numbers_of(s.angles, "angles_deg", -360, 360))
            curves.emplace_back([&, angle] { return tension(s, material, angle); });
    if (includes(s, "shear"))
        for (const double angle : numbers_of(s.shear_angles, "shear_angles_deg", -360, 360))
            curves.emplace_back([&, angle] { return shear(s, material, angle); });
    if (includes(s, "plastic")) curves.emplace_back([&] { return plastic(s, material); });
    if (includes(s, "cantilever"))
        for (const double angle : numbers_of(s.cantilever_angles, "cantilever_angles_deg", -360, 360))
            for (const double length : numbers_of(s.cantilever_lengths, "cantilever_lengths_mm", 1, 1e4))
                result.droops.push_back({.angle = angle, .length = length});
    result.curves.resize(curves.size());

    std::vector<std::function<void()>> all;
    for (std::size_t i = 0; i < curves.size(); ++i)
        all.emplace_back([&result, i, make = std::move(curves[i])] { result.curves[i] = make(); });
    for (VirtualDroop& place : result.droops)
        all.emplace_back([&] { place = droop(s, material, place.angle, place.length); });
    return all;
}

}  // namespace

VirtualCurves simulate_tests(const VirtualSamples& samples, const Material& material,
                             const Control& control) {
    check_prestretch(material, {samples.prestretch, samples.prestretch}, {.key = "prestretch"});
    VirtualCurves result{.samples = samples, .material = material};
    const auto all = jobs(result);
    std::mutex telling;
    std::size_t done = 0;
    parallel_for(all.size(), [&](std::size_t i) {
        if (control.stopped()) throw std::runtime_error("interrupted");
        all[i]();
        const std::lock_guard lock(telling);
        const double fraction = static_cast<double>(++done) / static_cast<double>(all.size());
        control.say({"tests", fraction, fmt::format("{} of {} simulated", done, all.size())});
    });
    return result;
}

}  // namespace ruche

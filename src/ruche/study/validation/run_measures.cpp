#include "ruche/study/validation/run_measures.hpp"

#include <cmath>
#include <limits>

#include "ruche/output/metrics.hpp"
#include "ruche/study/calibration/elastica.hpp"
#include "ruche/study/calibration/moduli.hpp"
#include "ruche/study/calibration/pull.hpp"
#include "ruche/study/validation/sheet_measures.hpp"

namespace ruche {
namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

/// The layout with the share of each centre line that a metric looks at.
PrintMesh looked_at(const MetricSpec& metric, const Result& result) {
    return metric.middle < 1.0 ? with_middles(result.layout, metric.middle) : result.layout;
}

double mean_strip_curvature(const MetricSpec& metric, const Result& result) {
    const std::vector<StripMetrics> strips = measure_strips(looked_at(metric, result), result.shape);
    double sum = 0.0;
    const std::vector<int> chosen = chosen_strips(result.layout, metric.strips, metric.interior);
    for (const int s : chosen) sum += strips[static_cast<std::size_t>(s)].curvature;
    return sum / static_cast<double>(chosen.size());  // NaN when there is none
}

HelixFit first_helix(const MetricSpec& metric, const Result& result) {
    const std::vector<int> chosen = chosen_strips(result.layout, metric.strips, metric.interior);
    return chosen.empty() ? HelixFit{} : strip_helix(looked_at(metric, result), result.shape, chosen.front());
}

double bimetal(const Scene& scene) {
    const bool front = scene.plastic.side == Side::front;
    const double thickness = scene.plastic.thickness_mm * (front ? 1.0 : scene.plastic.back_thickness_factor);
    const double curvature = strip_curvature(scene.material, scene.fabric.prestretch[0], thickness);
    return front ? curvature : -curvature;
}

/// k_B, weight and length of a hanging strip as the load of the elastica.
double heavy_load(const CantileverSample& sample, const Material& material) {
    constexpr double gravity = 9806.65;     // mm/s^2, as in simulate_cantilever
    constexpr double tonne_per_mm2 = 1e-9;  // of 1 kg/m^2
    return material.fabric_areal_density * tonne_per_mm2 * gravity * std::pow(sample.length_mm, 3) /
           material.fabric_bending_stiffness;
}

}  // namespace

double measured(const MetricSpec& metric, const Result& result) {
    const Vec2 at(metric.at_mm[0], metric.at_mm[1]);
    const LayoutRing ring{.middle = at, .inner = metric.inner_mm, .outer = metric.outer_mm};
    switch (metric.of) {
        case Measure::strip_curvature:
            return mean_strip_curvature(metric, result);
        case Measure::silhouette_curvature:
            return std::copysign(silhouette_curvature(result.layout, result.shape, metric.interior),
                                 mean_strip_curvature(metric, result));
        case Measure::transverse_stretch:
            return transverse_stretch(result.layout, result.shape, ring);
        case Measure::gauss_curvature:
            return integrated_curvature(result.layout, result.shape, ring).gauss;
        case Measure::mean_curvature:
            return integrated_curvature(result.layout, result.shape, ring).mean;
        case Measure::fitted_mean_curvature:
            return fitted_curvature(result.layout, result.shape, ring).mean();
        case Measure::larger_curvature:
            return fitted_curvature(result.layout, result.shape, ring).max;
        case Measure::smaller_curvature:
            return fitted_curvature(result.layout, result.shape, ring).min;
        case Measure::helix_curvature:
            return std::copysign(first_helix(metric, result).curvature, mean_strip_curvature(metric, result));
        case Measure::helix_torsion:
            return first_helix(metric, result).torsion;
        case Measure::position_x:
            return position_of(result.layout, result.shape, at).x();
        case Measure::position_z:
            return position_of(result.layout, result.shape, at).z();
        case Measure::energy:
            return result.equilibrium.energy.total();
        case Measure::bimetal_curvature:
            return bimetal(result.scene);
        case Measure::clamped_force:
        case Measure::law_force:
        case Measure::hanging_slope:
        case Measure::elastica_slope:
            break;
    }
    return not_there;
}

RunOutcome pull_sample(const ValidationRun& run, const Experiment& experiment) {
    std::vector<double> strains;
    for (const MetricSpec& metric : experiment.metrics)
        if (metric.of == Measure::clamped_force) strains.push_back(metric.strain);
    const Material& material = run.scene.material;
    const ClampedResponse response = simulate_clamped(*run.pull, material, strains);
    RunOutcome outcome{.certain = response.converged};
    std::size_t next = 0;
    for (const MetricSpec& metric : experiment.metrics) {
        double& value = outcome.values[metric.name] = not_there;
        if (metric.of == Measure::clamped_force) {
            value = response.force_N[next++];
        } else if (metric.of == Measure::law_force) {
            const double stretch = 1.0 + metric.strain;
            const double stress = Pull(material, FabricLaw::Options{}, run.pull->angle_deg)
                                      .at(green_strain(stretch), false)
                                      .stress;
            value = stress * stretch * run.pull->width_mm * material.fabric_thickness;
        }
    }
    return outcome;
}

RunOutcome hang_sample(const ValidationRun& run, const Experiment& experiment) {
    const CantileverResponse hung = simulate_cantilever(*run.hang, run.scene.material);
    const Cantilever elastica = cantilever(heavy_load(*run.hang, run.scene.material));
    RunOutcome outcome{.certain = hung.converged};
    for (const MetricSpec& metric : experiment.metrics) {
        double& value = outcome.values[metric.name] = not_there;
        if (metric.of == Measure::hanging_slope) value = hung.y_mm / hung.x_mm;
        if (metric.of == Measure::elastica_slope) value = elastica.drop / elastica.reach;
    }
    return outcome;
}

}  // namespace ruche

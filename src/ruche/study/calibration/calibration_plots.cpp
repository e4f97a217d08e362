#include "ruche/study/calibration/calibration_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/study/calibration/elastica.hpp"
#include "ruche/study/calibration/plot.hpp"

namespace ruche {
namespace {

constexpr double kilo = 1e3;  // MPa to kPa

std::vector<double> scaled(const std::vector<double>& values, double factor) {
    std::vector<double> result;
    result.reserve(values.size());
    for (const double v : values) result.push_back(factor * v);
    return result;
}

std::vector<double> greens(const std::vector<double>& stretches) {
    std::vector<double> result;
    result.reserve(stretches.size());
    for (const double s : stretches) result.push_back(green_strain(s));
    return result;
}

std::vector<double> second_stress(const std::vector<double>& nominal, const std::vector<double>& stretch) {
    std::vector<double> result;
    for (std::size_t i = 0; i < stretch.size(); ++i) result.push_back(kilo * nominal[i] / stretch[i]);
    return result;
}

}  // namespace

std::string cycle_plots(const CalibratedSet& set) {
    std::string svg;
    for (const TensionCurve& test : set.tests) {
        const TestRecord& r = test.record;
        Plot plot{.title = test.name(),
                  .x_label = "displacement (mm)",
                  .y_label = "force (N)",
                  .series = {{.label = fmt::format("all {} cycles", test.cycles.size()),
                              .colour = "#999999",
                              .x = r.displacement,
                              .y = r.force,
                              .size = 1.0}}};
        const char* const branch = test.test.branch == Branch::unloading ? "unloading" : "loading";
        for (const std::size_t cycle : test.used) {
            PlotSeries used{.colour = "#009e73", .size = 1.6};
            if (cycle == test.used.front()) used.label = fmt::format("{}, {}", branch, test.used_cycles());
            const RowRange rows = test.cycles[cycle].rows(test.test.branch);
            for (std::size_t i = rows.begin; i < rows.end; ++i) {
                used.x.push_back(r.displacement[i]);
                used.y.push_back(r.force[i]);
            }
            plot.series.push_back(std::move(used));
        }
        svg += svg_plot(plot);
    }
    return svg;
}

std::string law_plots(const CalibratedSet& set) {
    Plot stress{.title = "Stress over strain, measured and fitted",
                .x_label = "Green strain along the pull",
                .y_label = "second Piola-Kirchhoff stress (kPa)",
                .width_px = 620,
                .height_px = 430};
    Plot width{.title = "Width",
               .x_label = "Green strain along the pull",
               .y_label = "Green strain across",
               .width_px = 460,
               .height_px = 430};
    Plot residual{.title = "What the fit leaves",
                  .x_label = "Green strain along the pull",
                  .y_label = "stress, measured - fitted (kPa)",
                  .width_px = 460,
                  .height_px = 430};
    for (std::size_t i = 0; i < set.curves.size(); ++i) {
        const LawCurve& curve = set.curves[i];
        const LawPrediction fit = predict(set.fit.material, curve);
        const std::string colour = plot_colour(i);
        const std::vector<double> strain = greens(curve.stretch);
        const std::vector<double> measured = second_stress(curve.nominal_stress, curve.stretch);
        const std::vector<double> fitted = second_stress(fit.nominal_stress, curve.stretch);
        stress.series.push_back({.colour = colour, .x = strain, .y = measured, .dots = true, .size = 1.2});
        stress.series.push_back(
            {.label = fmt::format("{:g}°", curve.angle_deg), .colour = colour, .x = strain, .y = fitted});
        if (!curve.transverse.empty()) {
            width.series.push_back(
                {.colour = colour, .x = strain, .y = curve.transverse, .dots = true, .size = 1.0});
            width.series.push_back({.colour = colour, .x = strain, .y = fit.transverse});
        }
        std::vector<double> left;
        for (std::size_t k = 0; k < measured.size(); ++k) left.push_back(measured[k] - fitted[k]);
        residual.series.push_back({.colour = colour, .x = strain, .y = left, .dots = true, .size = 1.2});
    }
    return svg_plot(stress) + svg_plot(residual) + (width.series.empty() ? "" : svg_plot(width));
}

std::string shear_plots(const Calibration& calibration) {
    Plot plot{
        .title = "Shear", .x_label = "shear strain 2 E12", .y_label = "shear stress (kPa)", .width_px = 620};
    for (std::size_t i = 0; i < calibration.shear.size(); ++i) {
        const ShearCurve& curve = calibration.shear[i];
        plot.series.push_back({.colour = plot_colour(i),
                               .x = curve.strain,
                               .y = scaled(curve.stress, kilo),
                               .dots = true,
                               .size = 1.2});
        plot.series.push_back(
            {.label = fmt::format("{:g}°: slope {:.4g} kPa up to {:.2g}", curve.test.angle_deg,
                                  kilo * curve.slope, curve.range),
             .colour = plot_colour(i),
             .x = {0.0, curve.range},
             .y = {kilo * curve.intercept, kilo * (curve.intercept + curve.slope * curve.range)}});
    }
    return calibration.shear.empty() ? "" : svg_plot(plot);
}

std::string bending_plots(const Calibration& calibration) {
    if (!calibration.bending) return {};
    Plot plot{.title = "Cantilevers on the master curve",
              .x_label = "Γ = weight per area · L³ / k_B",
              .y_label = "y/x",
              .log_x = true,
              .log_y = true,
              .width_px = 620,
              .height_px = 400};
    double low = 1e4;
    double high = 1e-6;
    for (const BendingGroup& group : calibration.bending->groups) {
        for (const BendingGroup::Point& p : group.points) {
            low = std::min(low, p.load);
            high = std::max(high, p.load);
        }
    }
    PlotSeries curve{.label = "master curve", .colour = "#000000"};
    low = std::max(0.3 * low, 1e-5);
    high = std::min(3.0 * high, 5e3);
    for (int i = 0; i <= 100; ++i) {
        const double load = low * std::pow(high / low, i / 100.0);
        const Cantilever c = cantilever(load);
        curve.x.push_back(load);
        curve.y.push_back(c.drop / c.reach);
    }
    plot.series.push_back(curve);
    for (std::size_t i = 0; i < calibration.bending->groups.size(); ++i) {
        const BendingGroup& group = calibration.bending->groups[i];
        PlotSeries points{.label = fmt::format("{:g}°, {} up: k_B = {:.4g} N mm", group.angle_deg, group.side,
                                               group.stiffness),
                          .colour = plot_colour(i),
                          .dots = true,
                          .size = 3.0};
        for (const BendingGroup::Point& p : group.points) {
            points.x.push_back(p.load);
            points.y.push_back(p.aspect);
        }
        plot.series.push_back(points);
    }
    return svg_plot(plot);
}

std::string plastic_plots(const Calibration& calibration) {
    std::string svg;
    for (const PlasticCurve& curve : calibration.plastic) {
        const double end = std::min(2.0 * curve.test.window, curve.strain.back());
        svg += svg_plot({.title = "Plastic: " + file_name(curve.test.file),
                         .x_label = "engineering strain",
                         .y_label = "engineering stress (MPa)",
                         .series = {{.label = "measured",
                                     .colour = "#0072b2",
                                     .x = curve.strain,
                                     .y = curve.stress,
                                     .dots = true,
                                     .size = 1.3},
                                    {.label = fmt::format("tangent at zero: {:.4g} MPa", curve.modulus),
                                     .colour = "#d55e00",
                                     .x = {0.0, end},
                                     .y = {curve.intercept, curve.intercept + curve.modulus * end}}}});
    }
    return svg;
}

}  // namespace ruche

#include "ruche/study/calibration/shear_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "ruche/study/calibration/cycles.hpp"
#include "ruche/study/calibration/statistics.hpp"
#include "ruche/study/sheared_sample.hpp"

namespace ruche {
namespace {

/// Rows up to a strain.
struct Window {
    std::vector<double> strain, stress;
};

Window window(const ShearCurve& curve, double range) {
    Window w;
    for (std::size_t i = 0; i < curve.strain.size(); ++i) {
        if (std::abs(curve.strain[i]) > range) continue;
        w.strain.push_back(curve.strain[i]);
        w.stress.push_back(curve.stress[i]);
    }
    return w;
}

/// How far the best quadratic curve bends away from its tangent at zero, over the stress at the end; 0 where
/// the bend is lost in the scatter.
double bend(const Window& w, double range) {
    const auto count = static_cast<Eigen::Index>(w.strain.size());
    Eigen::MatrixXd a(count, 3);
    Eigen::VectorXd y(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const double x = w.strain[static_cast<std::size_t>(i)] / range;
        a.row(i) = Eigen::RowVector3d(1.0, x, x * std::abs(x));
        y[i] = w.stress[static_cast<std::size_t>(i)];
    }
    const Eigen::Vector3d c = a.colPivHouseholderQr().solve(y);
    const double rms = (a * c - y).norm() / std::sqrt(static_cast<double>(count));
    const double end = std::abs(c[1] + c[2]);
    if (end == 0.0) return 0.0;
    // Standard error of the quadratic term of evenly spread points on [0, 1]: sqrt(180 / n) times the
    // scatter.
    if (std::abs(c[2]) < 2.0 * std::sqrt(180.0 / static_cast<double>(count)) * rms) return 0.0;
    return std::abs(c[2]) / end;
}

}  // namespace

ShearCurve read_shear_curve(const ShearTest& test, double thickness) {
    ShearCurve curve{.test = test};
    const TestRecord record =
        read_record(read_csv_table(test.file, test.specimen),
                    {.columns = test.columns, .length_mm = test.height_mm, .specimen = test.specimen});
    curve.warnings = record.warnings;
    const std::vector<Cycle> cycles = find_cycles(record);
    if (record.size() < 6 || cycles.empty())
        throw InputError({.file = test.file},
                         fmt::format("has {} rows in which the clamps move; at least 6 are "
                                     "needed",
                                     cycles.empty() ? 0 : record.size()));
    // The branch that is released, as in tension; else the only one there is.
    std::size_t begin = cycles.back().begin;
    std::size_t end = cycles.back().peak + 1;
    for (const Cycle& cycle : cycles) {
        if (!cycle.unloads) continue;
        begin = cycle.unloading();
        end = cycle.end;
    }
    for (std::size_t i = begin; i < end; ++i) {
        curve.strain.push_back(record.displacement[i] / test.height_mm);
        curve.stress.push_back(record.force[i] / (test.width_mm * thickness));
    }
    double largest = 0.0;
    for (const double g : curve.strain) largest = std::max(largest, std::abs(g));
    if (largest > 3.0 || largest < 1e-3)
        throw InputError({.file = test.file},
                         fmt::format("shears the sample by {:.3g}; 0.05 to 1 was expected", largest),
                         "Is the displacement in another unit, is height_mm right, are columns swapped?");
    if (curve.strain.size() < 6)
        throw InputError({.file = test.file, .line = record.line[begin]},
                         fmt::format("its branch has {} rows; at least 6 are needed", curve.strain.size()));
    constexpr double straight = 0.1;
    curve.range = test.largest_strain;
    for (int tenth = 10; tenth >= 2 && test.largest_strain == 0.0; --tenth) {
        curve.range = largest * tenth / 10.0;
        const Window w = window(curve, curve.range);
        if (w.strain.size() >= 6 && bend(w, curve.range) < straight) break;
        if (w.strain.size() < 6) {
            curve.range = largest * (tenth + 1) / 10.0;
            break;
        }
    }
    const Window w = window(curve, curve.range);
    if (w.strain.size() < 4)
        throw InputError({.file = test.file}, fmt::format("has {} rows below a shear strain of {:.3g}",
                                                          w.strain.size(), curve.range));
    const Line line = fit_line(w.strain, w.stress);
    curve.slope = line.slope;
    curve.slope_error = line.slope_error;
    curve.intercept = line.intercept;
    if (line.slope <= 0.0)
        throw InputError({.file = test.file}, "the force does not grow with the shear",
                         "Are columns swapped, or is one of them another quantity?");
    return curve;
}

namespace {

/// Mean of values with standard errors along their own curves.
ShearModulus mean_of(std::span<const double> values, std::span<const double> errors) {
    const Spread s = spread(values);
    double variance = 0.0;
    for (const double e : errors) variance += std::pow(e / s.count, 2.0);
    // Between two tests Student's t with one degree of freedom says next to nothing: twice the standard
    // error.
    const double between = s.count > 1 ? 2.0 * s.deviation / std::sqrt(static_cast<double>(s.count)) : 0.0;
    const double half = std::max(between, 1.96 * std::sqrt(variance));
    return {s.mean, std::max(s.mean - half, 0.0), s.mean + half};
}

/// Slope of the simulated sample's response over that of simple shear.
double simulated_share(const ShearCurve& curve, const Material& material, double modulus) {
    const ShearTest& test = curve.test;
    const std::vector<double> shears = {0.25 * curve.range, 0.5 * curve.range, 0.75 * curve.range,
                                        curve.range};
    const ShearedResponse response = simulate_sheared(
        {.length_mm = test.height_mm, .width_mm = test.width_mm, .angle_deg = test.angle_deg}, material,
        shears);
    std::vector<double> stress;
    stress.reserve(response.force_N.size());
    for (const double force : response.force_N)
        stress.push_back(force / (test.width_mm * material.fabric_thickness));
    if (!response.converged) return 1.0;
    return fit_line(shears, stress).slope / modulus;
}

}  // namespace

ShearModulus mean_slope_of(std::span<const ShearCurve> curves) {
    std::vector<double> values, errors;
    for (const ShearCurve& curve : curves) {
        values.push_back(curve.slope);
        errors.push_back(curve.slope_error);
    }
    return mean_of(values, errors);
}

ShearModulus corrected_shear_modulus(std::span<const ShearCurve> curves, const Material& m) {
    const double own = 1.0 - m.neo_hookean_share;
    const double other =
        m.neo_hookean_share * m.fabric_youngs_modulus / (2.0 * (1.0 + m.fabric_poissons_ratio));
    std::vector<double> values, errors;
    for (const ShearCurve& curve : curves) {
        const double share = simulated_share(curve, m, own * m.alpha_3 + other);
        values.push_back((curve.slope / share - other) / own);
        errors.push_back(curve.slope_error / share / own);
    }
    return mean_of(values, errors);
}

}  // namespace ruche

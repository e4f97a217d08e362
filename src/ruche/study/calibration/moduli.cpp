#include "ruche/study/calibration/moduli.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "ruche/material/consistent_modulus.hpp"
#include "ruche/material/laminate.hpp"
#include "ruche/study/calibration/cycles.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {

PlasticCurve read_plastic_curve(const PlasticTest& test) {
    PlasticCurve curve{.test = test};
    const TestRecord record =
        read_record(read_csv_table(test.file, test.specimen),
                    {.columns = test.columns, .length_mm = test.length_mm, .specimen = test.specimen});
    curve.warnings = record.warnings;
    const std::vector<Cycle> cycles = find_cycles(record);
    if (cycles.empty()) throw InputError({.file = test.file}, "the displacement never changes");
    const Cycle& first = cycles.front();
    const double slack = slack_of(record, first);
    const double zero = record.displacement[first.begin] + (slack > 1e-3 * test.length_mm ? slack : 0.0);
    if (slack > 1e-3 * test.length_mm)
        curve.warnings.push_back(fmt::format("{}: {:.3g} mm of slack were taken off", test.file, slack));
    for (std::size_t i = first.begin; i <= first.peak; ++i) {
        if (record.displacement[i] < zero) continue;
        curve.strain.push_back((record.displacement[i] - zero) / test.length_mm);
        curve.stress.push_back(record.force[i] / (test.width_mm * test.thickness_mm));
    }
    std::vector<double> x, y;
    for (std::size_t i = 0; i < curve.strain.size(); ++i) {
        if (curve.strain[i] > test.window) continue;
        x.push_back(curve.strain[i]);
        y.push_back(curve.stress[i]);
    }
    if (x.size() < 6)
        throw InputError(test.place,
                         fmt::format("{} has {} rows with a strain up to window = {:g}; at least 6 "
                                     "are needed",
                                     test.file, x.size(), test.window),
                         "Record more often or widen the window.");
    const auto count = static_cast<Eigen::Index>(x.size());
    Eigen::MatrixXd a(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        const double e = x[static_cast<std::size_t>(i)] / test.window;
        a.row(i) = Eigen::RowVector3d(1.0, e, e * e);
    }
    const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(y.data(), count);
    const Eigen::Vector3d c = a.colPivHouseholderQr().solve(b);
    const Eigen::Matrix3d normal = a.transpose() * a;
    const double variance = (a * c - b).squaredNorm() / static_cast<double>(count - 3);
    curve.modulus = c[1] / test.window;
    curve.error = std::sqrt(variance * normal.inverse()(1, 1)) / test.window;
    curve.intercept = c[0];
    if (!(curve.modulus > 0.1) || curve.modulus > 1e5)
        throw InputError(
            {.file = test.file},
            fmt::format("gives a Young's modulus of {:.3g} MPa; printed plastics have 10 to 5000",
                        curve.modulus),
            "Is the force or the displacement in another unit, are columns swapped?");
    return curve;
}

/// Mean and spread over orientations of a slope of S over E.
static Spread mean_slope(std::span<const LawCurve> curves, double share) {
    std::map<double, std::vector<double>> by_angle;
    for (const LawCurve& curve : curves) {
        std::vector<double> green, stress;
        const double largest = green_strain(*std::max_element(curve.stretch.begin(), curve.stretch.end()));
        for (std::size_t i = 0; i < curve.stretch.size(); ++i) {
            if (green_strain(curve.stretch[i]) > share * largest) continue;
            green.push_back(green_strain(curve.stretch[i]));
            stress.push_back(curve.nominal_stress[i] / curve.stretch[i]);
        }
        if (green.size() > 2) by_angle[curve.angle_deg].push_back(fit_line(green, stress).slope);
    }
    std::vector<double> slopes;
    slopes.reserve(by_angle.size());
    for (const auto& [angle, values] : by_angle) slopes.push_back(spread(values).mean);
    return spread(slopes);
}

FabricModulus fabric_modulus(std::span<const LawCurve> curves, const Material& material, double prestretch) {
    const Spread secant = mean_slope(curves, 1.0);
    const Spread tangent = mean_slope(curves, 0.2);
    return {.secant = secant.mean,
            .tangent = tangent.mean,
            .working = consistent_fabric_modulus(material, {prestretch, prestretch}),
            .secant_spread = secant.deviation,
            .tangent_spread = tangent.deviation};
}

double strip_curvature(const Material& m, double s, double plastic_thickness) {
    const Mat2 printed = Mat2::Identity();
    const std::vector<Ply> plies = printed_plies({.front = plastic_thickness,
                                                  .fabric = m.fabric_thickness,
                                                  .front_modulus = m.plastic_youngs_modulus,
                                                  .fabric_modulus = m.fabric_youngs_modulus},
                                                 printed, printed / (s * s));
    const FormVector forms = free_forms(plies, m.laminate_poissons_ratio, printed);
    return std::abs(forms[3]) / forms[0];
}

}  // namespace ruche

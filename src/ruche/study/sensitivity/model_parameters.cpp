#include "ruche/study/sensitivity/model_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ruche/core/parallel.hpp"
#include "ruche/geometry/triangle_mesh.hpp"

namespace ruche {
namespace {

constexpr double first_relative_step = 1.0 / 64.0;

void add_material_parameters(const Material& material, std::vector<ModelParameter>& parameters) {
    for (const Field<Material>& field : fields<Material>()) {
        const double size = (1.0 + first_relative_step) * std::get<double>(get(material, field));
        if (size < field.low || size > field.high) continue;  // no value on one of its sides
        parameters.push_back({.name = "material." + std::string(field.key),
                              .unit = std::string(field.unit),
                              .value = std::get<double>(get(material, field)),
                              .scale = [&field](ModelInput& input, double factor) {
                                  const double value = std::get<double>(get(input.material, field));
                                  set(input.material, field, factor * value);
                              }});
    }
}

void add_prestretch(const std::array<double, 2>& s, std::vector<ModelParameter>& parameters) {
    parameters.push_back({.name = "fabric.prestretch",
                          .value = std::sqrt(s[0] * s[1]),
                          .scale = [](ModelInput& input, double factor) {
                              for (double& axis : input.prestretch) axis *= factor;
                          }});
    for (std::size_t i = 0; i < 2; ++i) {
        parameters.push_back(
            {.name = "fabric.prestretch." + std::to_string(i + 1),
             .value = s[i],
             .scale = [i](ModelInput& input, double factor) { input.prestretch[i] *= factor; }});
    }
}

/// Mean of a value over the printed area, of those that are not 0; 0 without any.
double mean_over_print(const ModelInput& input, double Print::*front, double Print::*back) {
    double sum = 0.0;
    double area = 0.0;
    for (int t = 0; t < static_cast<int>(input.print.size()); ++t) {
        for (double Print::*side : {front, back}) {
            const double value = input.print[static_cast<std::size_t>(t)].*side;
            if (value == 0.0) continue;
            sum += value * layout_area(input.mesh, t);
            area += layout_area(input.mesh, t);
        }
    }
    return area > 0.0 ? sum / area : 0.0;
}

double mean_over_rods(const std::vector<Rod>& rods, double Rod::*member) {
    double sum = 0.0;
    int count = 0;
    for (const Rod& rod : rods) {
        sum += rod.*member;
        count += rod.*member != 0.0 ? 1 : 0;
    }
    return count > 0 ? sum / count : 0.0;
}

void add_prints(const ModelInput& input, std::vector<ModelParameter>& parameters) {
    const bool rods = !input.rods.empty();
    parameters.push_back({.name = "plastic.thickness_mm",
                          .unit = "mm",
                          .value = rods ? mean_over_rods(input.rods, &Rod::thickness)
                                        : mean_over_print(input, &Print::front, &Print::back),
                          .scale = [](ModelInput& changed, double factor) {
                              for (Print& print : changed.print) print.front *= factor, print.back *= factor;
                              for (Rod& rod : changed.rods) rod.thickness *= factor;
                          }});
    parameters.push_back({.name = "plastic.rule.youngs_modulus_mpa",
                          .unit = "MPa",
                          .value = rods ? mean_over_rods(input.rods, &Rod::youngs_modulus)
                                        : mean_over_print(input, &Print::front_modulus, &Print::back_modulus),
                          .scale = [](ModelInput& changed, double factor) {
                              for (Print& print : changed.print)
                                  print.front_modulus *= factor, print.back_modulus *= factor;
                              for (Rod& rod : changed.rods) rod.youngs_modulus *= factor;
                          }});
}

/// p d(grad W)/dp with the relative step `step`.
Eigen::ArrayXd gradient_difference(const Model& model, const Eigen::VectorXd& x,
                                   const ModelParameter& parameter, double step) {
    std::array<Eigen::VectorXd, 2> gradients;
    parallel_for(2, [&](std::size_t side) {
        ModelInput input = model.input();
        parameter.scale(input, side == 0 ? 1.0 + step : 1.0 - step);
        Model changed(std::move(input));
        if (!model.contacts().empty()) changed.set_contacts(model.contacts());
        gradients[side] = changed.gradient(x);
    });
    return (gradients[0] - gradients[1]).array() / (2.0 * step);
}

}  // namespace

std::vector<ModelParameter> model_parameters(const ModelInput& input) {
    std::vector<ModelParameter> parameters;
    add_prestretch(input.prestretch, parameters);
    add_prints(input, parameters);
    add_material_parameters(input.material, parameters);
    std::erase_if(parameters, [](const ModelParameter& parameter) { return parameter.value == 0.0; });
    return parameters;
}

GradientChange gradient_change(const Model& model, const Eigen::VectorXd& x,
                               const ModelParameter& parameter) {
    constexpr double shrink = 0.25;
    // The last one is 9e-10: fabric at the end of its law, whose extension is 1e-6 wide, needs small ones.
    constexpr int most_steps = 13;
    constexpr std::size_t highest_order = 4;  // of the extrapolation, in squared steps
    // What rounding leaves of forces that cancel, and more than enough for slopes that a person reads.
    const double rounding = 1e-12 * model.typical_force(x);
    constexpr double enough = 1e-10;

    std::vector<Eigen::ArrayXd> previous;
    Eigen::ArrayXd best;
    Eigen::ArrayXd error;
    double step = first_relative_step;
    for (int round = 0; round < most_steps; ++round, step *= shrink) {
        std::vector<Eigen::ArrayXd> row = {gradient_difference(model, x, parameter, step)};
        if (round == 0) {
            best = row[0];
            error = Eigen::ArrayXd::Constant(best.size(), infinity);
        }
        double ratio = 1.0;
        for (std::size_t order = 0; order < std::min(previous.size(), highest_order); ++order) {
            ratio /= shrink * shrink;
            row.emplace_back(row[order] + (row[order] - previous[order]) / (ratio - 1.0));
            const Eigen::ArrayXd change =
                (row[order + 1] - row[order]).abs().max((row[order + 1] - previous[order]).abs());
            best = (change < error).select(row[order + 1], best);
            error = error.min(change);
        }
        if (error.maxCoeff() <= rounding + enough * best.abs().maxCoeff()) break;
        previous = std::move(row);
    }
    return {.gradient = best.matrix(), .error = error.maxCoeff()};
}

}  // namespace ruche

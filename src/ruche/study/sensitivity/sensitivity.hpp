#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/scene/result.hpp"
#include "ruche/study/sensitivity/shape_measures.hpp"

namespace ruche {

/// A parameter of a scene as a table of sensitivities has it.
struct SensitivityParameter {
    std::string name;
    std::string unit;
    double value = 0.0;
    /// Half of the interval that the material card gives for it, over the value; none where the card has none
    /// or the scene has another value.
    std::optional<double> uncertainty;
    /// Estimated error of the derivative of the forces, over its largest component.
    double error = 0.0;
};

/// How a released shape depends on the parameters of its scene.
struct Sensitivities {
    std::vector<SensitivityParameter> parameters;
    std::vector<ShapeMeasure> measures;
    /// d ln measure / d ln parameter; one row per measure, one column per parameter. NaN where a measure is 0
    /// or has no derivative.
    Eigen::MatrixXd slopes;

    /// Uncertainty of a measure, over its value, from those of all parameters taken as independent (root of
    /// the sum of squares); none without any.
    std::optional<double> uncertainty(int measure) const;
};

/// Through the equilibrium by implicit differentiation, nothing is solved again: the exact Hessian at the
/// shape answers to what each parameter changes in the forces (ShapeResponse), and the measures follow the
/// vertices. None for a shape that is no strict minimum.
std::optional<Sensitivities> sensitivities(const Result& result, const Control& control = {});

/// As JSON: parameters, measures and all slopes (NaN becomes null).
std::string sensitivity_json(const Sensitivities& found, const std::string& scene);

}  // namespace ruche

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// A number that the energy of a sheet depends on.
struct ModelParameter {
    std::string name;  ///< as a scene has it: "material.alpha_1_mpa"
    std::string unit;
    double value = 0.0;                              ///< never 0
    std::function<void(ModelInput&, double)> scale;  ///< multiplies it by a factor
};

/// All of them: every number of the material, the pre-stretch along both axes and along each, the thickness
/// of all prints (its mean over what is printed; or of all rods), and the modulus of prints that have one of
/// their own. Those that are 0 have no relative change, those at the end of their range a value on one side
/// only: they are left out.
std::vector<ModelParameter> model_parameters(const ModelInput& input);

/// p d(grad W)/dp, N, at fixed x.
struct GradientChange {
    Eigen::VectorXd gradient;
    double error = 0.0;  ///< estimate, of its largest component
};

/// By central differences of the gradient in p, extrapolated to a step of 0 component by component (Ridders
/// 1982): the dependence on p at fixed x is explicit, nothing is solved for. Exact but for rounding where
/// the energy is linear in p.
GradientChange gradient_change(const Model& model, const Eigen::VectorXd& x, const ModelParameter& parameter);

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <vector>

#include "ruche/energy/model.hpp"
#include "ruche/statics/newton_system.hpp"

namespace ruche {

/// How an equilibrium answers to a small change of its forces. At rest grad W(x, p) = 0, so that with the
/// exact Hessian H
///
///     H dx/dp = -d(grad W)/dp   (at fixed x),
///
/// free rigid motions left out and held unknowns at rest, both as the certificate of an equilibrium does.
class ShapeResponse {
  public:
    /// Factorises the Hessian at `x`. Both must outlive this. Throws std::bad_alloc.
    ShapeResponse(const Model& model, const Eigen::VectorXd& x);

    /// Whether `x` is a strict minimum modulo free rigid motions. Only then is there an answer.
    bool stable() const { return stable_; }

    /// Velocities of all unknowns, one column for each change of the gradient. The part that is a free rigid
    /// motion is arbitrary.
    Eigen::MatrixXd velocities(Eigen::MatrixXd gradient_changes);

  private:
    std::vector<char> held_;
    NewtonSystem system_;
    bool stable_ = false;
};

}  // namespace ruche

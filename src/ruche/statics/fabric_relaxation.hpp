#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "ruche/energy/model.hpp"
#include "ruche/statics/sparse_cholesky.hpp"

namespace ruche {

/// Brings the bare fabric between strips to its own equilibrium while the plastic stays where it is. Fabric
/// is soft and its law far from linear: carried over from a coarser mesh it pulls in wrong directions, and a
/// Newton step of the whole sheet moves the strips after it, along ways on which the sheet hardly resists.
/// The fabric alone falls into small pieces between strips and costs a small part of a factorisation of the
/// sheet.
class FabricRelaxation {
  public:
    /// `held`: one flag per unknown that does not move anyway; `vertex_order`: an elimination order of all
    /// vertices. Both need not stay. Throws std::bad_alloc.
    FabricRelaxation(const Model& model, std::span<const char> held, std::span<const int> vertex_order);

    /// Moves x by a few Newton steps. `model` is the one given to the constructor or differs from it in the
    /// material only. What is in `scratch` is lost: its memory is as large as a solve of the sheet needs.
    void operator()(const Model& model, Eigen::VectorXd& x, AssembledSums& scratch);

  private:
    bool solve(const Model& model, const Eigen::VectorXd& x, AssembledSums& sums, const Eigen::VectorXd& pull,
               Eigen::VectorXd& displacement);

    std::vector<int> unknowns_;  // of the model
    std::vector<int> value_;     // where each of the matrix's values stands in the model's Hessian
    std::optional<SparseCholesky> cholesky_;  // none without such fabric, or without plastic
    std::vector<double> matrix_;
};

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "ruche/energy/model.hpp"
#include "ruche/statics/supernodal_factor.hpp"

namespace ruche {

/// Sparse Cholesky factorisation: analysed once, factorised many times.
class SparseCholesky {
  public:
    /// `elimination_order[k]` is the unknown that is eliminated k-th. Throws std::bad_alloc.
    SparseCholesky(const SymmetricPattern& pattern, std::vector<int> elimination_order);

    /// For a model's Hessian. Vertices are eliminated in the given order, and each edge unknown right before
    /// the first of its four vertices, where it causes no fill of its own. Throws std::bad_alloc.
    SparseCholesky(const Model& model, std::span<const int> vertex_order);

    /// For a matrix of blocks: their graph, its pattern by unknowns, and the node that is eliminated k-th.
    /// Throws std::bad_alloc.
    SparseCholesky(const NodeGraph& graph, const SymmetricPattern& pattern, std::vector<int> node_order);

    /// False when the matrix is not positive definite (or not finite). Throws std::bad_alloc.
    [[nodiscard]] bool factorize(std::span<const double> values) { return factor_.factorize(values); }

    /// The same, and solves for one right-hand side, which is cheaper than to do it afterwards.
    [[nodiscard]] bool factorize_and_solve(std::span<const double> values,
                                           const Eigen::VectorXd& right_hand_side,
                                           Eigen::VectorXd& solution) {
        return factor_.factorize_and_solve(values, right_hand_side, solution);
    }

    /// Solves with the last successful factor; one column per right-hand side.
    Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_side) const {
        return factor_.solve(right_hand_side);
    }

    /// Makes solves faster and less exact until the next factorisation, see SupernodalFactor::narrow.
    void narrow() { factor_.narrow(); }

    double factor_megabytes() const {
        return static_cast<double>(factor_.structure().value_count()) * sizeof(double) / 1e6;
    }

  private:
    SupernodalFactor factor_;
};

/// The name of the processor whose dense kernels BLAS has chosen, such as "Zen".
std::string blas_kernels();

/// Nested dissection (METIS) of a graph given as adjacency lists in compressed rows (both directions, no
/// loops). Throws std::bad_alloc, or std::runtime_error where METIS gives up.
std::vector<int> nested_dissection(std::span<const int> start, std::span<const int> neighbours);

/// Elimination order of the vertices: nested dissection of the pattern's vertex graph.
std::vector<int> vertex_elimination_order(const NodePattern& pattern);

}  // namespace ruche

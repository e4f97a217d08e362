#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// The lower triangle of a symmetric matrix in compressed columns, rows ascending; entries above the diagonal
/// are ignored. Only the structure: values come with each factorisation.
struct SymmetricPattern {
    int size = 0;
    std::span<const int> column_start;
    std::span<const int> row_index;
};

/// Supernodal Cholesky factorisation (CHOLMOD): analysed once, factorised many times.
class SparseCholesky {
  public:
    /// `elimination_order[k]` is the unknown that is eliminated k-th. Throws std::bad_alloc.
    SparseCholesky(const SymmetricPattern& pattern, std::vector<int> elimination_order);
    ~SparseCholesky();
    SparseCholesky(SparseCholesky&&) noexcept;
    SparseCholesky& operator=(SparseCholesky&&) noexcept;

    /// False when the matrix is not positive definite (or not finite). Throws std::bad_alloc.
    [[nodiscard]] bool factorize(std::span<const double> values);

    /// Solves with the last successful factor; one column per right-hand side.
    Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_side);

    double factor_megabytes() const;

  private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

/// Threads of the dense kernels of factorisations that begin later, in the whole process; 1 until it is
/// called. More than one pays on large sheets and an idle machine only (they spin while they wait for each
/// other), and the last bits of a factor depend on their number.
void set_blas_threads(int count);

/// Nested dissection (METIS) of a graph given as adjacency lists in compressed rows (both directions, no
/// loops).
std::vector<int> nested_dissection(std::span<const int> start, std::span<const int> neighbours);

/// Elimination order of the vertices: nested dissection of the pattern's vertex graph.
std::vector<int> vertex_elimination_order(const NodePattern& pattern);

/// Elimination order of a model's unknowns: that of the vertices, and each edge unknown right before the
/// first of its four vertices, where it causes no fill of its own.
std::vector<int> elimination_order(const Model& model, std::span<const int> vertex_order);

}  // namespace ruche

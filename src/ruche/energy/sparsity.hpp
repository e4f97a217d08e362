#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace ruche {

/// The fixed sparsity pattern of the Hessian, made of dense blocks between nodes: a vertex is a node of three
/// unknowns, an edge unknown a node of one. Only blocks with row node >= column node are stored (lower
/// triangle; the diagonal blocks are stored whole), in compressed columns, so that all columns of a node have
/// the same rows.
class NodePattern {
  public:
    /// Blocks exist between every two nodes that appear in one of `cliques` (flattened; -1 = none, `width`
    /// per clique).
    struct Cliques {
        std::vector<int> nodes;
        int width = 1;
    };
    NodePattern(int vertex_count, int edge_unknown_count, std::span<const Cliques> cliques);
    NodePattern() = default;

    int node_count() const { return static_cast<int>(column_length_.size()); }
    int vertex_count() const { return vertex_count_; }
    int unknown_count() const { return static_cast<int>(column_start_.size()) - 1; }
    int first_unknown(int node) const { return node < vertex_count_ ? 3 * node : node + 2 * vertex_count_; }
    int node_size(int node) const { return node < vertex_count_ ? 3 : 1; }

    /// Row nodes (>= node) of a node's columns, ascending, the node itself first.
    std::span<const int> rows_of(int node) const {
        return {row_nodes_.data() + row_start_[node], row_nodes_.data() + row_start_[node + 1]};
    }

    /// The graph of the nodes itself in compressed columns: rows of all nodes one after the other, and where
    /// each node's begin.
    const std::vector<int>& row_nodes() const { return row_nodes_; }
    const std::vector<int>& row_start() const { return row_start_; }

    /// Where the block (row node, column node) begins in the values; its entry (r, c) lies at + r + c *
    /// column_length.
    int block_offset(int row_node, int column_node) const;
    int column_length(int node) const { return column_length_[node]; }

    const std::vector<int>& column_start() const { return column_start_; }
    const std::vector<int>& row_index() const { return row_index_; }

    /// The full symmetric matrix from values of this pattern.
    Eigen::SparseMatrix<double> full_matrix(std::span<const double> values) const;

    /// The product of that matrix and a vector, in one pass over the values.
    Eigen::VectorXd product(std::span<const double> values, const Eigen::VectorXd& x) const;

  private:
    int vertex_count_ = 0;
    std::vector<int> row_start_, row_nodes_;  // node graph, lower triangle, by column node
    std::vector<int> column_length_;          // unknowns per column, by node
    std::vector<int> column_start_, row_index_;
};

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ruche/statics/supernodal_structure.hpp"

namespace ruche {

/// Solves L L^T x = b with the panels of a supernodal factor, in parts: subtrees on different threads, then
/// the supernodes above them, then all the way back. A factorisation that is under way can so take each panel
/// while it is still near the processor. Sums are made in the same order at any number of threads.
///
/// `Scalar` is the precision of the panels and of the work, double or float.
template <class Scalar>
class TriangularSolve {
  public:
    /// `values`: where the panels are, numbers of type Scalar, each panel beginning at its panel_start. One
    /// column of b per right-hand side. All of it but b has to stay.
    TriangularSolve(const SupernodalStructure& structure, const TreeSplit& tree, const double* values,
                    const Eigen::MatrixXd& b);

    /// The forward half, for one supernode of a subtree: its panel has to be ready. `worker`: see
    /// parallel_for_workers.
    void forward_in_subtree(int subtree, int supernode, int worker);
    /// After the last supernode of a subtree.
    void leave_subtree(int subtree, int worker);
    /// After the last subtree.
    void leave_subtrees();
    /// The forward half, for one of the supernodes above all subtrees.
    void forward_at_top(int supernode) { forward(supernode, structure_.size(), 0); }

    /// All of the forward half.
    void forward();
    /// The backward half; gives x.
    Eigen::MatrixXd backward();

  private:
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

    struct Panel {
        const Scalar* values;
        int columns, stride, below;  // `below` rows after those of its own columns
        const int* rows_below;
    };
    Panel panel(int s) const;
    void fetch(int s) const;
    std::span<const int> rows_above(int subtree) const;
    void forward(int s, int last_inside, int worker);
    void backward(int s, int worker);

    const SupernodalStructure& structure_;
    const TreeSplit& tree_;
    const double* values_;
    Matrix y_;                      // in the order of elimination
    std::vector<Matrix> gathered_;  // rows of one supernode, per worker
    std::vector<Matrix> outside_;   // what a subtree takes from the rows above it, per worker
    std::vector<Matrix> shares_;    // the same of each subtree
};

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "ruche/statics/supernodal_structure.hpp"
#include "ruche/statics/triangular_solve.hpp"

namespace ruche {

/// Numeric Cholesky factorisation A = L L^T on a given structure, left-looking: every supernode gathers the
/// updates of those below it, then factors its panel (Ng, Peyton 1993; Rothberg, Gupta 1994).
///
/// Subtrees of the elimination tree that do not touch each other run on different threads; at the large
/// supernodes above them all threads work together, tile by tile. Subtrees and tiles do not depend on the
/// number of threads, nor does the order of the sums, so the bits of L do not either. The dense kernels are
/// BLAS's, on one thread each.
class SupernodalFactor {
  public:
    /// `pattern`: of A, as it was analysed, with nodes of so many unknowns. The unknowns of a node have the
    /// same rows in it, those of whole nodes.
    SupernodalFactor(SupernodalStructure structure, const SymmetricPattern& pattern,
                     std::span<const int> node_sizes);

    /// `values`: of A on its pattern. False when A is not positive definite (or not finite); what was
    /// factorised before is lost then. Throws std::bad_alloc.
    [[nodiscard]] bool factorize(std::span<const double> values);

    /// The same, and x = A^-1 b: panels need not be fetched from memory once more for the forward half.
    [[nodiscard]] bool factorize_and_solve(std::span<const double> values, const Eigen::VectorXd& b,
                                           Eigen::VectorXd& x);

    /// A^-1 b after a successful factorisation; one column per right-hand side.
    Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

    /// Rounds L to single precision until the next factorisation. Solves then read half as many bytes, which
    /// is what they take their time for, and give A^-1 b up to a relative error of about 6e-8 sqrt(cond A) in
    /// the norm of A: enough for a preconditioner.
    void narrow();

    const SupernodalStructure& structure() const { return structure_; }

  private:
    /// Rows [begin, end) of a supernode's panel are columns of one that is eliminated later.
    struct Update {
        int from;
        int begin, end;
    };
    /// A's block between two nodes, column-major.
    struct Block {
        int source;         // of its first value in A's values
        int source_stride;  // to the next column there
        int target;         // of that value in the panel
        short rows, columns;
        bool transposed;  // in the panel: its row's node is eliminated first
    };
    /// What one thread works with.
    struct Workspace {
        std::vector<int> position;    // of a row in the panel at work
        std::vector<double> product;  // of one update
    };

    void list_blocks(const SymmetricPattern& pattern, std::span<const int> node_sizes);
    void list_updates();
    void split_tree();

    double* panel(int s) { return values_.get() + structure_.panel_start[s]; }
    double work(int s) const;
    void place_blocks(int s, std::span<const double> values);
    void gather_updates(int s, int first_column, int last_column, Workspace& workspace);
    bool factor_alone(int s, std::span<const double> values, Workspace& workspace);
    bool factor_together(int s, std::span<const double> values);

    void make_room();
    bool factorize(std::span<const double> values, TriangularSolve<double>* solve);

    SupernodalStructure structure_;
    std::unique_ptr<double[]> values_;  // all panels; none before the first factorisation
    bool narrow_ = false;               // the panels are in single precision, in half of the room
    std::vector<int> supernode_of_column_;
    std::vector<int> first_block_;
    std::vector<Block> blocks_;  // by supernode
    std::vector<int> first_update_;
    std::vector<Update> updates_;  // by supernode that receives them
    TreeSplit tree_;
    std::vector<Workspace> workspaces_;  // per thread that takes part, see parallel_for_workers
};

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ruche/energy/model.hpp"
#include "ruche/statics/rigid_motions.hpp"
#include "ruche/statics/sparse_cholesky.hpp"

namespace ruche {

/// A state of a sheet with the derivatives of its energy there.
struct NewtonPoint {
    const Model& model;
    const Eigen::VectorXd& x;
    const AssembledSums& sums;  ///< as far as `order` says
    Order order = Order::hessian;
};

/// The linear systems of Newton's method for one sheet and their factors: its pattern is analysed once, and
/// again only when contacts change it.
class NewtonSystem {
  public:
    /// rms rotation of a step, rad: those that come after a shorter one are solved with the last factor in a
    /// few iterations, others seldom.
    static constexpr double nearly_at_rest = 0.0015;

    /// `held`: one flag per unknown that does not move; it has to stay. `loaded`: supports or forces hold the
    /// sheet. `vertex_order`: see sparse_cholesky.hpp.
    NewtonSystem(const Model& model, const std::vector<char>& held, bool loaded,
                 const std::vector<int>& vertex_order);

    /// What the next exact step needs in `at.sums`, after a step that turned the sheet by `rotation` (rms,
    /// rad); with another Hessian there it takes longer.
    Order wanted(double rotation) const;

    /// Newton's step with the exact Hessian. While the sheet hardly turns (`rotation`, rms of the last step,
    /// rad) by conjugate gradients on the last factor, if that is quick, and no further than a residual of
    /// `tolerance` (N) asks for. Where the Hessian is not positive definite, fabric is
    /// about to buckle: then with a mean of it and the Gauss-Newton form; the latter's share is kept from
    /// step to step. On its own that form knows nothing of the compression that makes fabric buckle, and a
    /// barely definite matrix runs far along the buckling shapes.
    ///
    /// In a sheet that supports or loads hold, geometric stiffness is what resists (a pendulum has no other),
    /// and the Gauss-Newton form lacks it: there a multiple of the identity is added, little more than it
    /// takes.
    ///
    /// False when no matrix could be factorised. Throws std::bad_alloc.
    [[nodiscard]] bool exact_step(const NewtonPoint& at, double rotation, double tolerance,
                                  Eigen::VectorXd& step);

    /// The step with the Gauss-Newton form, which `at.sums` holds.
    [[nodiscard]] bool gauss_newton_step(const NewtonPoint& at, Eigen::VectorXd& step);

    /// Whether the state is a strict minimum modulo free rigid motions: the exact Hessian, which `at.sums`
    /// holds, has a Cholesky factor.
    [[nodiscard]] bool certify(const NewtonPoint& at);

    /// Solves with the last matrix that could be factorised; one column per right-hand side.
    Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_side) { return cholesky_.solve(right_hand_side); }

    /// A direction in which the exact Hessian curves down most, by inverse iteration from `direction`.
    [[nodiscard]] bool steepest_curvature(const NewtonPoint& at, Eigen::VectorXd& direction);

    /// After the line search of an exact step: one that had to halve the step asks for more of the
    /// Gauss-Newton form in the next matrix, one that had not for less.
    void adapt(bool halved);

    /// What the last Gauss-Newton step has left is too rough for the exact Hessian: the next matrix has a
    /// share of that form at once, which falls slowly.
    void expect_indefinite();

    /// The model's pattern is another one from now on.
    void change_pattern() { pattern_is_new_ = true; }

    int factorizations() const { return factorizations_; }
    double factor_megabytes() const { return cholesky_.factor_megabytes(); }

    /// Says so when the factor and the matrices that go with it do not fit into memory, or the process would
    /// grow beyond `limit_mb` (0 = no limit); else empty.
    std::string missing_memory(const Model& model, double limit_mb) const;

  private:
    Order form() const { return share_ > 0.0 ? Order::mean(share_) : Order::hessian; }
    bool may_use_last_factor(double rotation) const { return factor_is_near_ && rotation < nearly_at_rest; }
    void build_matrix(const NewtonPoint& at, double shift);
    bool factorize(const NewtonPoint& at, double shift = 0.0, Eigen::VectorXd* step = nullptr);
    bool step_with_mean(const NewtonPoint& at, Eigen::VectorXd& step);
    bool solve_with_last_factor(const NewtonPoint& at, double tolerance, Eigen::VectorXd& step);

    const std::vector<char>& held_;
    bool loaded_;
    RigidMotions rigid_;
    SparseCholesky cholesky_;
    std::vector<double> matrix_;
    AssembledSums mean_;
    bool after_gauss_newton_ = false;  // the last step was, and no exact one has been taken since
    bool rough_ = false;               // expected to be, and no exact step has been taken since
    bool pattern_is_new_ = false;      // since the last factorisation
    bool factor_is_near_ = false;      // the last factor is of an exact Hessian
    double shift_ = 0.0;               // of the last indefinite Hessian, N/mm
    double share_ = 0.0;               // of the Gauss-Newton form in the matrix
    int factorizations_ = 0;
};

/// One flag per unknown: a support holds it.
std::vector<char> held_unknowns(const Model& model);

/// Whether supports or forces hold the sheet.
bool is_loaded(const ModelInput& sheet);

/// Mean magnitude of the diagonal of a Hessian, N/mm.
double mean_stiffness(const NodePattern& pattern, const std::vector<double>& hessian);

/// Whether every component of the gradient is below `tolerance` (N) or below what the last digits of the
/// positions decide, eps sum_j |H_ij| |x_j|: where fabric leans on the steep end of its law that may be more.
/// Any form of the Hessian tells how large it is.
bool at_rest_or_rounded(const NewtonPoint& at, double tolerance);

}  // namespace ruche

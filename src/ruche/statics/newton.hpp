#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/statics/contact_guard.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/statics/newton_system.hpp"
#include "ruche/statics/nonlinear_elimination.hpp"
#include "ruche/statics/retraction.hpp"
#include "ruche/statics/sheet_piece.hpp"

namespace ruche {

/// Newton's method for one sheet: steps along the rotation-strain retraction, with the Gauss-Newton form
/// while the sheet turns and the exact Hessian after; leaves saddles; ends with the certificate. For
/// equilibrium.cpp.
class Newton {
  public:
    /// `model`, `control`: have to stay. Throws std::bad_alloc.
    Newton(const Model& model, const SolveOptions& options, const Control& control);
    Newton(const Newton&) = delete;  // its parts refer to one another
    Newton& operator=(const Newton&) = delete;

    /// Tells how large the system of equations is.
    void announce() const;

    /// From a state to where it leads. A stop, limits of time and memory, and failures stand in the result.
    Equilibrium run(const Eigen::VectorXd& start);

    /// For a piece of a sheet: its rim may hold it as firmly as it likes, it is no load.
    Newton(const SheetPiece& piece, bool loaded, const SolveOptions& options, const Control& control);

    /// Brings a piece nearer to equilibrium, from its state: some steps, until one hardly turns it any more;
    /// none when there is not enough memory.
    Eigen::VectorXd settle(const Eigen::VectorXd& start);

    /// The start that a shape on another mesh of the layout makes.
    Eigen::VectorXd carried_over(const LayoutShape& start);

    /// From now on no step turns the sheet far, and shorter ones are tried before one leads into a tangle.
    void be_wary() {
        wary_ = true;
        settles_places_ = false;
    }

    /// The last state of all runs that is no tangle; empty when there was none.
    const Eigen::VectorXd& last_good() const { return last_good_; }

  private:
    /// rms rotation of a step, rad: above it the sheet is "turning" and the Gauss-Newton form is the better
    /// model.
    static constexpr double turning = 0.05;
    static constexpr double wary_turn = 0.3;  // rad, rms: how far a wary step may turn the sheet

    Newton(const Model& model, std::vector<char> held, bool loaded, const SolveOptions& options,
           const Control& control, const std::vector<int>& vertex_order);
    const Model& model() const { return own_ ? *own_ : *original_; }
    NewtonPoint here() const { return {model(), x_, sums_, order_}; }
    EnergyTerms evaluate(const Eigen::VectorXd& x, Order order, AssembledSums& sums) const;
    void evaluate(Order order);
    double residual() const { return sums_.gradient.cwiseAbs().maxCoeff(); }
    bool is_good(const Eigen::VectorXd& x) const;
    bool may_take(const Eigen::VectorXd& x) const { return !wary_ || is_good(x); }
    double largest_turn() const;

    void iterate(Equilibrium& result);
    bool step(bool exact);
    bool must_stop(Equilibrium& result, int first_iteration) const;
    bool narrow_extension();
    ClearPath follow(const Eigen::VectorXd& direction, double length);
    void cover_contacts(const Eigen::VectorXd& x);
    bool line_search(Order wanted_next);
    void relax_spots();
    void settle_places(Eigen::VectorXd& x);
    void smooth();
    void relax_while(Eigen::VectorXd& x, double worth);
    bool leave_saddle();
    void report() const;

    const Model* original_;
    std::optional<Model> own_;  // the same sheet with the narrower extension of the law, or with contacts
    std::optional<ContactGuard> contact_;
    SolveOptions options_;
    const Control& control_;
    std::vector<char> held_;         // per unknown: it does not move
    bool loaded_;                    // supports or forces hold the sheet
    std::vector<int> vertex_order_;  // of elimination
    Retraction retraction_;
    NewtonSystem system_;
    NonlinearElimination elimination_;

    Eigen::VectorXd x_;
    Eigen::VectorXd step_;
    AssembledSums sums_;
    Order order_ = Order::gradient;  // of `sums_`
    AssembledSums trial_;
    EnergyTerms trial_terms_;
    Order trial_order_ = Order::gradient;
    Eigen::VectorXd trial_at_;  // where `trial_` has a Hessian; empty when it has none
    EnergyTerms terms_;
    bool halved_ = false;                   // the last line search had to
    double rotation_ = infinity;            // rms of the last step
    bool settles_places_ = false;           // where few bend
    std::vector<std::vector<int>> places_;  // that the last step has bent, if few only
    int iterations_ = 0;
    std::vector<double> residuals_;  // of all runs
    bool wary_ = false;
    Eigen::VectorXd last_good_;
};

}  // namespace ruche

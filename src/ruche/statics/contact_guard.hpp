#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "ruche/energy/contact_search.hpp"
#include "ruche/energy/model.hpp"

namespace ruche {

/// Whether any two triangles pass through each other.
bool passes_through_itself(const Model& model, const Eigen::VectorXd& x);

/// A curve of states x(t), t >= 0.
using StateCurve = std::function<Eigen::VectorXd(double)>;

/// The part of a curve that a sheet can go without passing through itself; or all of it where nobody minds.
/// Clear means: on the straight ways between some states on the curve, close together. The states themselves
/// lie on the curve, because the chord of a turn strains a sheet by far more than a step is to gain.
class ClearPath {
  public:
    explicit ClearPath(StateCurve curve) : curve_(std::move(curve)), times_{1.0} {}
    /// Follows `curve` from `start` = curve(0) to t = 1 in so many pieces, as far as the way is clear; both
    /// `search` and what `curve` refers to must outlive this.
    ClearPath(const ContactSearch& search, const Eigen::VectorXd& start, StateCurve curve, int pieces);

    double end() const { return times_.back(); }  ///< at most 1
    /// The state at t, or one a little before it; 0 <= t <= end().
    Eigen::VectorXd at(double t) const;

  private:
    bool go_on_to(double t);

    StateCurve curve_;
    const ContactSearch* search_ = nullptr;
    std::vector<double> times_;
    std::vector<Eigen::VectorXd> states_;
};

/// Keeps a sheet from passing through itself while it is solved for.
class ContactGuard {
  public:
    explicit ContactGuard(const Model& model);

    /// The clear part of a curve that starts at `x` and turns the sheet by `rotation` (rms, rad) until t = 1.
    ClearPath follow(const Eigen::VectorXd& x, const StateCurve& curve, double rotation) const;
    /// Whether the straight way is clear.
    bool clear(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;

    /// Whether any two parts are within reach of each other.
    bool touches(const Eigen::VectorXd& x) const { return !search_.pairs(x, 1.0).empty(); }

    /// Makes sure that the model knows every pair within reach at `to`. Where it does not, it gets all pairs
    /// that are nearly within reach there or at `from`; true then: its pattern is another one.
    bool cover(Model& model, const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;

  private:
    ContactSearch search_;
};

}  // namespace ruche

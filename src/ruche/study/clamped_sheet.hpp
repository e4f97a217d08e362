#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// A flat sheet in a testing machine: everything at its smallest x is held by one clamp, everything at its
/// largest x by another, across as well as along; the second clamp moves in the sheet's plane. The sheet
/// stays in that plane: what is looked for is the in-plane equilibrium, not the wrinkles that may ride on it.
class ClampedSheet {
  public:
    /// An equilibrium at one place of the moving clamp.
    struct State {
        Vec2 displacement = Vec2::Zero();  ///< of the moving clamp from the sheet's rest, mm
        Eigen::VectorXd x;                 ///< positions row by row, mm
        Vec2 force = Vec2::Zero();         ///< that the moving clamp exerts on the sheet, N
        double mid_width = 0.0;            ///< across the displacement's x, half-way between the clamps, mm
        bool converged = false;            ///< a certified strict minimum
    };

    /// `sheet`: mesh, print, material and axis; pre-stretch 1, no supports, no loads.
    explicit ClampedSheet(ModelInput sheet);

    /// The equilibrium with the second clamp moved by `displacement`, found from nearby ones (the states of
    /// the last calls).
    [[nodiscard]] State hold(const Vec2& displacement);

  private:
    ModelInput held_at(const Vec2& displacement) const;
    Eigen::VectorXd start(const Vec2& displacement) const;
    double mid_width(const Eigen::VectorXd& x) const;

    ModelInput sheet_;
    std::vector<char> fixed_clamp_, moving_clamp_;  // per vertex
    std::vector<std::array<int, 2>> border_;        // edges with one triangle
    std::optional<State> last_, before_last_;
};

/// The rectangle between two clamps that face each other along x, at least two elements across.
TriangleMesh clamped_rectangle(double length_mm, double width_mm, double element_size_mm);

}  // namespace ruche

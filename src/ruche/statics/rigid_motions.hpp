#pragma once

#include <Eigen/Core>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// One direction of one vertex that is held during a linear solve, so that the matrix has an inverse.
struct GaugeDirection {
    int vertex;
    Vec3 direction;  ///< unit
};

/// The rigid motions of each connected piece that neither supports, table nor gravity resist, removed one by
/// one: each returned direction stops exactly one of them (six for a free piece: 3 at a vertex, 2 at a
/// second, 1 at a third; three on a table; one for a piece that hangs from a pin; none when clamped).
///
/// Stiffness added along these directions changes neither the solution of Newton's system (the free rigid
/// motion takes it up) nor whether the matrix is positive definite modulo the free motions; unlike pinned
/// coordinates they hold no reaction, because they act on the step and not on the position.
class RigidMotions {
  public:
    explicit RigidMotions(const Model& model);

    /// What is taken to resist a rigid motion: an exact Hessian knows of gravity, the table and dead forces,
    /// a Gauss-Newton one of supports only (loads resist rotations through the geometric stiffness, which it
    /// lacks).
    enum class Resisting { supports, supports_and_loads };

    /// For the shape x; the vertices that carry them are far apart in it.
    std::vector<GaugeDirection> gauge(const Eigen::VectorXd& x, Resisting resisting) const;

    /// Adds stiffness along these directions, as much as the vertex has by itself, to the values of a Hessian
    /// at x, which lie on `pattern`.
    void hold(const NodePattern& pattern, const Eigen::VectorXd& x, Resisting resisting,
              std::vector<double>& hessian) const;

  private:
    struct Piece {
        std::vector<int> vertices;
        std::vector<Support> supports;
        std::vector<NodalForce> forces;
    };
    std::vector<Piece> pieces_;
    Vec3 gravity_ = Vec3::Zero();
    bool table_ = false;
};

/// Throws InputError for gravity that nothing holds some piece of the sheet against.
void require_held(const Model& model);

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// Between two Newton steps of a whole sheet: brings the few spots where the residual is concentrated
/// (corners of strips, where fabric is near the limit of its law) to their own equilibrium, all else held in
/// place. Without it those spots decide how many steps the whole sheet needs: inside a logarithmic barrier
/// Newton's method only doubles the distance to the limit with each step. (Nonlinear elimination: Lanzkron,
/// Rose, Wilkes, SIAM J. Sci. Comput. 17, 1996; Cai, Li, SIAM J. Sci. Comput. 33, 2011.)
class NonlinearElimination {
  public:
    /// `held`: one flag per unknown that a support fixes; must outlive this.
    NonlinearElimination(const Model& model, const std::vector<char>& held);

    /// Whether the largest forces are concentrated in few spots.
    bool is_concentrated(const Eigen::VectorXd& gradient);

    /// Moves x to lower energy and `gradient`, which is x's, along with it; returns by how much the energy
    /// fell, mJ. A spot is where the force is a good part of the largest one, with as many of `rings` of
    /// vertices around it as stay cheap. `model` is the one given to the constructor or differs from it in
    /// the material only.
    double operator()(const Model& model, Eigen::VectorXd& x, Eigen::VectorXd& gradient, int rings);

    /// The same at the end x of a step from `from` that has thrown some spots far off, those with a force
    /// above `much` (N) too, and with more of their surroundings: small elements at corners of strips fold
    /// over in a step that suits all others, and each Newton step would open such a fold by a third more
    /// only. Each begins with the shape that it had at `from`, carried along by its surroundings, where that
    /// has less energy.
    double after_step(const Model& model, const Eigen::VectorXd& from, double much, Eigen::VectorXd& x,
                      Eigen::VectorXd& gradient);

  private:
    struct ForceRange {
        double largest;     // on a vertex, N
        double of_hardest;  // the least force on a vertex that may belong to a spot
    };
    ForceRange measure_forces(const Eigen::VectorXd& gradient);
    double limiting_force(const Eigen::VectorXd& gradient, double much);
    std::vector<std::vector<int>> spots(const Model& model, double limit, int rings);
    std::vector<std::vector<int>> spots_with_rings(const Model& model, double limit, int rings);
    void carry_along(const Model& model, const std::vector<int>& nodes, const Eigen::VectorXd& from,
                     Eigen::VectorXd& x) const;
    double relax_spots(const Model& model, std::vector<std::vector<int>> spots, const Eigen::VectorXd* from,
                       Eigen::VectorXd& x, Eigen::VectorXd& gradient) const;

    const std::vector<char>& held_;
    std::vector<std::vector<int>> triangles_of_vertex_;
    std::vector<std::vector<int>> edge_unknowns_of_vertex_;  // nodes
    std::vector<double> force_;                              // per vertex, N
    std::vector<int> parent_;  // of the union-find forest over nodes; -1 = not in a spot
};

}  // namespace ruche

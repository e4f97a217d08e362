#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "ruche/energy/model.hpp"
#include "ruche/statics/sparse_cholesky.hpp"

namespace ruche {

/// Turns Newton's step into a curve that rotates elements instead of stretching them:
///
///     x(t) = x + t d + O(t^2)
///
/// Per triangle with edges D = [e1 e2] and the step's dD: velocity gradient A = dD P^T + n_dot n^T with
/// P = D (D^T D)^-1, n_dot = -P dD^T n; W = skew A, eps = sym A; target edges D(t) = exp(t W) sqrt(I + 2 t
/// eps) D. Positions follow from one Poisson problem on the layout with area weights (plastic 30 times
/// fabric), whose matrix is factorised once per mesh. Edge unknowns move along the straight line.
class Retraction {
  public:
    /// `vertex_order`: the elimination order of the vertices; empty = found here.
    explicit Retraction(const Model& model, std::vector<int> vertex_order = {});

    /// The state x(t) for step d.
    Eigen::VectorXd operator()(const Eigen::VectorXd& x, const Eigen::VectorXd& step, double t);

    /// The state nearest to having the given edges [v1 - v0, v2 - v0] per triangle: x moved by the solution
    /// of the Poisson problem; what no support holds keeps x's mean position. Edge unknowns stay x's.
    Eigen::VectorXd with_edges(const Eigen::VectorXd& x,
                               const std::vector<Eigen::Matrix<double, 3, 2>>& edges);

    /// About which axis and by which angle a step turns each element, rad.
    std::vector<Vec3> spins(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const;
    /// Area-weighted root mean square, over elements, of these angles, rad.
    double rms_rotation(const std::vector<Vec3>& spins) const;
    double rms_rotation(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const {
        return rms_rotation(spins(x, step));
    }

    /// Moves the supported vertices to where they are held and the rest along with them (harmonically).
    Eigen::VectorXd meet_supports(const Eigen::VectorXd& x);

  private:
    struct Element {
        Triangle vertices;
        double weight;
        double area;
        Eigen::Matrix<double, 2, 3> gradients;  // of the three hat functions on the layout
        Mat2 inverse_edges;                     // of [e1 e2] in the layout
    };

    template <class Body>
    void for_each_element(const Body& body) const;
    SparseCholesky& factor_without(int component);
    Eigen::MatrixXd weighted_divergence(const std::vector<Eigen::Matrix<double, 3, 2>>& edge_changes) const;
    /// Displacements (n, 3) whose gradients are nearest to the edge changes; what no support holds moves by
    /// the mean of `mean_of` (positions row by row).
    Eigen::MatrixXd integrate(const std::vector<Eigen::Matrix<double, 3, 2>>& edge_changes,
                              const Eigen::VectorXd& mean_of);

    int vertex_count_ = 0;
    double total_area_ = 0.0;
    std::vector<Element> elements_;
    MeshPieces pieces_;
    std::array<std::vector<char>, 3> held_;  // per component and vertex: by a support
    std::array<std::vector<int>, 3>
        anchors_;  // per component: one vertex of each piece that no support holds
    std::array<std::vector<char>, 3> dirichlet_;  // held or anchor
    std::vector<Support> supports_;
    std::vector<int> column_start_, row_index_;
    std::vector<double> values_;
    std::array<std::shared_ptr<SparseCholesky>, 3> factors_;
    std::vector<int> order_;
};

}  // namespace ruche

#include "ruche/statics/shape_response.hpp"

#include "ruche/statics/sparse_cholesky.hpp"

namespace ruche {

ShapeResponse::ShapeResponse(const Model& model, const Eigen::VectorXd& x)
    : held_(held_unknowns(model)),
      system_(model, held_, is_loaded(model.input()), vertex_elimination_order(model.pattern())) {
    AssembledSums sums;
    model.evaluate(x, Order::hessian, sums);
    stable_ = system_.certify({model, x, sums});
}

Eigen::MatrixXd ShapeResponse::velocities(Eigen::MatrixXd gradient_changes) {
    for (Eigen::Index i = 0; i < gradient_changes.rows(); ++i) {
        if (held_[static_cast<std::size_t>(i)]) gradient_changes.row(i).setZero();
    }
    return system_.solve(-gradient_changes);
}

}  // namespace ruche

#pragma once

#include "energy/battery.hpp"
#include "ruche/energy/model.hpp"

namespace ruche::test {

/// The energy of a whole sheet, its gradient and Hessian by automatic differentiation, triangle by triangle
/// and edge by edge from the theory page: shares with the product only the data types.
Sums oracle_sums(const ModelInput& input, const Eigen::VectorXd& x);

}  // namespace ruche::test

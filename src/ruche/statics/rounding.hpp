#pragma once

#include <Eigen/Core>

#include "ruche/energy/assembly.hpp"
#include "ruche/energy/sparsity.hpp"

namespace ruche {

/// The largest component of the gradient beyond what the rounding of the unknowns explains, N:
///
///     max_i ( |g_i| - 4 eps sum_j |H_ij| |x_j| ),   not below 0
///
/// A coordinate of 36 mm is stored to 4e-15 mm; at a plastic element of 2 micrometres, 1e7 N/mm stiff, forces
/// below 3e-8 N are therefore noise that no step can lower. `sums` holds gradient and Hessian at x.
double residual_beyond_rounding(const NodePattern& pattern, const AssembledSums& sums,
                                const Eigen::VectorXd& x);

}  // namespace ruche

#include "ruche/statics/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ruche {

double residual_beyond_rounding(const NodePattern& pattern, const AssembledSums& sums,
                                const Eigen::VectorXd& x) {
    constexpr double safety = 4.0;  // each entry of H is itself a sum of several rounded ones
    Eigen::VectorXd noise = Eigen::VectorXd::Zero(x.size());
    const std::vector<int>& start = pattern.column_start();
    const std::vector<int>& row = pattern.row_index();
    for (Eigen::Index column = 0; column < x.size(); ++column) {
        for (int k = start[column]; k < start[column + 1]; ++k) {
            const double stiffness = std::abs(sums.hessian[k]);
            noise[row[k]] += stiffness * std::abs(x[column]);
            if (row[k] != column) noise[column] += stiffness * std::abs(x[row[k]]);
        }
    }
    const double unit = safety * std::numeric_limits<double>::epsilon();
    return std::max(0.0, (sums.gradient.cwiseAbs() - unit * noise).maxCoeff());
}

}  // namespace ruche

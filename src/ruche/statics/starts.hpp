#pragma once

#include <Eigen/Core>

#include "ruche/energy/model.hpp"

namespace ruche {

/// Where a solve may begin: shapes of the printed sheet, as all unknowns of a model; edge unknowns zero. The
/// same on every machine.

/// Reproducible noise: a number in [-1, 1) from a seed and an index (SplitMix64).
double noise(int seed, int index);

/// Flat, every coordinate disturbed by up to `size_mm`, at most 1 % of the shortest edge: larger noise leads
/// into tangled minima.
Eigen::VectorXd noisy_start(const Model& model, int seed, double size_mm);

/// Rolled on a cylinder without any stretching.
struct Roll {
    double direction = 0.0;  ///< that is bent, rad from the layout's x axis
    double turn = 0.0;       ///< from one end of the sheet to the other, rad; positive: front outside
};
Eigen::VectorXd rolled_start(const Model& model, const Roll& roll);

/// Smooth hills and valleys: the sum of four waves of random direction and phase, a half to two sheet
/// diameters long, as steep as 0.6 at their steepest; contracted so far that nothing is stretched.
Eigen::VectorXd wavy_start(const Model& model, int seed);

}  // namespace ruche

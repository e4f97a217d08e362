#pragma once

#include <Eigen/Core>

#include "ruche/energy/model.hpp"

namespace ruche {

/// A shape that a solve passes through on its way to rest, for those who watch (`Control::watch`). Refers to
/// what the solver holds: valid during the call.
struct Iterate {
    const ModelInput& sheet;   ///< its mesh and print: a release goes through several meshes
    const Eigen::VectorXd& x;  ///< all unknowns, positions first, mm
    int iteration = 0;         ///< on this mesh
    double energy = 0.0;       ///< mJ
    double residual = 0.0;     ///< N; both are not a number for the flat sheet before the first step
};

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <string>

#include "ruche/core/control.hpp"
#include "ruche/scene/result.hpp"
#include "ruche/scene/state.hpp"

namespace ruche {

/// Where a run begins when not from the flat printed state.
struct Start {
    const State* state = nullptr;
    bool resume = false;  ///< the state is of this very scene: take all unknowns, refuse another scene's
    std::string path;     ///< the state's file, for messages
};

/// The whole pipeline: pattern, mesh, model, release, measures of health. Throws InputError for a scene that
/// cannot be simulated; whether the solve converged stands in the result.
[[nodiscard]] Result simulate(const Scene& scene, const Control& control = {}, const Start& start = {});

}  // namespace ruche

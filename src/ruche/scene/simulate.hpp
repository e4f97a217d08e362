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

/// A scene's ordinary result, with the list of all stable shapes that were found, and a result for each of
/// them in the order of that list (the ordinary one is among them).
struct ResultWithAlternatives {
    Result ordinary;
    std::vector<Result> shapes;
};

/// `simulate`, then a search for further stable shapes until there are `wanted` (see find_alternatives). None
/// when the ordinary run was interrupted.
[[nodiscard]] ResultWithAlternatives simulate_alternatives(const Scene& scene, int wanted,
                                                           const Control& control = {},
                                                           const Start& start = {});

}  // namespace ruche

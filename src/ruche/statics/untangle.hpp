#pragma once

#include <Eigen/Core>
#include <functional>

#include "ruche/core/control.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {

/// What it takes to run a solve again by another route.
struct Reruns {
    static constexpr int other_noise = 1009;  ///< added to the seed

    std::function<Equilibrium(const Eigen::VectorXd& start)> run;
    std::function<Eigen::VectorXd()> last_good;  ///< of all runs so far; empty when every state was tangled
    std::function<void()> be_wary;               ///< runs from now on take small steps, around tangles
    std::function<Eigen::VectorXd()> flat;       ///< the flat printed state with other noise
    bool rough = false;                          ///< a start for another solve is all that is wanted
};

/// Runs a solve. When it ends in a tangle (see tangle.hpp), once more from the last good state in small steps
/// around tangles; when that does not end in a minimum, once more from the flat state. What was done stands
/// in the message. A tangle that is left over is not converged, whatever its residual and its certificate
/// say.
[[nodiscard]] Equilibrium solve_around_tangles(const Eigen::VectorXd& start, const Reruns& reruns,
                                               const Control& control);

}  // namespace ruche

#include "ruche/statics/untangle.hpp"

#include <string>
#include <utility>

#include "ruche/statics/tangle.hpp"

namespace ruche {

Equilibrium solve_around_tangles(const Eigen::VectorXd& start, const Reruns& reruns, const Control& control) {
    Equilibrium first = reruns.run(start);
    if (!first.health.tangled || first.status == SolveStatus::interrupted) return first;
    const std::string knot = tangle(first.health);
    const Eigen::VectorXd last_good = reruns.last_good();
    reruns.be_wary();
    const auto again = [&](const Eigen::VectorXd& from, const std::string& how) {
        control.say({"release", -1.0, "tangled: " + knot + "; once more " + how});
        Equilibrium next = reruns.run(from);
        next.message += "; a first attempt was tangled (" + knot + "), so once more " + how;
        return next;
    };
    const auto done = [&](const Equilibrium& e) {
        if (e.status == SolveStatus::interrupted) return true;
        return !e.health.tangled && (reruns.rough || (e.status == SolveStatus::converged && e.stable));
    };
    Equilibrium next;
    if (last_good.size() > 0) {
        next = again(last_good, "in small steps from the last good state");
        if (done(next)) return next;
    }
    next = again(reruns.flat(), "in small steps from the flat state with other noise");
    if (done(next)) return next;
    // Of three failures the one that is at least a shape.
    if (!next.health.tangled) return next;
    first.status = SolveStatus::not_converged;
    first.message = "tangled: " + knot + "; small steps did not lead around it";
    first.iterations = next.iterations;  // of all runs
    first.factorizations = next.factorizations;
    first.residuals = next.residuals;
    return first;
}

}  // namespace ruche

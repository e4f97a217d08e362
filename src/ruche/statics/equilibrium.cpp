#include "ruche/statics/equilibrium.hpp"

#include <chrono>

#include "ruche/statics/newton.hpp"
#include "ruche/statics/rigid_motions.hpp"
#include "ruche/statics/starts.hpp"
#include "ruche/statics/untangle.hpp"

namespace ruche {

std::string_view name_of(SolveStatus status) {
    switch (status) {
        case SolveStatus::converged:
            return "converged";
        case SolveStatus::not_converged:
            return "not_converged";
        case SolveStatus::interrupted:
            return "interrupted";
    }
    return {};
}

namespace {

enum class Tangles { solve_around, leave };

template <class Start>
Equilibrium timed_solve(const Model& model, const SolveOptions& options, const Control& control,
                        Tangles tangles, const Start& start) {
    const auto begin = std::chrono::steady_clock::now();
    require_held(model);
    Newton newton(model, options, control);
    newton.announce();
    const Reruns reruns{
        .run = [&](const Eigen::VectorXd& from) { return newton.run(from); },
        .last_good = [&] { return newton.last_good(); },
        .be_wary = [&] { newton.be_wary(); },
        .flat = [&] { return noisy_start(model, options.seed + Reruns::other_noise, options.noise_mm); },
        .rough = options.enough_rotation > 0.0};
    Equilibrium result = tangles == Tangles::leave ? newton.run(start(newton))
                                                   : solve_around_tangles(start(newton), reruns, control);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.levels = {{.triangles = model.input().mesh.triangle_count(),
                      .iterations = result.iterations,
                      .factorizations = result.factorizations,
                      .residuals = result.residuals}};
    return result;
}

}  // namespace

Equilibrium solve(const Model& model, const SolveOptions& options, const Control& control,
                  const Eigen::VectorXd* start) {
    return timed_solve(model, options, control, Tangles::solve_around, [&](Newton&) {
        return start != nullptr ? *start : noisy_start(model, options.seed, options.noise_mm);
    });
}

Equilibrium solve(const Model& model, const SolveOptions& options, const Control& control,
                  const LayoutShape& start) {
    // On a mesh on the way to a finer one a few folded elements are not worth another solve: the finer one
    // has elements of its own there, and sees to theirs.
    const bool on_the_way = options.enough_rotation > 0.0;
    return timed_solve(model, options, control, on_the_way ? Tangles::leave : Tangles::solve_around,
                       [&](Newton& newton) { return newton.carried_over(start); });
}

}  // namespace ruche

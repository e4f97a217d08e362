#include "ruche/statics/equilibrium.hpp"

namespace ruche {

template <>
std::span<const Field<SolveOptions>> fields<SolveOptions>() {
    using S = SolveOptions;
    static const Field<S> table[] = {
        {"residual_tolerance_n", &S::residual_tolerance_n, "N", 1e-15, 1,
         "Converged when no component of the force on any vertex is larger."},
        {"max_iterations", &S::max_iterations, "", 1, 1000000, "Give up after so many steps."},
        {"seed", &S::seed, "", 0, 2147483647,
         "Seed of the noise that breaks the symmetry of the flat start; another seed may lead to another "
         "stable shape."},
        {"noise_mm", &S::noise_mm, "mm", 0, 1,
         "Size of that noise, never more than 1 % of the element size. With 0 symmetric fabric stays flat."},
        {"deterministic", &S::deterministic, "", -infinity, infinity,
         "The same bits at any number of threads. With false the factorisation uses several threads too: "
         "faster on large "
         "sheets when nothing else runs."},
        {"coarse_start", &S::coarse_start, "", -infinity, infinity,
         "Solve on coarser meshes of the drawing first, each the start for the next finer one."},
        {"threads", &S::threads, "", 0, 1024, "Threads to use; 0 takes every core."},
    };
    return table;
}

}  // namespace ruche

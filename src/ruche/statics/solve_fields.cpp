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
         "Taken for scenes that name it: a release gives the same bits at any number of threads in any "
         "case."},
        {"coarse_start", &S::coarse_start, "", -infinity, infinity,
         "Solve on coarser meshes of the drawing first, each the start for the next finer one."},
        {"time_limit_s", &S::time_limit_s, "s", 0.0, 1e9,
         "The release stops after so long, with the shape that it has reached; 0 sets no limit."},
        {"memory_limit_mb", &S::memory_limit_mb, "MB", 0.0, 1e9,
         "The release stops before the program takes more, with the shape that it has reached; 0 takes what "
         "the "
         "machine has."},
        {"threads", &S::threads, "", 0, 1024, "Threads to use; 0 takes every core."},
    };
    return table;
}

}  // namespace ruche

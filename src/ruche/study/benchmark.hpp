#pragma once

#include <string>

#include "ruche/core/control.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {

struct BenchmarkOptions {
    std::string scene = "strips";  ///< one of benchmark_scenes()
    int triangles = 0;             ///< about so many; 0 = the scene's own number
    int threads = 0;               ///< of the release; 0 = all cores
};

/// Seconds of the pieces that a Newton step is made of, on the mesh and at the shape of the release's end; of
/// several repeats the median. NaN where the end is not stable: its Hessian has no factor.
struct StepSeconds {
    double value = 0.0;          ///< energy alone
    double gradient = 0.0;       ///< with the energy
    double hessian = 0.0;        ///< with energy and gradient
    double factorization = 0.0;  ///< numeric; of the Hessian that certifies the end
    double solve = 0.0;          ///< one right-hand side
};

/// What one release took, and what that is in units of its own machine.
struct Benchmark {
    BenchmarkOptions options;  ///< as resolved
    int triangles = 0;
    double mesh_seconds = 0.0;   ///< pattern to conforming mesh
    double model_seconds = 0.0;  ///< mesh to energy: elements, sparsity
    /// Of the whole release, coarser meshes included, by way of scene/release as in `simulate`.
    double release_processor_seconds = 0.0;  ///< all threads
    double release_wall_seconds = 0.0;
    double peak_megabytes = 0.0;  ///< of the process, up to the end of the release
    Equilibrium equilibrium;

    double ordering_seconds = 0.0;  ///< elimination order of the unknowns
    double analysis_seconds = 0.0;  ///< symbolic factorisation
    double factor_megabytes = 0.0;
    /// With one thread, processor time: on a quiet machine that is the time by the clock, on a busy one it
    /// hardly changes.
    StepSeconds one_thread;
    StepSeconds all_threads;   ///< with the release's threads, by the clock
    std::string blas_kernels;  ///< what the dense kernels are made for, "Haswell", ...

    /// The release in units of its own floor: processor time over that of one factorisation on one thread.
    double equivalent_factorizations() const { return release_processor_seconds / one_thread.factorization; }
};

/// Meshes a benchmark scene to the wanted size, releases it as `simulate` does, then measures the pieces.
/// Throws InputError. Whether the release converged stands in the result.
[[nodiscard]] Benchmark benchmark(const BenchmarkOptions& options, const Control& control = {});

/// As a JSON object; docs/file-formats.md lists the keys.
std::string benchmark_json(const Benchmark& result);

}  // namespace ruche

#include <nlohmann/json.hpp>

#include "ruche/study/benchmark.hpp"

namespace ruche {

using Json = nlohmann::ordered_json;

static Json seconds_json(const StepSeconds& seconds) {
    return {{"value_s", seconds.value},
            {"gradient_s", seconds.gradient},
            {"hessian_s", seconds.hessian},
            {"factorization_s", seconds.factorization},
            {"solve_s", seconds.solve}};
}

std::string benchmark_json(const Benchmark& result) {
    const Equilibrium& end = result.equilibrium;
    Json json;
    json["version"] = RUCHE_VERSION;
    json["scene"] = result.options.scene;
    json["triangles"] = result.triangles;
    json["unknowns"] = end.x.size();
    json["threads"] = result.options.threads;
    json["blas_kernels"] = result.blas_kernels;
    json["mesh_s"] = result.mesh_seconds;
    json["model_s"] = result.model_seconds;
    json["ordering_s"] = result.ordering_seconds;
    json["analysis_s"] = result.analysis_seconds;
    json.update(seconds_json(result.one_thread));
    json["with_all_threads"] = seconds_json(result.all_threads);
    json["release_cpu_s"] = result.release_processor_seconds;
    json["release_wall_s"] = result.release_wall_seconds;
    json["converged"] = end.status == SolveStatus::converged;
    json["stable"] = end.stable;
    json["energy_mJ"] = end.energy.total();
    json["iterations"] = end.iterations;
    json["factorizations"] = end.factorizations;
    json["levels"] = Json::array();
    for (const LevelEffort& level : end.levels)
        json["levels"].push_back({{"triangles", level.triangles},
                                  {"iterations", level.iterations},
                                  {"factorizations", level.factorizations}});
    json["equivalent_factorizations"] = result.equivalent_factorizations();
    json["peak_mb"] = result.peak_megabytes;
    json["factor_mb"] = result.factor_megabytes;
    json["peak_over_factor"] = result.peak_megabytes / result.factor_megabytes;
    return json.dump(2) + "\n";
}

}  // namespace ruche

#include "ruche/study/benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <thread>

#include "ruche/core/error.hpp"
#include "ruche/core/parallel.hpp"
#include "ruche/core/process_usage.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/check_scene.hpp"
#include "ruche/scene/release.hpp"
#include "ruche/statics/rigid_motions.hpp"
#include "ruche/statics/sparse_cholesky.hpp"
#include "ruche/study/benchmark_scene.hpp"

extern "C" char* openblas_get_corename();

namespace ruche {
namespace {

double clock_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

using Clock = double (*)();

/// Median over repeats: at least three, and more of what is short.
template <class Work>
double seconds_of(Clock clock, Work&& work) {
    constexpr std::size_t fewest = 3;
    constexpr std::size_t most = 25;
    constexpr double enough = 1.0;  // s in all
    std::vector<double> times;
    double sum = 0.0;
    while (times.size() < fewest || (times.size() < most && sum < enough)) {
        const double begin = clock();
        work();
        times.push_back(clock() - begin);
        sum += times.back();
    }
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return *middle;
}

template <class Work>
double once(Work&& work) {
    const double begin = clock_seconds();
    work();
    return clock_seconds() - begin;
}

StepSeconds step_seconds(const Model& model, const Eigen::VectorXd& x, SparseCholesky& cholesky,
                         Clock clock) {
    StepSeconds seconds;
    AssembledSums sums;
    const auto assembly = [&](Order order) {
        return seconds_of(clock, [&] { model.evaluate(x, order, sums); });
    };
    seconds.value = assembly(Order::value);
    seconds.gradient = assembly(Order::gradient);
    seconds.hessian = assembly(Order::hessian);
    RigidMotions(model).hold(model.pattern(), x, RigidMotions::Resisting::supports_and_loads, sums.hessian);
    bool definite = true;
    seconds.factorization = seconds_of(clock, [&] { definite = cholesky.factorize(sums.hessian); });
    seconds.solve = std::numeric_limits<double>::quiet_NaN();
    if (!definite) seconds.factorization = seconds.solve;  // an attempt that fails is no measure
    if (definite) seconds.solve = seconds_of(clock, [&] { cholesky.solve(sums.gradient); });
    return seconds;
}

void measure_pieces(const Release& released, int threads, Benchmark& result) {
    const Model& model = released.model;
    std::vector<int> order;
    result.ordering_seconds = once([&] { order = vertex_elimination_order(model.pattern()); });
    std::optional<SparseCholesky> cholesky;
    result.analysis_seconds = once([&] { cholesky.emplace(model, order); });
    const Eigen::VectorXd& x = released.equilibrium.x;
    result.all_threads = step_seconds(model, x, *cholesky, clock_seconds);
    set_thread_count(1);
    result.one_thread = step_seconds(model, x, *cholesky, processor_seconds);
    set_thread_count(threads);
    result.factor_megabytes = cholesky->factor_megabytes();
}

BenchmarkOptions resolved(BenchmarkOptions options) {
    for (const BenchmarkSceneInfo& known : benchmark_scenes())
        if (known.name == options.scene && options.triangles == 0) options.triangles = known.triangles;
    if (options.threads == 0)
        options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return options;
}

}  // namespace

Benchmark benchmark(const BenchmarkOptions& wanted, const Control& control) {
    Benchmark result{.options = resolved(wanted), .blas_kernels = openblas_get_corename()};
    BenchmarkScene made(result.options.scene);
    made.scene().solver.threads = result.options.threads;
    set_thread_count(result.options.threads);
    made.resize(result.options.triangles, control);
    const Scene& scene = made.scene();
    check_scene(scene);

    PrintMesh layout;
    result.mesh_seconds = once([&] { layout = scene_mesh(scene); });
    result.triangles = layout.mesh.triangle_count();
    std::optional<Model> model;
    result.model_seconds = once([&] { model.emplace(scene_model(scene, layout)); });

    const double processor = processor_seconds();
    std::optional<Release> released;
    result.release_wall_seconds =
        once([&] { released.emplace(release(scene, layout, std::move(*model), control)); });
    result.release_processor_seconds = processor_seconds() - processor;
    result.peak_megabytes = peak_megabytes();
    control.say({"pieces", -1.0, "assembly, factorisation"});
    measure_pieces(*released, result.options.threads, result);
    result.equilibrium = std::move(released->equilibrium);
    return result;
}

}  // namespace ruche

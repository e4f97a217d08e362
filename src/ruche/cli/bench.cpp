#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/study/benchmark.hpp"
#include "ruche/study/benchmark_scene.hpp"

namespace ruche {

namespace {
struct BenchArguments {
    BenchmarkOptions options;
    bool json = false;
    bool verbose = false;
};
}  // namespace

static void print_step(const char* piece, double one_thread, double all_threads) {
    fmt::print("  {:22} {:10.4g} {:14.4g}\n", piece, one_thread, all_threads);
}

static void print_benchmark(const Benchmark& result) {
    const Equilibrium& end = result.equilibrium;
    fmt::print("{}: {} triangles, {} unknowns; {} threads, BLAS kernels for {}\n\n", result.options.scene,
               result.triangles, end.x.size(), result.options.threads, result.blas_kernels);
    fmt::print("  {:22} {:>10} {:>14}\n", "seconds", "one thread",
               fmt::format("{} threads", result.options.threads));
    const StepSeconds& one = result.one_thread;
    const StepSeconds& all = result.all_threads;
    print_step("energy", one.value, all.value);
    print_step("energy, gradient", one.gradient, all.gradient);
    print_step("energy to Hessian", one.hessian, all.hessian);
    print_step("one factorisation", one.factorization, all.factorization);
    print_step("one solve", one.solve, all.solve);
    fmt::print(
        "\n  once: mesh {:.3g} s, energy set-up {:.3g} s, ordering {:.3g} s, symbolic analysis {:.3g} s\n",
        result.mesh_seconds, result.model_seconds, result.ordering_seconds, result.analysis_seconds);
    fmt::print("\nrelease    {:.3g} s by the clock, {:.3g} s of processor time\n",
               result.release_wall_seconds, result.release_processor_seconds);
    fmt::print("           as much as {:.1f} factorisations on one thread\n",
               result.equivalent_factorizations());
    for (const LevelEffort& level : end.levels)
        fmt::print("           {:8} triangles: {} iterations, {} factorisations\n", level.triangles,
                   level.iterations, level.factorizations);
    fmt::print("           {}{}\n", end.message, end.stable ? "" : "; not a stable shape");
    fmt::print("memory     {:.4g} MB at most, {:.2f} times the factor's {:.4g} MB\n", result.peak_megabytes,
               result.peak_megabytes / result.factor_megabytes, result.factor_megabytes);
}

static ExitCode bench(const BenchArguments& arguments) {
    watch_for_interrupts();
    ProgressDisplay display;
    Control control{.report = [&](const Progress& progress) { display.show(progress); },
                    .stop = &interrupted()};
    if (arguments.verbose)
        control.report = [](const Progress& progress) {
            fmt::print(stderr, "{}: {}\n", progress.phase, progress.text);
        };
    const Benchmark result = benchmark(arguments.options, control);
    display.clear();
    if (arguments.json)
        fmt::print("{}", benchmark_json(result));
    else
        print_benchmark(result);
    if (result.equilibrium.status == SolveStatus::interrupted) return ExitCode::interrupted;
    const bool certain = result.equilibrium.status == SolveStatus::converged && result.equilibrium.stable;
    return certain ? ExitCode::converged : ExitCode::unfinished;
}

void add_bench(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<BenchArguments>();
    std::string about = "Measure how long things take on this machine. Scenes:";
    for (const BenchmarkSceneInfo& scene : benchmark_scenes())
        about += fmt::format("\n  {:29} {}", scene.name, scene.meaning);
    CLI::App* verb = program.add_subcommand("bench", "Measure how long a release takes on this machine");
    verb->footer(about);
    verb->add_option("--scene", arguments->options.scene, "What to release; see below")->type_name("NAME");
    verb->add_option("--triangles", arguments->options.triangles,
                     "Size of the mesh; without it 20000 (18500 for the strips without logarithms)")
        ->check(CLI::Range(100, 2'000'000))
        ->type_name("N");
    verb->add_option("--threads", arguments->options.threads, "Threads of the release; 0 takes every core")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
    verb->add_flag("--verbose", arguments->verbose, "Log every step on stderr");
    verb->add_flag("--json", arguments->json, "Print JSON instead of a table");
    verb->callback([arguments, &action] { action = [arguments] { return bench(*arguments); }; });
}

}  // namespace ruche

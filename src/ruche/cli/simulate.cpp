#include "ruche/scene/simulate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/scene_arguments.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/output/html_report.hpp"
#include "ruche/output/metrics.hpp"
#include "ruche/output/result_folder.hpp"

namespace ruche {

namespace {
struct SimulateArguments {
    SceneArguments scene;
    std::string folder;
    std::string start;
    int alternatives = 0;
    bool resume = false;
    bool quiet = false;
    bool verbose = false;
};
}  // namespace

static void print_list(const char* title, const std::vector<std::string>& texts) {
    if (!texts.empty()) fmt::print("{}\n", title);
    for (const std::string& text : texts) fmt::print("  {}\n", text);
}

/// "0.0512 to 0.0531 /mm (positive: ...)" over the strips that have a centre line.
static std::string curvature_range(const Result& result) {
    double low = infinity;
    double high = -infinity;
    for (const StripMetrics& strip : measure_strips(result.layout, result.shape)) {
        if (!std::isfinite(strip.curvature)) continue;
        low = std::min(low, strip.curvature);
        high = std::max(high, strip.curvature);
    }
    if (low > high) return "no strip to measure";
    const std::string range =
        high - low < 1e-4 * high ? fmt::format("{:.4g}", low) : fmt::format("{:.4g} to {:.4g}", low, high);
    return range + " /mm (positive: curls towards the back)";
}

static std::string_view status_text(SolveStatus status) {
    switch (status) {
        case SolveStatus::converged:
            return "converged";
        case SolveStatus::not_converged:
            return "NOT CONVERGED";
        case SolveStatus::interrupted:
            return "interrupted";
    }
    return {};
}

/// A line per shape: number, energy, where it was found from.
static void print_alternatives(const ShapeList& list) {
    fmt::print("shapes     {} from {} further starts{}\n", list.shapes.size(), list.starts,
               list.interrupted ? ", interrupted" : "");
    for (const ShapeEntry& shape : list.shapes) {
        const double lowest = list.shapes.front().energy;
        fmt::print(
            "  {}  {:.9g} mJ{}  {}{}\n", shape.number, shape.energy,
            shape.number == 1 ? "" : fmt::format(" (+{:.2g} %)", 100.0 * (shape.energy / lowest - 1.0)),
            shape.ordinary ? "this result; " : "", fmt::join(shape.found_from, ", "));
    }
}

static void print_summary(const Result& result, double seconds, const std::vector<std::string>& files) {
    const Equilibrium& end = result.equilibrium;
    fmt::print("{}, {} after {} iterations: {}\n", status_text(end.status),
               end.stable ? "stable" : "NOT STABLE", end.iterations, end.message);
    fmt::print("energy     {:.9g} mJ\n", end.energy.total());
    fmt::print("residual   {:.2g} N (typical force in an element: {:.2g} N)\n", end.residual,
               end.typical_force);
    fmt::print("curvature  {}\n", curvature_range(result));
    if (result.alternatives) print_alternatives(*result.alternatives);
    fmt::print("time       {:.1f} s\n", seconds);
    print_list("warnings:", result.warnings);
    fmt::print("written:\n");
    for (const std::string& file : files)
        if (file.ends_with("picture.png") || file.ends_with("report.html") || file.ends_with("shape.obj") ||
            file.ends_with("shape.glb") || file.ends_with("report.json") || (files.size() == 1))
            fmt::print("  {}\n", file);
    if (result.scene.output.page && !can_write_page())
        fmt::print("  no report.html: this program was built without npm (tools/setup installs it)\n");
}

static ExitCode exit_code(const Result& result) {
    const Equilibrium& end = result.equilibrium;
    if (end.status == SolveStatus::interrupted) return ExitCode::interrupted;
    if (result.alternatives && result.alternatives->interrupted) return ExitCode::interrupted;
    return end.status == SolveStatus::converged && end.stable ? ExitCode::converged : ExitCode::unfinished;
}

static ExitCode run(const SimulateArguments& arguments) {
    const auto begin = std::chrono::steady_clock::now();
    const Scene scene = read_scene(arguments.scene);
    const std::string folder = arguments.folder.empty() ? scene_name(scene) + ".out" : arguments.folder;
    std::optional<State> state;
    Start start{.resume = arguments.resume};
    if (arguments.resume || !arguments.start.empty()) {
        start.path = state_path(arguments.resume ? folder : arguments.start);
        state = read_state(start.path);
        start.state = &*state;
    }
    check_result_folder(folder);

    watch_for_interrupts();
    ProgressDisplay display;
    Control control{.stop = &interrupted()};
    if (arguments.verbose) {
        control.report = [](const Progress& progress) {
            fmt::print(stderr, "{}: {}\n", progress.phase, progress.text);
        };
    } else if (!arguments.quiet) {
        control.report = [&](const Progress& progress) { display.show(progress); };
    }
    ResultWithAlternatives found =
        arguments.alternatives > 0
            ? simulate_alternatives(scene, arguments.alternatives, control, start)
            : ResultWithAlternatives{.ordinary = simulate(scene, control, start), .shapes = {}};
    add_film(found.ordinary, control);
    const std::vector<std::string> files = write_result(found, folder, control);
    display.clear();
    const Result& result = found.ordinary;

    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    if (!arguments.quiet && is_drawing(arguments.scene)) print_list("assumed:", result.assumptions);
    if (!arguments.quiet) print_summary(result, seconds.count(), files);
    return exit_code(result);
}

void add_simulate(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<SimulateArguments>();
    CLI::App* verb = program.add_subcommand("simulate", "Find the released shape of a scene or a drawing");
    add_scene_arguments(*verb, arguments->scene);
    verb->add_option("-o,--output", arguments->folder, "Folder for the result; else NAME.out")
        ->type_name("DIR");
    CLI::Option* start = verb->add_option(
        "--start", arguments->start, "Begin with the shape of an earlier result, of this or another scene");
    start->type_name("RESULT");
    verb->add_option(
            "--alternatives", arguments->alternatives,
            "Look for further stable shapes until there are N, this one included; each gets a folder "
            "DIR/alternatives/1, 2, ... by energy")
        ->type_name("N")
        ->check(CLI::Range(1, 1000));
    verb->add_flag("--resume", arguments->resume, "Go on with the interrupted run in the output folder")
        ->excludes(start);
    CLI::Option* quiet = verb->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
    verb->add_flag("--verbose", arguments->verbose, "Log every step, the threads and the dense kernels used")
        ->excludes(quiet);
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace ruche

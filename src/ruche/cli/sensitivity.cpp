#include "ruche/study/sensitivity/sensitivity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/scene_arguments.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/atomic_file.hpp"
#include "ruche/core/suggest.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/simulate.hpp"

namespace ruche {

namespace {
struct SensitivityArguments {
    SceneArguments scene;
    std::string start;
    std::vector<std::string> measures;
    std::string file;
    bool quiet = false;
};

constexpr double shown_from = 5e-4;  // of a slope: less is 0.000 in the table
}  // namespace

/// Numbers of the measures to print; without any named: the first one, the most telling that there is.
static std::vector<int> chosen_measures(const std::vector<std::string>& wanted,
                                        const std::vector<ShapeMeasure>& measures) {
    std::vector<std::string_view> names;
    names.reserve(measures.size());
    for (const ShapeMeasure& measure : measures) names.emplace_back(measure.name);
    std::vector<int> chosen;
    for (const std::string& name : wanted) {
        const auto at = std::ranges::find(names, name);
        if (name != "all" && at == names.end())
            throw InputError(
                {.key = "--metric"},
                fmt::format("this scene has no measure \"{}\"{}", name, did_you_mean(name, names)),
                fmt::format("It has {}; or say all.", fmt::join(names, ", ")));
        for (int m = 0; m < static_cast<int>(names.size()); ++m) {
            if (name == "all" || m == at - names.begin()) chosen.push_back(m);
        }
    }
    if (chosen.empty()) chosen.push_back(0);
    return chosen;
}

/// Refuses names of measures before the scene is released.
static void check_measures(const SensitivityArguments& arguments, const Scene& scene) {
    if (arguments.measures.empty()) return;
    const PrintMesh layout = scene_mesh(scene);
    std::vector<Vec3> flat;
    flat.reserve(layout.mesh.vertices.size());
    for (const Vec2& p : layout.mesh.vertices) flat.emplace_back(p.x(), p.y(), 0.0);
    (void)chosen_measures(arguments.measures, ShapeMeasures(layout, flat).values());
}

/// Parameters that matter for a measure, the one that matters most first.
static std::vector<int> by_magnitude(const Sensitivities& found, int measure) {
    std::vector<int> order(found.parameters.size());
    std::iota(order.begin(), order.end(), 0);
    std::erase_if(order, [&](int p) { return !(std::abs(found.slopes(measure, p)) >= shown_from); });
    std::ranges::stable_sort(order, [&](int a, int b) {
        return std::abs(found.slopes(measure, a)) > std::abs(found.slopes(measure, b));
    });
    return order;
}

static void print_measure(const Sensitivities& found, int measure) {
    const ShapeMeasure& about = found.measures[static_cast<std::size_t>(measure)];
    fmt::print("\n{} = {:.6g} {}\n\n", about.name, about.value, about.unit);
    const std::vector<int> order = by_magnitude(found, measure);
    if (order.empty()) {
        fmt::print("  it has no derivative here, or none of the parameters matters\n");
        return;
    }
    fmt::print("  {:42} {:>11} {:8} {:>12} {:>12} {:>14}\n", "parameter", "value", "", "d ln / d ln p",
               "10 % more", "card's interval");
    for (const int p : order) {
        const SensitivityParameter& parameter = found.parameters[static_cast<std::size_t>(p)];
        const double slope = found.slopes(measure, p);
        const std::string interval =
            parameter.uncertainty
                ? fmt::format("+-{:.2g} %", 100.0 * std::abs(slope) * *parameter.uncertainty)
                : "";
        fmt::print("  {:42} {:11.5g} {:8} {:+12.3f} {:>12} {:>14}\n", parameter.name, parameter.value,
                   parameter.unit, slope, fmt::format("{:+.2g} %", 10.0 * slope), interval);
    }
    if (const auto uncertainty = found.uncertainty(measure))
        fmt::print("\n  all intervals of the card together, as if independent: +-{:.2g} %\n",
                   100.0 * *uncertainty);
    const auto first = static_cast<std::size_t>(order.front());
    fmt::print("\n  An error of 10 % in {} moves {} by {:.2g} %.\n", found.parameters[first].name, about.name,
               10.0 * std::abs(found.slopes(measure, order.front())));
}

static ExitCode run_sensitivity(const SensitivityArguments& arguments) {
    const Scene scene = read_scene(arguments.scene);
    check_measures(arguments, scene);
    std::optional<State> state;
    Start start;
    if (!arguments.start.empty()) {
        start.path = state_path(arguments.start);
        state = read_state(start.path);
        start.state = &*state;
    }
    watch_for_interrupts();
    ProgressDisplay display;
    Control control{.stop = &interrupted()};
    if (!arguments.quiet) control.report = [&](const Progress& progress) { display.show(progress); };
    const Result result = simulate(scene, control, start);
    if (result.equilibrium.status == SolveStatus::interrupted) return ExitCode::interrupted;
    const bool at_rest = result.equilibrium.status == SolveStatus::converged && result.equilibrium.stable;
    const std::optional<Sensitivities> found =
        at_rest ? sensitivities(result, control) : std::optional<Sensitivities>();
    display.clear();
    if (!found) {
        fmt::print(stderr, "no sensitivities: the shape is no stable equilibrium: {}\n",
                   result.equilibrium.message);
        return ExitCode::unfinished;
    }
    const std::vector<int> chosen = chosen_measures(arguments.measures, found->measures);
    if (!arguments.file.empty()) write_file_atomically(arguments.file, sensitivity_json(*found, scene.file));
    if (arguments.quiet) return ExitCode::converged;
    for (const int measure : chosen) print_measure(*found, measure);
    if (!arguments.file.empty()) fmt::print("\nwritten: {}\n", arguments.file);
    return ExitCode::converged;
}

void add_sensitivity(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<SensitivityArguments>();
    CLI::App* verb = program.add_subcommand(
        "sensitivity", "Release a scene and say how much each parameter matters for its shape");
    add_scene_arguments(*verb, arguments->scene);
    verb->add_option("--metric", arguments->measures,
                     "What to print: mean_curvature, mean_stretch, area, length, width, height, "
                     "curvature.STRIP or all; may be repeated; else the first that there is")
        ->type_name("NAME")
        ->allow_extra_args(false)
        ->take_all();
    verb->add_option("--start", arguments->start,
                     "Begin with the shape of an earlier result, of this or another scene")
        ->type_name("RESULT");
    verb->add_option("-o,--output", arguments->file, "Write all measures and parameters as JSON")
        ->type_name("FILE");
    verb->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
    verb->callback([arguments, &action] { action = [arguments] { return run_sensitivity(*arguments); }; });
}

}  // namespace ruche

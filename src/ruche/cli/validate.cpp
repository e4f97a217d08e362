#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/atomic_file.hpp"
#include "ruche/core/suggest.hpp"
#include "ruche/study/validation/validation.hpp"

namespace ruche {

namespace {
struct ValidateArguments {
    std::vector<std::string> names;
    std::string experiments = "validation";
    std::string set = "paper";
    std::string folder = "validation.out";
    int jobs = 0;
    bool quick = false;
};
}  // namespace

/// What computes: version, and size and time of the program's file, so that one built anew starts afresh.
static std::string program_identity() {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    const auto size = fs::file_size(self, error);
    const auto time = fs::last_write_time(self, error).time_since_epoch().count();
    return error ? RUCHE_VERSION : fmt::format("{} {} {}", RUCHE_VERSION, size, time);
}

static std::vector<Experiment> chosen_experiments(const ValidateArguments& arguments) {
    const std::vector<std::string> all = experiment_names(arguments.experiments);
    for (const std::string& name : arguments.names)
        if (std::ranges::find(all, name) == all.end())
            throw InputError({.file = arguments.experiments},
                             fmt::format("there is no experiment \"{}\"{}", name,
                                         did_you_mean(name, {all.begin(), all.end()})),
                             fmt::format("There are {}.", fmt::join(all, ", ")));
    std::vector<Experiment> chosen;
    for (const std::string& name : arguments.names.empty() ? all : arguments.names) {
        Experiment e = read_experiment((std::filesystem::path(arguments.experiments) / name).string());
        const bool in_set = arguments.set == "all" ||
                            experiment_set_names()[static_cast<std::size_t>(e.set)] == arguments.set;
        // A name says enough; a set, and the quick subset, choose from all.
        if (!arguments.names.empty() || (in_set && (e.quick || !arguments.quick)))
            chosen.push_back(std::move(e));
    }
    return chosen;
}

static void print_checks(const Validation& validation) {
    static constexpr const char* words[] = {"holds", "not resolved", "DOES NOT HOLD"};
    for (const ExperimentOutcome& o : validation.experiments) {
        fmt::print("{}: {}\n", o.experiment.name, o.experiment.title);
        for (const CheckOutcome& c : o.checks) {
            fmt::print("  {:13} {}\n", words[static_cast<std::size_t>(c.verdict)], c.check.says);
            const std::size_t shown = c.verdict == Verdict::holds ? 0 : 3;
            for (std::size_t i = 0; i < std::min(shown, c.details.size()); ++i)
                fmt::print("                {}\n", c.details[i]);
        }
    }
}

static void print_summary(const Validation& validation) {
    const std::size_t failed = validation.failed_checks();
    const std::size_t open = validation.unresolved_checks();
    if (failed > 0) fmt::print("{} checks do not hold\n", failed);
    if (validation.quick && open > 0)
        fmt::print(
            "{} checks are not resolved on the meshes of the quick subset: run these without --quick\n",
            open);
}

static ExitCode run_validation(const ValidateArguments& arguments) {
    const std::vector<Experiment> experiments = chosen_experiments(arguments);
    watch_for_interrupts();
    ProgressDisplay display;
    const Control control{.report = [&](const Progress& progress) { display.show(progress); },
                          .stop = &interrupted()};
    const Validation validation = validate(experiments,
                                           {.quick = arguments.quick,
                                            .jobs = arguments.jobs,
                                            .folder = arguments.folder,
                                            .program = program_identity()},
                                           control);
    display.clear();
    if (validation.interrupted) {
        fmt::print("interrupted; the same command goes on with what is left\n");
        return ExitCode::interrupted;
    }
    const std::filesystem::path folder = arguments.folder;
    PendingFile page((folder / "report.html").string(), validation_page(validation));
    PendingFile json((folder / "validation.json").string(), validation_json(validation));
    page.commit();
    json.commit();
    print_checks(validation);
    fmt::print("written:\n  {}\n  {}\n", page.path(), json.path());
    print_summary(validation);
    return validation.failed_checks() > 0 ? ExitCode::unfinished : ExitCode::converged;
}

void add_validate(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<ValidateArguments>();
    CLI::App* verb = program.add_subcommand(
        "validate",
        "Run the paper's experiments and judge what they must show; exit code 3 when a check fails");
    verb->add_option("names", arguments->names, "Experiments; without names all of the set")
        ->type_name("NAME");
    verb->add_option("--set-of", arguments->set, "Which set, where no names are given")
        ->check(CLI::IsMember({"paper", "numerics", "shell", "all"}));
    verb->add_option("--experiments", arguments->experiments, "Folder that the experiments are in")
        ->type_name("DIR");
    verb->add_option(
            "-o,--output", arguments->folder,
            "Folder for report.html, validation.json and the outcome of each run, which is not computed "
            "again by the same program")
        ->type_name("DIR");
    verb->add_option("--jobs", arguments->jobs, "Runs at a time, each on one core; 0 takes every core")
        ->check(CLI::Range(0, 1024));
    verb->add_flag("--quick", arguments->quick,
                   "A small subset on coarse meshes, in about a minute; what these do not resolve is said, "
                   "and is no failure");
    verb->callback([arguments, &action] { action = [arguments] { return run_validation(*arguments); }; });
}

}  // namespace ruche

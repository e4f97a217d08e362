#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/error.hpp"
#include "ruche/core/suggest.hpp"

namespace {

constexpr const char* examples =
    "Examples:\n"
    "  ruche simulate my.svg --stretch 1.7 --thickness-mm 0.6   a drawing, all else from the paper's card\n"
    "  ruche simulate kite.toml -o results/kite                 a scene file\n"
    "  ruche check kite.toml                                    what would be simulated, and what is "
    "assumed\n"
    "  ruche pattern radial -o torus.svg                        a drawing to go on from\n"
    "\n"
    "Exit codes: 0 converged and stable, 1 failed, 2 wrong input, 3 not converged, not stable or not valid,\n"
    "130 interrupted.";

/// CLI11 only says that a subcommand is missing; this says what was written in its place.
void check_verbs(const CLI::App* app, int count, char** arguments) {
    for (int i = 1; i < count && app->get_require_subcommand_min() > 0 && arguments[i][0] != '-'; ++i) {
        std::vector<std::string> names;
        const CLI::App* chosen = nullptr;
        for (const CLI::App* verb : app->get_subcommands([](const CLI::App*) { return true; })) {
            names.push_back(verb->get_name());
            if (verb->get_name() == arguments[i]) chosen = verb;
        }
        if (chosen == nullptr)
            throw ruche::InputError(
                {}, fmt::format("\"{}\" is none of {}{}", arguments[i], fmt::join(names, ", "),
                                ruche::did_you_mean(arguments[i], {names.begin(), names.end()})));
        app = chosen;
    }
}

int run(int count, char** arguments) {
    CLI::App program(
        "Simulates plastic strips printed on stretched fabric: from a drawing to the released shape.",
        "ruche");
    program.set_version_flag("--version", "ruche " RUCHE_VERSION);
    program.footer(examples);
    program.require_subcommand(1);
    program.option_defaults()->always_capture_default();
    ruche::Action action;
    ruche::add_simulate(program, action);
    ruche::add_check(program, action);
    ruche::add_studio(program, action);
    ruche::add_render(program, action);
    ruche::add_compare(program, action);
    ruche::add_sensitivity(program, action);
    ruche::add_pattern(program, action);
    ruche::add_bench(program, action);
    ruche::add_calibrate(program, action);
    ruche::add_cards(program, action);
    ruche::add_virtual_test(program, action);
    ruche::add_validate(program, action);
    ruche::add_template(program, action);
    check_verbs(&program, count, arguments);
    try {
        program.parse(count, arguments);
    } catch (const CLI::ParseError& wrong) {
        if (wrong.get_exit_code() == 0) return program.exit(wrong);  // --help, --version
        fmt::print(stderr, "error: {}\n  `ruche --help` and `ruche VERB --help` show what can be said.\n",
                   wrong.what());
        return static_cast<int>(ruche::ExitCode::bad_input);
    }
    return static_cast<int>(action());
}

int failure(const char* reason) {
    fmt::print(stderr, "error: {}\n", reason);
    return static_cast<int>(ruche::ExitCode::failed);
}

int run_and_report(int count, char** arguments) {
    try {
        return run(count, arguments);
    } catch (const ruche::InputError& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return static_cast<int>(ruche::ExitCode::bad_input);
    } catch (const std::bad_alloc&) {
        return failure("out of memory; try larger elements (mesh.size_mm, mesh.fabric_size_mm)");
    } catch (const std::exception& error) {
        return failure(error.what());
    }
}

}  // namespace

int main(int count, char** arguments) {
    try {
        ruche::run_beside_signals([count, arguments] {
            const int status = run_and_report(count, arguments);
#ifdef __SANITIZE_ADDRESS__
            std::exit(status);  // looks for leaks
#else
            // Without the libraries' farewells: where memory is limited a thread of OpenBLAS may still be
            // waiting for its share, and OpenBLAS would wait for that thread.
            std::fflush(nullptr);
            std::_Exit(status);
#endif
        });
    } catch (const std::exception& error) {
        return failure(error.what());
    }
}

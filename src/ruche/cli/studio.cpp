#include "ruche/studio/studio.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/verbs.hpp"

namespace ruche {

namespace {
struct StudioArguments {
    StudioOptions options;
    bool no_browser = false;
};
}  // namespace

static bool has_display() {
    const auto set = [](const char* name) {
        const char* value = std::getenv(name);
        return value != nullptr && *value != '\0';
    };
    return set("DISPLAY") || set("WAYLAND_DISPLAY");
}

/// The browser that the desktop opens addresses with. Whether it worked is for the user to see: the address
/// is printed anyway.
static void open_browser(const std::string& address) {
    std::string program = "xdg-open";
    std::string argument = address;
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    sigset_t none;  // the signals that this program's threads leave to its first one
    sigemptyset(&none);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setsigmask(&attributes, &none);
    pid_t child = 0;
    posix_spawnp(&child, program.c_str(), nullptr, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
}

static ExitCode run(const StudioArguments& arguments) {
    if (!can_open_studio())
        throw std::runtime_error(
            "this program was built without npm, and so without the studio's page: "
            "tools/setup installs what is missing");
    watch_for_interrupts();
    run_studio(arguments.options, interrupted(), [&](const std::string& address) {
        fmt::print("The studio is open at {}\nCtrl-C closes it; what is done stays in the folder.\n",
                   address);
        std::fflush(stdout);
        if (!arguments.no_browser && has_display()) open_browser(address);
    });
    return ExitCode::converged;
}

void add_studio(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<StudioArguments>();
    CLI::App* verb = program.add_subcommand(
        "studio", "Open a page in the browser: drop a drawing, set numbers, watch the shape come up");
    verb->add_option("folder", arguments->options.folder, "Folder with drawings, scenes and results")
        ->type_name("FOLDER");
    verb->add_option("--port", arguments->options.port, "Port on this machine; 0 takes any free one")
        ->check(CLI::Range(0, 65535))
        ->type_name("N");
    verb->add_flag("--no-browser", arguments->no_browser, "Only print the address");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace ruche

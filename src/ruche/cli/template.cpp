#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "ruche/cli/verbs.hpp"
#include "ruche/scene/write_scene.hpp"

namespace ruche {

void add_template(CLI::App& program, Action& action) {
    const auto manual = std::make_shared<bool>(false);
    CLI::App* verb =
        program.add_subcommand("template", "Print a scene file with every key, its default and meaning");
    verb->add_flag("--manual", *manual, "Print the same as a page of the manual (Markdown)");
    verb->callback([manual, &action] {
        action = [manual] {
            fmt::print("{}", *manual ? scene_manual() : scene_template());
            return ExitCode::converged;
        };
    });
}

}  // namespace ruche

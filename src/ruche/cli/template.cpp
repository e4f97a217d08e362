#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "ruche/cli/verbs.hpp"
#include "ruche/scene/write_scene.hpp"
#include "ruche/study/calibration/campaign.hpp"

namespace ruche {

void add_template(CLI::App& program, Action& action) {
    const auto manual = std::make_shared<bool>(false);
    const auto campaign = std::make_shared<bool>(false);
    CLI::App* verb =
        program.add_subcommand("template", "Print a scene file with every key, its default and meaning");
    verb->add_flag("--manual", *manual, "Print the same as a page of the manual (Markdown)");
    verb->add_flag("--campaign", *campaign,
                   "Print every key of a campaign file of `ruche calibrate` (Markdown)")
        ->excludes("--manual");
    verb->callback([manual, campaign, &action] {
        action = [manual, campaign] {
            fmt::print("{}", *campaign ? campaign_manual() : *manual ? scene_manual() : scene_template());
            return ExitCode::converged;
        };
    });
}

}  // namespace ruche

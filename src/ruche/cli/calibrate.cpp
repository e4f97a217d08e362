#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/atomic_file.hpp"
#include "ruche/study/calibration/calibration.hpp"
#include "ruche/study/calibration/calibration_page.hpp"
#include "ruche/study/calibration/card_values.hpp"

namespace ruche {

namespace {
struct CalibrateArguments {
    std::string campaign;
    std::string card;
    std::string report;
    std::string mode;
    bool quiet = false;
};
}  // namespace

static void print_card(const Calibration& result) {
    for (const CardSet& set : result.card.sets) {
        fmt::print("pre-stretch {:g}\n", set.prestretch);
        for (const Field<Material>& field : fields<Material>()) {
            const CardValue& value = set.values.at(std::string(bare_name(info(field))));
            const std::string interval =
                value.interval ? fmt::format("[{:.5g}, {:.5g}]", value.interval->at(0), value.interval->at(1))
                               : "";
            const std::string source = value.source.substr(0, value.source.find(';'));
            fmt::print("  {:30} {:>12.6g}  {:26} {}\n", field.key, value.value, interval, source);
        }
    }
    for (const CalibratedSet& set : result.sets) {
        double widest = 0.0;
        for (const CurveBand& band : set.fit.bands) widest = std::max(widest, band.over_full_scale);
        if (widest > 0.0)
            fmt::print(
                "the readings determine the curves at a pre-stretch of {:g} within {:.2g} % of full scale\n",
                set.prestretch, 100.0 * widest);
    }
    for (const std::string& warning : result.warnings) fmt::print("warning: {}\n", warning);
}

static ExitCode run(const CalibrateArguments& arguments) {
    Campaign campaign = read_campaign(arguments.campaign);
    if (!arguments.mode.empty())
        campaign.options.mode = arguments.mode == "paper" ? FitMode::paper : FitMode::joint;
    const std::string card = arguments.card.empty()
                                 ? std::filesystem::path(arguments.campaign).stem().string() + "-card.toml"
                                 : arguments.card;
    const std::string report = arguments.report.empty()
                                   ? std::filesystem::path(card).replace_extension(".html").string()
                                   : arguments.report;
    ProgressDisplay display;
    Control control;
    if (!arguments.quiet) control.report = [&](const Progress& progress) { display.show(progress); };
    const Calibration result = calibrate(campaign, control);
    display.clear();
    // Both or none: the card is what counts, so its name comes last.
    PendingFile card_file(card, card_text(result.card));
    PendingFile report_file(report, calibration_page(result));
    report_file.commit();
    card_file.commit();
    if (!arguments.quiet) {
        print_card(result);
        fmt::print("written:\n  {}\n  {}\n", card, report);
    }
    return ExitCode::converged;
}

void add_calibrate(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<CalibrateArguments>();
    CLI::App* verb = program.add_subcommand(
        "calibrate", "Fit a material card to the files of tension, shear and bending tests");
    verb->add_option("campaign", arguments->campaign, "Campaign file: which tests were made on what samples")
        ->type_name("CAMPAIGN.toml")
        ->required();
    verb->add_option("-o,--output", arguments->card, "The card; else NAME-card.toml")->type_name("CARD.toml");
    verb->add_option("--report", arguments->report, "Page with plots; else the card's name with .html")
        ->type_name("PAGE.html");
    verb->add_option("--mode", arguments->mode, "How to fit, instead of what the campaign says")
        ->check(CLI::IsMember({"joint", "paper"}));
    verb->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace ruche

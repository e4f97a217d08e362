#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "ruche/cli/interrupt.hpp"
#include "ruche/cli/progress_display.hpp"
#include "ruche/cli/verbs.hpp"
#include "ruche/core/atomic_file.hpp"
#include "ruche/core/table_reader.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/output/result_folder.hpp"
#include "ruche/scene/overrides.hpp"
#include "ruche/study/virtual_test/virtual_campaign.hpp"

namespace ruche {

namespace {

namespace fs = std::filesystem;

struct VirtualTestArguments {
    std::string card;
    std::string folder;
    std::string curves;
    std::map<std::string, std::string> values;  ///< by key of a field, "" = not given
};

/// "--length-mm" for the key "length_mm".
std::string option_name(std::string key) {
    std::replace(key.begin(), key.end(), '_', '-');
    return "--" + key;
}

template <class Struct>
void add_options(CLI::App& verb, VirtualTestArguments& arguments) {
    const Struct defaults;
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        const std::string range = range_text(about);
        std::string help = fmt::format("{} Default: {}", about.meaning, to_string(get(defaults, field)));
        if (!range.empty()) help += " (allowed: " + range + ")";
        const std::string key(about.key);
        verb.add_option(option_name(key), arguments.values[key], help)->type_name("VALUE");
    }
}

/// What the user gave for a struct's fields, as overrides; texts in quotes, so that "45" is one too.
template <class Struct>
void collect(const VirtualTestArguments& arguments, std::vector<Override>& given) {
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        const std::string key(about.key);
        const std::string& value = arguments.values.at(key);
        if (value.empty()) continue;
        const bool text = about.kind == FieldKind::text || about.kind == FieldKind::choice;
        given.push_back({key, text ? toml_quoted(value) : value, option_name(key) + " " + value});
    }
}

ExitCode virtual_test(const VirtualTestArguments& arguments) {
    std::vector<Override> given;
    collect<VirtualSamples>(arguments, given);
    collect<VirtualMachine>(arguments, given);
    Node options;
    apply_overrides(options, given);
    VirtualSamples samples;
    VirtualMachine machine;
    TableReader reader(options, "");
    reader.read(samples);
    reader.read(machine);

    const ResolvedCard card = resolve_card(arguments.card, {samples.prestretch, samples.prestretch});
    for (const std::string& warning : card.warnings) fmt::print(stderr, "warning: {}\n", warning);
    check_result_folder(arguments.folder);
    const std::string curves_file =
        arguments.curves.empty() ? (fs::path(arguments.folder) / "curves.json").string() : arguments.curves;

    std::optional<VirtualCurves> curves;
    constexpr std::size_t longest = 64U << 20U;
    if (std::error_code ignored; fs::exists(curves_file, ignored))
        curves =
            same_curves(read_file(curves_file, "file of simulated curves", longest), samples, card.material);
    const bool simulated = !curves;
    if (simulated) {
        watch_for_interrupts();
        ProgressDisplay display;
        const Control control{.report = [&](const Progress& progress) { display.show(progress); },
                              .stop = &interrupted()};
        try {
            curves = simulate_tests(samples, card.material, control);
        } catch (const std::runtime_error&) {
            if (interrupted()) return ExitCode::interrupted;
            throw;
        }
        display.clear();
    }

    fs::create_directories(arguments.folder);
    std::vector<PendingFile> pending;
    if (simulated) pending.emplace_back(curves_file, to_json(*curves));
    for (const LabFile& file : virtual_campaign(*curves, machine, card.name))
        pending.emplace_back((fs::path(arguments.folder) / file.name).string(), file.contents);
    for (PendingFile& file : pending) file.commit();

    fmt::print("{}: {} records and {} cantilever readings; the simulated curves {} {}\n", arguments.folder,
               curves->curves.size(), 2 * curves->droops.size(), simulated ? "stand in" : "are those of",
               curves_file);
    fmt::print("next: ruche calibrate {} -o card.toml\n",
               (fs::path(arguments.folder) / "campaign.toml").string());
    return ExitCode::converged;
}

}  // namespace

void add_virtual_test(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<VirtualTestArguments>();
    CLI::App* verb = program.add_subcommand(
        "virtual-test", "Simulate a card's material tests, as a testing machine would record them");
    verb->add_option("card", arguments->card, "Material card: a name from `ruche cards`, or a card file")
        ->required()
        ->type_name("CARD");
    verb->add_option("-o,--output", arguments->folder, "Folder to write into")->required()->type_name("DIR");
    verb->add_option(
            "--curves", arguments->curves,
            "Simulated curves: used when made with the same card and samples, else written. Default: "
            "curves.json in DIR")
        ->type_name("FILE.json");
    add_options<VirtualSamples>(*verb, *arguments);
    add_options<VirtualMachine>(*verb, *arguments);
    verb->callback([arguments, &action] { action = [arguments] { return virtual_test(*arguments); }; });
}

}  // namespace ruche

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "ruche/cli/verbs.hpp"
#include "ruche/core/atomic_file.hpp"
#include "ruche/pattern/generator_registry.hpp"
#include "ruche/pattern/svg_export.hpp"

namespace ruche {

namespace {
struct PatternArguments {
    std::string name;
    std::string output;
    std::map<std::string, std::string> values;  ///< by option key, "" = not given
};
}  // namespace

static ExitCode write_pattern(const PatternArguments& arguments) {
    std::map<std::string, std::string> given;
    for (const auto& [key, value] : arguments.values)
        if (!value.empty()) given[key] = value;
    const GeneratedPattern pattern =
        generate(arguments.name, given, {.key = "ruche pattern " + arguments.name});
    const std::string svg = to_svg(pattern);
    for (const std::string& warning : pattern.warnings) fmt::print(stderr, "warning: {}\n", warning);
    if (arguments.output.empty()) {
        fmt::print("{}", svg);
        return ExitCode::converged;
    }
    write_file_atomically(arguments.output, svg);
    fmt::print("{}: {} strips, {}\n", arguments.output, pattern.strips.size(), pattern.description);
    fmt::print("next: ruche simulate {}\n", arguments.output);
    return ExitCode::converged;
}

/// "--inner-mm" for the key "inner_mm".
static std::string option_name(std::string key) {
    std::replace(key.begin(), key.end(), '_', '-');
    return "--" + key;
}

void add_pattern(CLI::App& program, Action& action) {
    CLI::App* verb = program.add_subcommand("pattern", "Draw a built-in pattern as SVG");
    verb->require_subcommand(1);
    for (const GeneratorInfo& generator : generators()) {
        const auto arguments = std::make_shared<PatternArguments>();
        arguments->name = generator.name;
        CLI::App* drawing = verb->add_subcommand(generator.name, generator.summary);
        drawing->add_option("-o,--output", arguments->output, "File to write; without it the SVG is printed")
            ->type_name("FILE.svg");
        for (const GeneratorOption& option : generator.options) {
            std::string help = option.meaning + " Default: " + option.initial + " " + option.unit;
            if (!option.range.empty()) help += " (allowed: " + option.range + ")";
            drawing->add_option(option_name(option.key), arguments->values[option.key], help)
                ->type_name("VALUE");
        }
        drawing->callback(
            [arguments, &action] { action = [arguments] { return write_pattern(*arguments); }; });
    }
}

}  // namespace ruche

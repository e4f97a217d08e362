#include <fmt/format.h>

#include "ruche/core/document.hpp"
#include "ruche/core/manual.hpp"
#include "ruche/pattern/generator_registry.hpp"
#include "ruche/scene/write_scene.hpp"

namespace ruche {

/// Breaks a text into lines of at most `width` characters, each after `prefix`.
static std::string wrapped(std::string_view text, std::string_view prefix, std::size_t width = 100) {
    std::string result;
    while (!text.empty()) {
        std::size_t length = text.size();
        if (length > width - prefix.size()) length = text.rfind(' ', width - prefix.size());
        if (length == std::string_view::npos) length = text.size();
        result += fmt::format("{}{}\n", prefix, text.substr(0, length));
        text.remove_prefix(length == text.size() ? length : length + 1);
    }
    return result;
}

/// What each section is for, in the order of `for_each_section`.
static std::string_view purpose(std::string_view section) {
    static constexpr std::pair<std::string_view, std::string_view> purposes[] = {
        {"pattern", "What is printed: exactly one of svg, mesh and generator."},
        {"fabric", "The fabric, and how it is stretched on the printing frame."},
        {"material",
         "Values here replace those of the card. Where one is from may be said in [material.source], by the "
         "name without unit: gamma_1 = \"measured 2026-03-02\"."},
        {"plastic", "The print. Write plastic = \"none\" above all sections when nothing is printed."},
        {"mesh", "The triangle mesh."},
        {"model", "Choices of the mechanical model; the defaults converge when the mesh is refined."},
        {"solver", "How the released shape is found."},
        {"gravity", "Weight of fabric and plastic, and a table to rest on."},
        {"output", "Files to write beside report.json."},
    };
    for (const auto& [name, text] : purposes)
        if (name == section) return text;
    return {};
}

template <class Struct>
static std::string documented(const Struct& s, std::string_view prefix) {
    std::string text;
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        const std::string range = admissible(about);
        text += wrapped(fmt::format("{}{}{}", field.meaning, range.empty() ? "" : " Allowed: ", range), "# ");
        text += fmt::format("{}{} = {}\n", prefix, field.key, written(about, get(s, field)));
    }
    return text;
}

static Scene example() {
    Scene scene;
    scene.pattern.svg = "drawing.svg";
    return scene;
}

static constexpr std::string_view commented = "# ";

std::string scene_template() {
    const Scene scene = example();
    std::string text = "# Every key of a scene file, with its default. Printed by `ruche template`.\n";
    for_each_section(scene, [&]<class Section>(const std::string& name, const Section& section) {
        text += "\n" + wrapped(purpose(name), "# ") + fmt::format("[{}]\n", name) + documented(section, "");
        if (name == "pattern")
            text += "# [pattern.options]   (of the generator: `ruche pattern NAME --help`)\n";
        if (name != "plastic") return;
        text += "\n# Any number of rules: which drawn shapes mean what.\n# [[plastic.rule]]\n" +
                documented(PrintRule{.match = "#ff0000"}, commented);
    });
    text += "\n# Any number of supports: vertices that are held.\n# [[support]]\n" +
            documented(Selection{}, commented) + documented(SupportOptions{}, commented);
    text += "\n# Any number of forces.\n# [[force]]\n" + documented(Selection{}, commented) +
            documented(ForceOptions{}, commented);
    return text;
}

std::string scene_manual() {
    const Scene scene = example();
    std::string text =
        "# The scene file\n"
        "A TOML file. Every key has a default except the pattern; the unit is part of the key. Unknown keys "
        "are\n"
        "errors. Paths are relative to the scene file. `--set section.key=value` overrides a value from the\n"
        "command line; entries of lists count from 1 (`--set plastic.rule.1.thickness_mm=0.8`). This page "
        "is\n"
        "printed by `ruche template --manual`.\n";
    for_each_section(scene, [&]<class Section>(const std::string& name, const Section& section) {
        text += manual_heading("[" + name + "]", purpose(name)) + manual_rows(section);
        if (name == "plastic")
            text += manual_heading("[[plastic.rule]]", "Which drawn shapes mean what.") +
                    manual_rows(PrintRule{});
    });
    for (const GeneratorInfo& generator : generators()) {
        text += manual_heading(fmt::format("[pattern.options] of {}", generator.name), generator.summary);
        for (const GeneratorOption& option : generator.options)
            text += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", option.key, option.initial, option.unit,
                                markdown_cell(option.range), markdown_cell(option.meaning));
    }
    text += manual_heading("[[support]]", "Vertices that are held.") + manual_rows(Selection{}) +
            manual_rows(SupportOptions{});
    text +=
        manual_heading("[[force]]", "Dead forces.") + manual_rows(Selection{}) + manual_rows(ForceOptions{});
    return text;
}

}  // namespace ruche

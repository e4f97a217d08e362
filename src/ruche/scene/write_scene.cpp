#include "ruche/scene/write_scene.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "ruche/core/document.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/pattern/generator_registry.hpp"

namespace ruche {

static std::string toml_value(const FieldInfo& about, const FieldValue& value) {
    const bool text = about.kind == FieldKind::text || about.kind == FieldKind::choice;
    return text ? toml_quoted(std::get<std::string>(value)) : to_string(value);
}

template <class Struct>
static std::string lines(const Struct& s) {
    std::string text;
    for (const Field<Struct>& field : fields<Struct>())
        text += fmt::format("{} = {}\n", field.key, toml_value(info(field), get(s, field)));
    return text;
}

/// A path of the scene as it is written in a scene file that lies in `folder`.
static std::string path_from(const std::string& folder, const Scene& scene, const std::string& path) {
    std::error_code failed;
    const std::filesystem::path from_there =
        std::filesystem::proximate(resolved_path(scene, path), folder.empty() ? "." : folder, failed);
    return failed ? path : from_there.string();
}

/// Paths that mean the same file when the scene is kept in another folder.
static PatternSource moved(const Scene& scene, const std::string& folder) {
    PatternSource pattern = scene.pattern;
    std::vector<std::string*> paths = {&pattern.svg, &pattern.mesh, &pattern.thickness_table};
    const auto option = pattern.generator_options.find(generator_file_option);
    if (option != pattern.generator_options.end()) paths.push_back(&option->second);
    for (std::string* path : paths)
        if (!path->empty()) *path = path_from(folder, scene, *path);
    return pattern;
}

static FabricOptions moved_fabric(const Scene& scene, const std::string& folder) {
    FabricOptions fabric = scene.fabric;
    if (is_card_path(fabric.card)) fabric.card = path_from(folder, scene, fabric.card);
    return fabric;
}

static std::string material_source_lines(const Scene& scene) {
    std::string text;
    for (const auto& [name, source] : scene.material_sources)
        text += fmt::format("{} = {}\n", name, toml_quoted(source));
    return text.empty() ? text : "\n[material.source]\n" + text;
}

static std::string pattern_lines(const PatternSource& pattern) {
    std::string text;
    for (const auto& [key, value] : pattern.generator_options)
        text += fmt::format("{} = {}\n", toml_quoted(key), toml_quoted(value));
    return lines(pattern) + (text.empty() ? text : "\n[pattern.options]\n" + text);
}

std::string to_toml(const Scene& scene, const std::string& folder) {
    std::string text = scene.plastic.none ? "plastic = \"none\"\n" : "";
    for_each_section(scene, [&]<class Section>(const std::string& name, const Section& section) {
        if (name == "plastic" && scene.plastic.none) return;
        text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", name);
        if constexpr (std::is_same_v<Section, PatternSource>)
            text += pattern_lines(moved(scene, folder));
        else if constexpr (std::is_same_v<Section, FabricOptions>)
            text += lines(moved_fabric(scene, folder));
        else if constexpr (std::is_same_v<Section, Material>)
            text += lines(section) + material_source_lines(scene);
        else
            text += lines(section);
        if constexpr (std::is_same_v<Section, PlasticOptions>)
            for (const PrintRule& rule : section.rules) text += "\n[[plastic.rule]]\n" + lines(rule);
    });
    for (const SupportOptions& support : scene.supports)
        text += "\n[[support]]\n" + lines<Selection>(support) + lines(support);
    for (const ForceOptions& force : scene.forces)
        text += "\n[[force]]\n" + lines<Selection>(force) + lines(force);
    return text;
}

}  // namespace ruche

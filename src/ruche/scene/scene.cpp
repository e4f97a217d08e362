#include "ruche/scene/scene.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "ruche/material/cards.hpp"
#include "ruche/pattern/generator_registry.hpp"

namespace ruche {

std::string resolved_path(const Scene& scene, const std::string& path) {
    return (std::filesystem::path(scene.file).parent_path() / path).string();
}

std::map<std::string, std::string> resolved_generator_options(const Scene& scene) {
    std::map<std::string, std::string> options = scene.pattern.generator_options;
    const auto file = options.find(generator_file_option);
    if (file != options.end() && !file->second.empty()) file->second = resolved_path(scene, file->second);
    return options;
}

std::vector<std::string> pattern_files(const Scene& scene) {
    const PatternSource& pattern = scene.pattern;
    std::vector<std::string> files = {pattern.svg, pattern.mesh, pattern.thickness_table};
    const auto file = pattern.generator_options.find(generator_file_option);
    if (file != pattern.generator_options.end()) files.push_back(file->second);
    std::erase(files, std::string());
    return files;
}

std::string scene_name(const Scene& scene) {
    for (const std::string& path :
         {scene.file, scene.pattern.svg, scene.pattern.mesh, scene.pattern.generator}) {
        std::string stem = std::filesystem::path(path).stem().string();
        if (!stem.empty()) return stem;
    }
    return "scene";
}

template <class Section>
static std::string default_text(const Section& section, const std::string& name, std::string_view key) {
    for (const Field<Section>& field : fields<Section>())
        if (field.key == key)
            return fmt::format("{}.{} = {}{}{} (not given)", name, bare_name(info(field)),
                               to_string(get(section, field)), field.unit.empty() ? "" : " ", field.unit);
    return {};
}

std::vector<std::string> assumptions(const Scene& scene, const PrintMesh& layout) {
    std::vector<std::string> texts;
    const auto add = [&](const auto& section, const std::string& name, std::string_view key) {
        if (!scene.sources.contains(name + "." + std::string(key)))
            texts.push_back(default_text(section, name, key));
    };
    add(scene.fabric, "fabric", "card");
    add(scene.fabric, "fabric", "prestretch");
    add(scene.fabric, "fabric", "axis_deg");
    const bool drawn = scene.pattern.mesh.empty();
    if (!layout.outline_layer.empty())
        texts.push_back(
            fmt::format("fabric.outline = the drawing's layer \"{}\" (not given, taken for its name)",
                        layout.outline_layer));
    else if (drawn && scene.fabric.outline.empty())
        add(scene.fabric, "fabric", "margin_mm");
    if (drawn && !scene.plastic.none) {
        add(scene.plastic, "plastic", "thickness_mm");
        add(scene.plastic, "plastic", "side");
    }
    if (scene.model.strips == StripModel::rods)
        texts.emplace_back(
            "model.strips = rods: strips are elastic rods without width; what plastic does to the fabric "
            "across a "
            "strip is left out, and the fabric under plastic pulls as hard as the fabric beside it");
    for (std::string& text : assumed_values(scene.material, scene.material_sources))
        texts.push_back(std::move(text));
    return texts;
}

}  // namespace ruche

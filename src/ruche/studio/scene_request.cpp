#include "ruche/studio/scene_request.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "ruche/core/document.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/scene/read_scene.hpp"

namespace ruche {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* giver = "studio";  // what messages and reports name as the source of a value

/// Values that are paths, or may be.
bool names_file(const std::string& key, const std::string& text) {
    constexpr std::array paths = {"pattern.svg", "pattern.mesh", "pattern.thickness_table",
                                  "pattern.options.file"};
    if (text.empty()) return false;
    if (key == "fabric.card") return is_card_path(text);
    return std::find(paths.begin(), paths.end(), key) != paths.end();
}

std::string toml(const Json& value) {
    if (value.is_string()) return toml_quoted(value.get<std::string>());
    if (!value.is_array()) return value.dump();
    std::string list;
    for (const Json& entry : value) list += (list.empty() ? "" : ", ") + toml(entry);
    return "[" + list + "]";
}

std::string rules_as_toml(const Json& rules) {
    std::string list;
    for (const Json& rule : rules) {
        std::string entries;
        for (const auto& [key, value] : rule.items())
            entries += (entries.empty() ? "" : ", ") + toml_quoted(key) + " = " + toml(value);
        list += (list.empty() ? "{ " : ", { ") + entries + " }";
    }
    return "[" + list + "]";
}

std::vector<Override> overrides_of(const Json& request, const Workspace& workspace) {
    std::vector<Override> list;
    const Json values = request.value("values", Json::object());
    for (const auto& [key, value] : values.items()) {
        const bool file = value.is_string() && names_file(key, value.get<std::string>());
        list.push_back(
            {.path = key,
             .value = file ? toml_quoted(workspace.inside(value.get<std::string>()).string()) : toml(value),
             .option = giver});
    }
    const Json rules = request.value("rules", Json::array());
    if (!rules.empty())
        list.push_back({.path = "plastic.rule", .value = rules_as_toml(rules), .option = giver});
    return list;
}

/// What a scene file names must lie in the folder, too.
void check_files(const Scene& scene, const Workspace& workspace) {
    std::vector<std::string> files = pattern_files(scene);
    if (names_file("fabric.card", scene.fabric.card)) files.push_back(scene.fabric.card);
    for (const std::string& file : files) {
        std::error_code ignored;
        const std::filesystem::path path = std::filesystem::absolute(resolved_path(scene, file), ignored);
        try {
            (void)workspace.inside(path.lexically_normal().lexically_relative(workspace.root()).string());
        } catch (const OutsideFolder&) {
            throw OutsideFolder(
                "the scene names " + file +
                ", which lies outside the folder that the studio works in; start it in a folder "
                "that holds both");
        }
    }
}

}  // namespace

Scene scene_from_request(const std::string& json, const Workspace& workspace) {
    const Json request = Json::parse(json);
    const Json& base = request.at("base");
    const std::vector<Override> overrides = overrides_of(request, workspace);
    Scene scene;
    if (base.contains("svg")) {
        scene = scene_from_drawing(workspace.inside(base.at("svg").get<std::string>()).string(), overrides);
    } else if (base.contains("generator")) {
        std::vector<Override> all = {
            {.path = "pattern.generator", .value = toml(base.at("generator")), .option = giver}};
        all.insert(all.end(), overrides.begin(), overrides.end());
        scene = parse_scene("", "", all);
    } else {
        scene = read_scene(workspace.inside(base.at("scene").get<std::string>()).string(), overrides);
    }
    check_files(scene, workspace);
    return scene;
}

}  // namespace ruche

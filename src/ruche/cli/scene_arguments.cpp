#include "ruche/cli/scene_arguments.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "ruche/scene/read_scene.hpp"

namespace ruche {

void add_scene_arguments(CLI::App& verb, SceneArguments& arguments) {
    verb.add_option("scene", arguments.file, "Scene file (.toml), drawing (.svg) or layout mesh (.ply, .obj)")
        ->required()
        ->type_name("SCENE|DRAWING");
    verb.add_option("--set", arguments.changes, "Replace a value of the scene; may be repeated")
        ->type_name("path=value")
        ->allow_extra_args(false)
        ->take_all();
    arguments.shortcuts = {
        {"--stretch", "fabric.prestretch", "Length on the printing frame over relaxed length", ""},
        {"--thickness-mm", "plastic.thickness_mm", "Thickness of the print", ""},
        {"--side", "plastic.side", "Side that is printed on: front or back", ""},
        {"--width-mm", "pattern.width_mm", "Scale the drawing so that its page is this wide", ""},
        {"--threads", "solver.threads", "Threads to use; 0 takes every core", ""},
    };
    for (SceneArguments::Shortcut& shortcut : arguments.shortcuts)
        verb.add_option(shortcut.option, shortcut.value, shortcut.meaning + " (" + shortcut.path + ")")
            ->type_name("VALUE");
}

Scene read_scene(const SceneArguments& arguments) {
    std::vector<Override> overrides;
    for (const SceneArguments::Shortcut& shortcut : arguments.shortcuts)
        if (!shortcut.value.empty())
            overrides.push_back({shortcut.path, shortcut.value, shortcut.option + " " + shortcut.value});
    for (const std::string& change : arguments.changes) overrides.push_back(parse_override(change));
    return read_scene_or_drawing(arguments.file, overrides);
}

std::string state_path(const std::string& result) {
    std::error_code ignored;
    const std::filesystem::path path(result);
    return std::filesystem::is_directory(path, ignored) ? (path / "state.ruche").string() : result;
}

bool is_drawing(const SceneArguments& arguments) { return !arguments.file.ends_with(".toml"); }

}  // namespace ruche

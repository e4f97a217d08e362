#pragma once

#include <string>
#include <vector>

#include "ruche/scene/scene.hpp"

namespace CLI {
class App;
}

namespace ruche {

/// What the verbs that take a scene have in common: the file, --set, and short options for the values that
/// go with a bare drawing.
struct SceneArguments {
    std::string file;
    std::vector<std::string> changes;  ///< of --set, "path=value"

    struct Shortcut {
        std::string option;  ///< "--stretch"
        std::string path;    ///< "fabric.prestretch"
        std::string meaning;
        std::string value;
    };
    std::vector<Shortcut> shortcuts;
};

/// Adds the options; `arguments` must outlive the program's parsing.
void add_scene_arguments(CLI::App& verb, SceneArguments& arguments);

/// Reads the scene or drawing with all that was said on the command line. Throws InputError.
Scene read_scene(const SceneArguments& arguments);

/// Whether a drawing was given directly, so that nearly everything is assumed.
bool is_drawing(const SceneArguments& arguments);

/// The state file of a result's folder, or the file itself.
std::string state_path(const std::string& result);

}  // namespace ruche

#pragma once

#include <string>

#include "ruche/scene/scene.hpp"

namespace ruche {

/// The complete scene as TOML: every value, defaults written out, and the source of each material value.
/// `read_scene` makes the same scene of it when the text is kept in `folder` (to which paths are relative).
std::string to_toml(const Scene& scene, const std::string& folder = {});

/// A documented scene file with every key, its default, unit, range and meaning; generated from the field
/// tables. Reads as a scene once its pattern exists.
std::string scene_template();

/// The same as tables of a Markdown page.
std::string scene_manual();

}  // namespace ruche

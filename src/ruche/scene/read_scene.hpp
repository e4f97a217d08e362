#pragma once

#include <string>
#include <vector>

#include "ruche/scene/overrides.hpp"
#include "ruche/scene/scene.hpp"

namespace ruche {

/// Reads a scene file, applies the overrides, takes the material from its card, and checks everything that
/// can be checked without meshing. Throws InputError with file, line, key and advice for every mistake.
Scene read_scene(const std::string& path, const std::vector<Override>& overrides = {});

/// The same from text; `file` is named in messages, and relative paths are relative to its folder.
Scene parse_scene(const std::string& text, const std::string& file,
                  const std::vector<Override>& overrides = {});

/// A scene around a drawing (.svg) or a layout mesh (.ply, .obj): everything else has its default unless
/// overridden.
Scene scene_from_drawing(const std::string& path, const std::vector<Override>& overrides = {});

/// `read_scene` for .toml, `scene_from_drawing` for drawings and meshes, by the file's ending. Throws
/// InputError for any other.
Scene read_scene_or_drawing(const std::string& path, const std::vector<Override>& overrides = {});

}  // namespace ruche

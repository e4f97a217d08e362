#pragma once

#include <string>

#include "ruche/scene/scene.hpp"
#include "ruche/studio/workspace.hpp"

namespace ruche {

/// What a page has set, as a scene. `json` is
///
///     {"base": {"svg": "torus.svg"} or {"generator": "radial"} or {"scene": "kite.toml"},
///      "values": {"fabric.prestretch": 1.7, "pattern.options.inner_mm": "12", ...},
///      "rules": [{"match": "#d9480f", "thickness_mm": 0.8, "side": "back"}, ...]}
///
/// Values are those of a scene file; of a generator's options, text. Rules, where there are any, replace
/// those of the scene. Throws InputError as `read_scene` does, OutsideFolder when a file that is named, also
/// by the scene file, is not in the folder, and nlohmann's exceptions for what is no such request.
Scene scene_from_request(const std::string& json, const Workspace& workspace);

/// The printed pattern as JSON for a drawing to scale: {"box": [x0, y0, x1, y1] mm, "fabric": "M ...",
/// "strips":
/// [{"id", "side", "thickness_mm", "path"}], "marks": [{"match": "#d9480f", "kind": "colour", "count": 12}],
/// "warnings": [...], "values": {"fabric.prestretch": [1.7, 1.7], ...}, "name": "torus"}; paths as in SVG, y
/// upwards; values are all of the scene's, defaults written out. Throws InputError.
std::string drawing_json(const Scene& scene);

/// The drawing of a scene, as SVG: its file, or what its generator draws. Throws InputError for a scene that
/// has a mesh instead.
std::string drawing_svg(const Scene& scene);

/// Everything that a form is made of: the fields of each section of a scene, generators with their options,
/// cards, drawings and scenes of the folder, the program's version.
std::string form_json(const Workspace& workspace);

}  // namespace ruche

#pragma once

#include <span>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// Writes what `result.scene.output` asks for into the folder `dir` (made if needed): shape and layout as
/// .obj, .ply and .vtu, shape.glb, shape.stl, picture.png, report.html; and always scene.toml (complete: can
/// be run again), state.ruche (to resume or start from) and report.json. All files are first written
/// completely under temporary names; only then does the new result replace an earlier one, report.json last,
/// and files of the earlier result that this one does not have are removed. `energy_density` (mJ per mm^2 of
/// layout, one per triangle, or none) becomes a field of the surfaces. Returns the paths written. Throws
/// std::runtime_error with path and reason; the earlier result is then as it was. `control.stop` is not
/// looked at: an interrupted run writes its last state.
std::vector<std::string> write_outputs(const Result& result, const std::string& dir,
                                       const Control& control = {},
                                       std::span<const double> energy_density = {});

/// Removes a result's files from a folder, and the folder when nothing else is in it; does nothing where
/// there is no report.
void remove_outputs(const std::string& dir);

}  // namespace ruche

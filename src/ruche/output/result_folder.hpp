#pragma once

#include <string>
#include <vector>

#include "ruche/scene/result.hpp"

namespace ruche {

/// Throws std::runtime_error when results could not be written there: a file stands in the way, or there is
/// no permission. To be asked before a long computation.
void check_result_folder(const std::string& folder);

/// Whether the folder holds the result of a run that came to its end.
bool holds_finished_result(const std::string& folder);

/// Writes report.json, scene.toml (complete, can be simulated again), state.ruche, and what [output] asks
/// for: shape and layout as OBJ, PLY, VTU, GLB, picture.png. All files are complete before the first takes
/// its place, so that an earlier result is replaced as a whole or not at all. An interrupted result does not
/// replace a finished one: then only state.ruche is written. Returns the paths written. Throws
/// std::runtime_error when the disk does not take it; the earlier result is then still there.
std::vector<std::string> write_result(const Result& result, const std::string& folder);

}  // namespace ruche

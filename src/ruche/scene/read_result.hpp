#pragma once

#include <string>

#include "ruche/scene/result.hpp"

namespace ruche {

/// The result that lies in a folder, from its scene.toml, state.ruche and report.json: mesh, shape, energy
/// density, self-intersections, whether it is converged and stable. Its effort, warnings and assumptions stay
/// in its report. Throws InputError where there is none, a file is damaged, or the drawing has changed since
/// so that its mesh is another one.
Result read_result(const std::string& folder);

}  // namespace ruche

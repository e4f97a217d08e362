#pragma once

#include <span>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// Where a step bends the sheet, if nearly all of that is in a few places: the vertices of each place, with
/// some rings around where it bends; empty when the step bends the sheet all over, or hardly at all. `spins`:
/// by how much the step turns each triangle, rad. `held`: one flag per unknown; a held vertex is in no place.
std::vector<std::vector<int>> bending_places(const Model& model, std::span<const char> held,
                                             std::span<const Vec3> spins);

}  // namespace ruche

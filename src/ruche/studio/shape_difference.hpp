#pragma once

#include <string>

namespace ruche {

/// How two released shapes lie to each other, from their state files, as JSON: the motion that takes the
/// second nearest to the first, {"rotation": [9 numbers, row by row], "translation": [3], "rms_mm",
/// "largest_mm"}. Points of the same place of the layout are compared; places that only one has are left out.
/// Throws InputError for files that are none, and where the layouts have no place in common.
std::string shape_difference(const std::string& first_state, const std::string& second_state);

}  // namespace ruche

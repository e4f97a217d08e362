#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ruche {

/// "; did you mean fabric_thickness_mm?" when one of the candidates is close to what was written (edit
/// distance with swaps of neighbours, at most a third of its length), else "".
std::string did_you_mean(std::string_view written, const std::vector<std::string_view>& candidates);

}  // namespace ruche

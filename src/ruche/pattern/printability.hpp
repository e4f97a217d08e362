#pragma once

#include "ruche/core/error.hpp"
#include "ruche/pattern/pattern.hpp"

namespace ruche {

/// Throws InputError when a strip has no area, a thickness or modulus that makes no sense, or is narrower
/// than `narrowest_feature_mm`: as a whole, in a neck that joins two parts, or in a whisker longer than 1 mm.
/// Sharp corners are allowed.
void check_strip(const Strip& strip, const Place& place);

/// Whether a polygon is narrower than `narrowest_feature_mm` everywhere.
bool is_sliver(const Polygon& polygon);

}  // namespace ruche

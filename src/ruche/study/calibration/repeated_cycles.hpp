#pragma once

#include "ruche/study/calibration/cycles.hpp"

namespace ruche {

/// The cycles, in their order, whose branch says the same as that of cycle `last`: itself, and those right
/// before it that cannot be told from it. Fabric settles from cycle to cycle; where it has settled, each
/// cycle is another measurement of the same curve.
///
/// Two branches are compared by the extra-sum-of-squares F test at 99 %: in up to ten pieces each, a cubic
/// for both against a cubic plus an offset between the two; of force and, where it was measured, width over
/// displacement (of displacement over force where masses were hung). What the noise hides is at most about
/// as large as what it does to the mean.
std::vector<std::size_t> repeated_cycles(const TestRecord& record, const std::vector<Cycle>& cycles,
                                         std::size_t last, Branch branch);

}  // namespace ruche

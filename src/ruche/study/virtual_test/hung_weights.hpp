#pragma once

#include <string>

#include "ruche/study/virtual_test/virtual_machine.hpp"

namespace ruche {

/// What someone with weights and a ruler would have written down of a tension test (the measuring protocol's
/// table: mass_g, length_mm, width_mm, branch): weights that are hung on one by one up to the curve's largest
/// force and taken off again. Branches differ by hysteresis as in `record`, in its last cycle. Length and
/// width have noise, over the largest displacement and the width; masses are exact.
std::string hung_weights_csv(const VirtualCurve& curve, double rest_length, const VirtualMachine& machine,
                             NoiseSource& noise);

}  // namespace ruche

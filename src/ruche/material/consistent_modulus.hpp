#pragma once

#include "ruche/material/material.hpp"

namespace ruche {

/// The E_f (MPa) that is consistent with the law of the bare fabric: held at the pre-stretch on the frame,
/// eq. 8's linear fabric ply then pulls as hard as the law says, in the mean of the two axes (N per mm of
/// layout). E_f also is the modulus of the law's Neo-Hookean share; the value counts that in, so a material
/// that is given it stays consistent. Of the material, everything but fabric_youngs_modulus matters. Infinite
/// or not positive without pre-stretch; outside the law's range, that of its linear continuation.
double consistent_fabric_modulus(const Material& material, const std::array<double, 2>& prestretch);

}  // namespace ruche

#pragma once

#include <string>

#include "ruche/energy/model.hpp"

namespace ruche {

/// Whether a state is a knot of the mesh and no shape of the sheet, and what says so: a sentence such as "an
/// element is crushed to 0.4 % of its area", or nothing.
///
/// A step or a start that goes too far can carry an element through itself or through its neighbour. The
/// energy has a barrier there, which then holds the element on the wrong side as firmly as it should have
/// kept it on the right one: what follows may be a strict minimum, certified and all, and still be no shape.
///
/// - *Fabric far beyond its law*: a Green strain above gamma by more than 0.05, a stretch 2 % beyond locking.
///   The law's linear extension makes fabric 50 times as stiff there as within its default width of 1e-3;
///   released sheets have been seen to lean on it by 4e-5.
/// - *Collapsed area*: below a ten-thousandth of the rest area. The law resists compression little, and
/// fabric
///   between strips that close on each other has been seen at 0.09 %; but at 1e-4 the Neo-Hookean part, for
///   all its small share, pushes with 360 MPa, more than even plastic can press it with (E_p = 72 MPa).
/// - *Folded over*: neighbours at more than 160 degrees. The hinge's energy 2 k tan(theta/2)^2 is 16 times
/// that of
///   the plate, k theta^2 / 2, and infinite at 180 degrees. Crumpled sheets have been seen to fold by 52
///   degrees on their default mesh.
/// - *Plastic turned too far against its edge normals*: |theta/2 +- xi| of 90 degrees or more, where
///   c = h sin(theta/2 +- xi) goes down again, so that bending further costs less.
std::string tangle(const Health& health);

}  // namespace ruche

#pragma once

#include "ruche/energy/model.hpp"

namespace ruche::bench {

/// A rectangular sheet with about `triangles` right triangles of 0.5 mm and staggered strips, 1 mm wide and
/// 0.6 mm thick, on two fifths of its rows: the mixture of bare and printed elements of a real pattern,
/// without a mesher.
ModelInput staggered_sheet(int triangles);

/// The sheet rolled to a radius, with its edge unknowns slightly off zero: no term and no derivative vanishes
/// there.
Eigen::VectorXd rolled_state(const Model& model, double radius_mm);

}  // namespace ruche::bench

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/scene/scene.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {

/// The released sheet and the model it is an equilibrium of.
struct Release {
    Model model;
    Equilibrium equilibrium;
    std::vector<std::string> warnings;
};

/// Releases a scene's sheet, whose layout and model are given: from coarser meshes of its pattern to the
/// given one unless `start` (all unknowns) is given or something holds the sheet; lays it on the table if
/// there is one; where the shape leans on the linear extension of the fabric's law, goes on with the paper's
/// much steeper one. With contact the sheet is released without it first: where it then touches itself
/// nowhere, that is the answer; else it begins anew from the flat state. So it does where `start` passes
/// through itself.
[[nodiscard]] Release release(const Scene& scene, const PrintMesh& layout, Model model,
                              const Control& control, const Eigen::VectorXd* start = nullptr);

}  // namespace ruche

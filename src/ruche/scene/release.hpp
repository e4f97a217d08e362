#pragma once

#include <Eigen/Core>
#include <optional>
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

/// How a solve goes on to the end: where the shape leans on the linear extension of the fabric's law, with
/// the paper's much steeper one.
SolveOptions to_the_end(const Scene& scene);

/// Releases a scene's sheet, whose layout and model are given: from coarser meshes of its pattern to the
/// given one unless `start` (all unknowns) is given or something holds the sheet; lays it on the table if
/// there is one. With contact the sheet is released without it first: where it then touches itself nowhere,
/// that is the answer; else it begins anew from the flat state. So it does where `start` passes through
/// itself.
[[nodiscard]] Release release(const Scene& scene, const PrintMesh& layout, Model model,
                              const Control& control, const Eigen::VectorXd* start = nullptr);

/// The way of a release from the flat state, for those who want to begin it with another shape. What it is
/// given must outlive it.
class ReleasePath {
  public:
    ReleasePath(const Scene& scene, const PrintMesh& layout, const Model& model);

    /// The mesh that the release begins on, the coarsest, and the model there: without contact, and without
    /// weight when the sheet is to be laid on a table.
    const PrintMesh& first_layout() const;
    const Model& first_model() const;

    /// From the flat state to the end on the finest mesh.
    [[nodiscard]] Equilibrium from_flat(const Control& control) const;
    /// From a shape of the first model.
    [[nodiscard]] Equilibrium from(Equilibrium start, const Control& control) const;

  private:
    Equilibrium climb(Equilibrium start, const Control& control) const;
    Equilibrium settle(Equilibrium free, const Control& control) const;
    Equilibrium keep_apart(Equilibrium free, const Control& control) const;
    Equilibrium lay_on_table(Equilibrium free, const Control& control) const;
    const Model& free_model() const;

    const Scene& scene_;
    const PrintMesh& layout_;
    const Model& model_;
    Scene free_scene_;                 // without contact, and without gravity when there is a table
    std::vector<PrintMesh> coarser_;   // finest first
    std::optional<Model> free_model_;  // on the finest mesh, where it is not the given one
    std::optional<Model> coarsest_model_;
};

/// An equilibrium of `model`, or of the same with a narrower extension of the fabric's law, with that model.
[[nodiscard]] Release with_its_model(Model model, Equilibrium end);

}  // namespace ruche

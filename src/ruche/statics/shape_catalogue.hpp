#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/energy/model.hpp"
#include "ruche/geometry/rigid_alignment.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/statics/sheet_symmetry.hpp"

namespace ruche {

/// The distinct stable shapes of one sheet, on one mesh.
///
/// Two states are the same when a rigid motion takes one to the other up to 1e-3 mm (root mean square over
/// the vertices), or takes it to an image of the other under a symmetry of the sheet (see SheetSymmetry): the
/// left-handed and the right-handed roll of a straight strip are one state. A mesh is hardly ever as
/// symmetric as its sheet, so the image is brought to equilibrium on it before it is compared. The energy
/// never says that two states are the same; where it differs by more than 1 % it says that no image can be.
class ShapeCatalogue {
  public:
    ShapeCatalogue(const Model& model, const SolveOptions& options, const Control& control);

    /// Where a state is found again.
    struct Match {
        int number = -1;       ///< of the state; -1 = a new one
        std::string symmetry;  ///< by which it is the image of that state; empty when it is itself
    };
    Match find(const Equilibrium& state);

    /// Takes in a state that `find` does not find. Returns its number.
    int add(Equilibrium state);

    const std::vector<Equilibrium>& states() const { return states_; }
    const std::vector<SheetSymmetry>& symmetries() const { return symmetries_; }

  private:
    struct Image {
        const SheetSymmetry* symmetry;
        std::vector<Vec3> shape;
    };
    const std::vector<Image>& images_of(int number);

    const Model& model_;
    SolveOptions options_;
    const Control& control_;
    std::vector<SheetSymmetry> symmetries_;
    std::vector<Equilibrium> states_;
    std::vector<std::optional<std::vector<Image>>> images_;  ///< found when first asked for
};

}  // namespace ruche

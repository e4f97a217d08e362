#pragma once

#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/scene/release.hpp"

namespace ruche {

/// One of the stable shapes of a scene.
struct Alternative {
    Equilibrium equilibrium;
    std::vector<std::string> found_from;  ///< "the flat state", "rolled by 180 degrees along 90 degrees", ...
};

struct AlternativeSearch {
    std::vector<Alternative> shapes;      ///< distinct, lowest energy first
    std::vector<std::string> symmetries;  ///< of the sheet; images under them are not listed as shapes
    int starts = 0;                       ///< tried
    int without_result = 0;               ///< of these: ended in no certified minimum
    bool interrupted = false;
};

/// Looks for other stable shapes than `ordinary`, the one that the scene's release led to, until there are
/// `wanted` of them with it or all starts have been tried: the sheet rolled along and across its length and
/// between, to either side, by half a turn and more, then random hills and valleys. Each start is first
/// solved on the coarsest mesh of the scene's release, in short steps so that it stays in the basin it is in;
/// what is new there (see ShapeCatalogue) is refined, and compared once more. A stop keeps what has been
/// found.
[[nodiscard]] AlternativeSearch find_alternatives(const Scene& scene, const PrintMesh& layout,
                                                  const Model& model, const Equilibrium& ordinary, int wanted,
                                                  const Control& control);

}  // namespace ruche

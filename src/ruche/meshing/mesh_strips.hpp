#pragma once

#include <map>
#include <string>
#include <vector>

#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

/// Finds the strips of a mesh from a file: triangles with the same `number` (negative: none), else those that
/// are printed alike on one side and hang together by edges. They are in the order of their numbers, then of
/// their first triangles; those without a name in `names` are called "strip-1", ... by their place in that
/// order. Their centre lines are the middles of their outlines, branches included. Fills `strip` and
/// `strips`.
void find_strips(PrintMesh& layout, const std::vector<StripPair>& number = {},
                 const std::map<int, std::string>& names = {});

}  // namespace ruche

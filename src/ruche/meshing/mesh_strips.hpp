#pragma once

#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

/// Finds the strips of a mesh that came without names: triangles of equal print that hang together by edges,
/// "strip-1", ... in the order of their first triangle. Their centre lines are the midlines of their
/// outlines. Fills `strip` and `strips`.
void find_strips(PrintMesh& layout);

}  // namespace ruche

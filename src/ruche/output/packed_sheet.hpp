#pragma once

#include <string>
#include <vector>

#include "ruche/meshing/print_mesh.hpp"
#include "ruche/output/packed_arrays.hpp"

namespace ruche {

/// Mesh, print and strips of a sheet, as the page reads them (web/src/data/result.ts); the arrays' names
/// begin with `prefix`.
void add_layout(PackedArrays& arrays, const std::string& prefix, const PrintMesh& layout);

/// x, y, z of each point, one after the other.
std::vector<double> coordinates(const std::vector<Vec3>& points);

/// How to read the arrays, as JSON: {"shape_mm": {"type": "u16", "count": ..., ...}, ...}.
std::string index_json(const PackedArrays& arrays);

}  // namespace ruche

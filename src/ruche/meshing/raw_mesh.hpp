#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

/// A triangle mesh as a file has it, before anyone looked at what it means.
struct RawMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;  ///< indices as written: they may point anywhere
    std::vector<Print> print;         ///< per triangle
    std::vector<StripPair> strip;     ///< per triangle: numbers of its strips, -1 where it has none; or empty
    std::map<int, std::string> strip_names;
};

/// PLY, text or binary of either byte order: vertices x, y and z if any; triangles with the face properties
/// `front_mm` and `back_mm` (either may be missing) or `thickness_mm` (negative: on the back), and optional
/// `front_modulus_mpa`, `back_modulus_mpa` and `front_strip`, `back_strip` or `strip` (on either side), whose
/// names stand in comments ("comment strip 0 arm"). Everything else in the file is skipped. Throws
/// InputError.
RawMesh read_ply(const std::string& path);

/// OBJ with the thickness of its triangles from a CSV table: triangle (in the file's order, from 0),
/// front_mm and, where wanted, back_mm; triangles that are not listed are bare. Throws InputError.
RawMesh read_obj(const std::string& path, const std::string& thickness_table);

/// Any surface, as scanners write them: OBJ, PLY, or STL as text or binary; polygons are cut into triangles,
/// and a file may hold points alone. Without print. Throws InputError.
RawMesh read_surface(const std::string& path);

inline constexpr std::size_t largest_mesh_file = std::size_t{1} << 30U;  ///< bytes

/// For the readers: polygons cut into a fan of triangles; fewer than three corners make none.
void append_fan(RawMesh& mesh, const std::vector<int>& corners);
RawMesh read_obj_surface(const std::string& path);

}  // namespace ruche

#pragma once

#include <string>

#include "ruche/output/export_surface.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// Each returns a whole file's contents: the same bytes for the same surface, whatever the locale.

/// Wavefront OBJ, mm: positions, layout coordinates as texture coordinates, normals; a group per strip with
/// the materials `fabric`, `plastic_front`, `plastic_back`, `plastic_both` of `material_file`. Triangles are
/// sorted by strip (bare fabric first), otherwise in the mesh's order.
std::string to_obj(const ExportSurface& surface, const std::string& material_file);

/// The material file that `to_obj` names.
std::string obj_materials();

/// PLY, ASCII, mm: every vertex and face field as a property. Reads back as a layout mesh
/// with print thickness (`front_mm`, `back_mm`).
std::string to_ply(const ExportSurface& surface);

/// VTK XML unstructured grid for ParaView, mm: fields as PointData and CellData, base64.
std::string to_vtu(const ExportSurface& surface);

/// STL, binary, mm: the bare surface.
std::string to_stl(const ExportSurface& surface);

/// glTF 2.0 in one binary file, as that format wants it in metres and with y up (our z): the fabric, and the
/// plastic with its printed thickness and slightly rounded rims, in the colours of the pictures.
std::string to_glb(const Result& result);

}  // namespace ruche

#pragma once

#include <string>
#include <vector>

#include "ruche/output/surface_fields.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// One number or vector per vertex or per triangle, as files carry it.
struct DataColumn {
    enum class Kind { float64, float32, int32 };

    std::string name;                ///< with its unit: "stretch_max", "mean_curvature_per_mm"
    std::vector<std::string> parts;  ///< names of a vector's components; empty for a number
    Kind kind = Kind::float32;
    std::vector<double> values;  ///< row by row

    int components() const { return parts.empty() ? 1 : static_cast<int>(parts.size()); }
};

/// A mesh with everything that a file format may carry along; mm.
struct ExportSurface {
    std::string title;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< unit, towards the front
    std::vector<Vec2> layout;   ///< the vertex in the flat drawing
    std::vector<Triangle> triangles;
    std::vector<int> strip;         ///< per triangle: index into strip_ids, -1 = bare fabric
    std::vector<PrintedSide> side;  ///< per triangle
    std::vector<std::string> strip_ids;
    std::vector<DataColumn> vertex_data;
    std::vector<DataColumn> face_data;
};

/// The released shape with its fields. Throws std::runtime_error when a position is not finite.
ExportSurface released_surface(const Result& result, const SurfaceFields& fields);

/// The flat layout: same vertices, triangles and fields, only the positions and normals differ.
ExportSurface layout_surface(const Result& result, const SurfaceFields& fields);

/// A name for a result: the file it came from without folder and ending, or the generator's name.
std::string result_title(const Result& result);

}  // namespace ruche

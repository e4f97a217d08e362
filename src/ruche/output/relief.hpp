#pragma once

#include <span>
#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/pattern/pattern.hpp"

namespace ruche {

/// A sheet's surface with thickness, for the eye: what viewers and pictures show of plastic and fabric.
struct Relief {
    std::vector<Vec3> positions;  ///< mm
    std::vector<Vec3> normals;    ///< unit, outwards
    std::vector<Vec2> layout;     ///< where in the layout the point belongs, mm
    std::vector<Triangle> triangles;
    std::vector<int> source;  ///< per triangle: the layout's triangle it covers or bounds
};

struct ReliefOptions {
    Side side = Side::front;  ///< which way it rises from the sheet
    double base = 0.0;        ///< height at which the walls begin, mm along the side's normal
    double rounding = 0.0;    ///< radius of the rounded rim, mm; limited by height and element size
    int segments = 3;         ///< of the rounded rim's quarter circle; 0 = a sharp rim
};

/// Raises the triangles of positive `height` (mm above the sheet, one value per triangle) off the sheet: a
/// cover at that height along smooth normals and walls down to `base` where the height changes. No floor.
/// Triangles without area or with vertices that are not finite are left out.
Relief raise(const TriangleMesh& mesh, const std::vector<Vec3>& shape, std::span<const double> height,
             const ReliefOptions& options);

}  // namespace ruche

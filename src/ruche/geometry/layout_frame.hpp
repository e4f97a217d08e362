#pragma once

#include "ruche/geometry/triangle_mesh.hpp"

namespace ruche {

/// The middle of a layout's area and the direction in which it is longest.
struct LayoutFrame {
    Vec2 centre = Vec2::Zero();
    double longest = 0.0;  ///< rad from the x axis, in (-pi/2, pi/2]; by second moments of area
};
LayoutFrame layout_frame(const TriangleMesh& mesh);

/// Middle of a triangle of the layout.
Vec2 layout_centroid(const TriangleMesh& mesh, int triangle);

}  // namespace ruche

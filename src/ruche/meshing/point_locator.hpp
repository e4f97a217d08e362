#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

/// Finds the triangle under a point of the layout, by a square grid over the mesh (which must outlive it).
class PointLocator {
  public:
    explicit PointLocator(const TriangleMesh& mesh);

    /// The point on the mesh, on a triangle that `accept` admits: the one that contains it, else the nearest
    /// one within `reach` (mm) at its nearest point. On a shared edge the triangle with the smallest number.
    std::optional<MeshPoint> find(
        const Vec2& point, double reach,
        const std::function<bool(int)>& accept = [](int) { return true; }) const;

  private:
    int column(double x) const;
    int row(double y) const;

    const TriangleMesh& mesh_;
    Vec2 low_ = Vec2::Zero();
    double spacing_ = 1.0;
    int columns_ = 1;
    int rows_ = 1;
    std::vector<std::vector<int>> cells_;  ///< triangles whose boxes touch the cell, ascending
};

/// Where a mesh point lies in the layout.
Vec2 position(const TriangleMesh& mesh, const MeshPoint& point);

}  // namespace ruche

#pragma once

#include <array>
#include <vector>

#include "ruche/geometry/box_tree.hpp"
#include "ruche/geometry/vectors.hpp"

namespace ruche {

using Corners = std::array<Vec3, 3>;

/// The point of a triangle that is nearest to p, by weights of its corners.
std::array<double, 3> nearest_weights(const Corners& triangle, const Vec3& p);

struct SurfaceHit {
    int triangle = -1;
    std::array<double, 3> weights = {};
    Vec3 point = Vec3::Zero();
};

/// Finds the nearest point of a surface, which is any set of triangles.
class SurfaceSearch {
  public:
    /// Triangles that are not finite are left out. Not empty.
    explicit SurfaceSearch(std::vector<Corners> triangles);

    SurfaceHit nearest(const Vec3& p) const;
    const std::vector<Corners>& triangles() const { return triangles_; }

  private:
    std::vector<Corners> triangles_;
    BoxTree<double> tree_;
};

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <vector>

namespace ruche {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;

/// An open or closed chain of points in the layout, mm. Closed chains do not repeat their first point.
using Polyline = std::vector<Vec2>;

/// z of the cross product.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace ruche

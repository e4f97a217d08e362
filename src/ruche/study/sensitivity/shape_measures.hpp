#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "ruche/geometry/vectors.hpp"
#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

/// A number that says something of a shape wherever it lies in space.
struct ShapeMeasure {
    std::string name;
    std::string unit;
    double value = 0.0;
};

/// Numbers that describe a released shape, and their exact derivatives when its vertices move. They do not
/// depend on rigid motions.
///
/// - mean_curvature: mean magnitude of the strips' curvature, by printed length, 1/mm
/// - mean_stretch: of the strips, released over printed length, by printed length
/// - area: of the released sheet, mm^2
/// - length, width, height: extents along the principal axes of the vertices (by layout area), mm
/// - curvature.ID: of a strip, 1/mm, signed as in the report
class ShapeMeasures {
  public:
    /// What it is given must outlive it.
    ShapeMeasures(const PrintMesh& layout, std::span<const Vec3> shape);

    const std::vector<ShapeMeasure>& values() const { return values_; }

    /// How fast each changes when the vertices move; NaN where it has no derivative (a straight strip;
    /// extents along axes that are not unique).
    std::vector<double> rates(std::span<const Vec3> velocities) const;

  private:
    void measure_extents();
    std::array<double, 3> extent_rates(std::span<const Vec3> velocities) const;
    double area_rate(std::span<const Vec3> velocities) const;

    /// An extent and the vertices that bound it.
    struct Extent {
        Vec3 axis;
        double spread = 0.0;  ///< moment of the vertices along the axis, mm^2
        int low = 0;
        int high = 0;
        double size = 0.0;
    };

    const PrintMesh& layout_;
    std::span<const Vec3> shape_;
    std::vector<ShapeMeasure> values_;
    std::vector<double> weights_;  ///< of the vertices; their sum is 1
    Vec3 mean_ = Vec3::Zero();
    std::array<Extent, 3> extents_;
    bool has_strips_ = false;            // that can be measured
    std::vector<double> strip_weights_;  // share of the printed length; 0 for a strip that cannot be measured
    std::vector<double> strip_curvatures_;
};

}  // namespace ruche

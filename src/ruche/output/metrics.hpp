#pragma once

#include <span>
#include <string>
#include <vector>

#include "ruche/geometry/vectors.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// What a strip became. NaN where it has no centre line to measure.
struct StripMetrics {
    std::string id;
    double curvature =
        0.0;               ///< of the centre line, normal to the sheet, 1/mm; positive: back (-n) is concave
    double radius = 0.0;   ///< 1/|curvature|, mm; infinite when flat (below 1e-6/mm)
    double fit_rms = 0.0;  ///< rms distance of the centre line to the fitted circle(s), mm
    double stretch = 1.0;  ///< released over printed length
    double printed_length = 0.0;  ///< of the measured centre line, mm
};

/// Curvature and stretch of every strip.
///
/// A circle is fitted to the released centre line. The line's points lie inside flat triangles, below the
/// smooth shape whose points the vertices are: by sum_i w_i |x_i - p|^2 in the circle's plane for a point p =
/// sum_i w_i x_i (exact for vertices on a cylinder: Lagrange's identity); the fit puts them back.
/// A strip that is curved in the layout is measured in pieces that turn by at most 30 degrees there, corners
/// left out; in each only the part normal to the sheet counts (Meusnier's theorem). Pieces, and the lines of
/// a strip with several, are averaged by printed length.
/// Stretch is that of the triangles (what the membrane energy measures), averaged along the line.
std::vector<StripMetrics> measure_strips(const PrintMesh& layout, std::span<const Vec3> shape);

/// How fast curvature and stretch of a strip change. NaN where there is none to measure; that of the
/// curvature where a piece of the strip is straight: its circle has no centre.
struct StripRates {
    double curvature = 0.0;
    double stretch = 0.0;
};

/// The exact derivative of measure_strips along the velocities of the vertices.
std::vector<StripRates> strip_rates(const PrintMesh& layout, std::span<const Vec3> shape,
                                    std::span<const Vec3> velocities);

/// The released shape as a whole.
struct ShapeMetrics {
    Vec3 box_min = Vec3::Zero();  ///< mm, of the shape as it lies in its coordinates
    Vec3 box_max = Vec3::Zero();
    double layout_area = 0.0;   ///< mm^2, on the frame
    double area = 0.0;          ///< mm^2, released
    double printed_area = 0.0;  ///< mm^2 of the layout with plastic
};
ShapeMetrics measure_shape(const PrintMesh& layout, std::span<const Vec3> shape);

}  // namespace ruche

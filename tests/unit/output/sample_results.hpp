#pragma once

#include <functional>

#include "ruche/scene/result.hpp"

namespace ruche::sample {

/// A flat rectangle [0, width] x [0, height] of about nx by ny cells, two triangles each, diagonals
/// alternating; inner vertices moved by up to `jitter` of a cell, the same way every time.
struct GridOptions {
    double width = 30.0;
    double height = 20.0;
    int nx = 30;
    int ny = 20;
    double jitter = 0.0;
};
TriangleMesh grid(const GridOptions& options);

/// A converged result on `mesh`: every triangle whose centroid is inside a strip's `covers` gets its print.
struct SampleStrip {
    std::string id;
    std::function<bool(const Vec2&)> covers;
    Print print;
};
Result result(TriangleMesh mesh, const std::vector<SampleStrip>& strips,
              const std::function<Vec3(const Vec2&)>& shape);

/// A sheet of 30 x 20 mm with three strips along x (front, back, both sides), rolled about the y axis to a
/// cylinder of the given radius, concave at the back.
Result rolled_sheet(double radius = 12.0, int cells_per_mm = 1);

/// An annulus of 12 to 34 mm with radial strips (20, 20 more, 40 more), risen to half a torus.
Result half_torus(int rings = 22);

/// A disc of radius 19 mm with a hexagonal tiling of three-pointed stars, as a spherical cap.
Result star_dome(int rings = 48);

}  // namespace ruche::sample

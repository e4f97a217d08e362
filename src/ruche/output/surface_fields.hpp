#pragma once

#include <span>
#include <vector>

#include "ruche/output/curvature.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// On which side a triangle is printed.
enum class PrintedSide { none = 0, front = 1, back = 2, both = 3 };

PrintedSide printed_side(const Print& print);

/// What can be seen on the released shape, per vertex and per triangle of the layout's mesh.
struct SurfaceFields {
    std::vector<Vec3> vertex_normal;                ///< unit, towards the front
    std::vector<VertexCurvature> vertex_curvature;  ///< 1/mm

    std::vector<double> front_mm;  ///< printed thickness, 0 = none
    std::vector<double> back_mm;
    std::vector<double> front_modulus_mpa;  ///< 0 = the card's; both empty when it is that everywhere
    std::vector<double> back_modulus_mpa;
    std::vector<PrintedSide> side;
    std::vector<int> strip;                       ///< main_strip: index into layout.strips, -1 = bare fabric
    std::vector<StripPair> strips;                ///< those of both sides
    std::vector<Vec3> face_normal;                ///< unit; zero for a triangle without area
    std::vector<VertexCurvature> face_curvature;  ///< mean of the three vertices, 1/mm
    std::vector<double> stretch_max;              ///< principal stretches: released over printed length
    std::vector<double> stretch_min;
    std::vector<char> passes_through;    ///< 1: the sheet passes through itself there
    std::vector<double> energy_density;  ///< mJ per mm^2 of layout; empty when not given
    std::vector<double> scan_distance;   ///< mm, per vertex, to what was made; empty without a scan
};

/// Computes the fields of a result; `energy_density` (one value per triangle, or none) is passed through.
SurfaceFields surface_fields(const Result& result, std::span<const double> energy_density = {});

}  // namespace ruche

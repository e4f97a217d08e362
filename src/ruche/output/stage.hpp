#pragma once

#include <cstdint>
#include <vector>

#include "ruche/output/camera.hpp"
#include "ruche/output/ray_scene.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// What is photographed: the sheet with its thickness, put on a ground that has no edge. Coordinates: z up,
/// origin in the sheet's middle, sheet within radius 1.
struct Stage {
    RayScene scene;  ///< parts in the order of Look
    float ground = -1.0F;
    float per_mm = 1.0F;               ///< stage units per mm
    std::vector<char> printed_behind;  ///< per layout triangle: print on the back only shows through
    std::vector<char> passes_through;  ///< per layout triangle: the sheet passes through itself there
    std::vector<float> stretch;        ///< per layout triangle: square root of released over printed area
    std::vector<Vec3f> outline;        ///< points that a camera has to see
    std::vector<Vec3f> tint;           ///< per layout triangle, linear: instead of the materials' colours
};

enum class Look { fabric_front, fabric_back, plastic_front, plastic_back };

/// Builds the stage for the layout's triangles at `positions` (the shape's, or the flat layout's), mm.
Stage make_stage(const Result& result, const std::vector<Vec3>& positions, const Placement& placement);

/// What one sees where a ray meets the sheet.
struct Surfel {
    Look look = Look::fabric_front;
    Vec3f position = Vec3f::Zero();
    Vec3f normal = Vec3f::UnitZ();  ///< shading normal on the viewer's side, knit included
    Vec3f lifted = Vec3f::Zero();   ///< where rays towards the light start: on the smooth surface
    Vec3f albedo = Vec3f::Zero();   ///< linear
    bool is_fabric() const { return look == Look::fabric_front || look == Look::fabric_back; }
};

/// `pixel` is the width of a picture element at the hit, in stage units: finer knit than that is averaged.
Surfel look_at(const Stage& stage, const Ray& ray, const RayHit& hit, float pixel);

/// Colour of a part without the knit, for light that bounces off it.
Vec3f plain_albedo(Look look);

}  // namespace ruche

#pragma once

#include <vector>

#include "ruche/output/ray_scene.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// A rectangle of the picture, pixels.
struct Frame {
    float left = 0, top = 0, right = 0, bottom = 0;
};

/// A pinhole camera with shift, in the stage's coordinates.
struct Camera {
    Vec3f position = Vec3f::Zero();
    Vec3f right = Vec3f::UnitX();
    Vec3f up = Vec3f::UnitY();
    Vec3f forward = -Vec3f::UnitZ();
    float focal = 1.0F;            ///< pixels
    Vec2f centre = Vec2f::Zero();  ///< the pixel straight ahead

    Vec3f direction(const Vec2f& pixel) const;
    Vec2f project(const Vec3f& point) const;
};

/// How the sheet is put on the stage, where z is up, the origin in its middle and its radius 1.
struct Placement {
    Mat3 rotation = Mat3::Identity();
    Vec3 middle = Vec3::Zero();  ///< mm
    double scale = 1.0;          ///< 1/mm

    Vec3 apply(const Vec3& p) const { return scale * (rotation * (p - middle)); }
};

/// The direction from which to look, as a placement (the camera stands at -y) and an elevation.
struct View {
    Placement placement;
    float elevation_deg = 30.0F;
};

/// Places a flat layout as it is, y away from the viewer.
Placement place_flat(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// Looks for the most telling three-quarter view: up is against gravity, or the shape's shortest principal
/// axis either way; among directions all around, the one from which most of the sheet and of its print can be
/// seen, at an angle.
View choose_view(const Result& result);

/// A camera with that elevation that looks at the points from the -y side and lets them fill the frame.
Camera fit_camera(const std::vector<Vec3f>& points, float elevation_deg, float distance, const Frame& frame);

}  // namespace ruche

#pragma once

#include <vector>

#include "ruche/output/ray_scene.hpp"

namespace ruche {

/// What a picture element has gathered so far: sums over its samples.
struct FilmPixel {
    Vec3f albedo = Vec3f::Zero();  ///< linear colour of the surface
    Vec3f light = Vec3f::Zero();   ///< diffuse light that falls on it, 1 = the open ground's
    Vec3f gloss = Vec3f::Zero();   ///< light mirrored by it
    Vec3f normal = Vec3f::Zero();
    Vec3f position = Vec3f::Zero();  ///< stage units
    float part = 0.0F;               ///< 0 the ground, 1 fabric, 2 plastic
    float cover = 0.0F;              ///< 1 where the sheet is, 0 on the ground
    float samples = 0.0F;
};

/// A picture before it is developed. Only pixels with samples count.
struct Film {
    int width = 0;
    int height = 0;
    std::vector<FilmPixel> pixels;

    Film(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h) {}
    FilmPixel& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
    const FilmPixel& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

/// Smooths the light, and gloss a little, but no colours and outlines, with an edge-avoiding a-trous filter
/// (Dammertz et al. 2010): neighbours count as far as they lie in the same plane and belong to the same kind
/// of part. `plane_tolerance` is in stage units. Turns the sums into means.
void develop_light(Film& film, float plane_tolerance);

}  // namespace ruche

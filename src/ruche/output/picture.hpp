#pragma once

#include <string>

#include "ruche/output/image.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

struct PictureOptions {
    int width_px = 1600;
    int height_px = 1200;
    std::string title;  ///< empty = the scene's or drawing's name
};

/// The picture people share: the flat drawing and the released shape side by side, as photographs of fabric
/// and plastic, each with a scale bar; pre-stretch and thickness written below the title; a red mark when the
/// result is not converged or not stable. Needs no display. Same bits at any thread count. Triangles whose
/// positions are not finite are left out.
Image draw_picture(const Result& result, const PictureOptions& options = {});

/// Writes it as PNG, whole or not at all. Throws std::runtime_error with path and reason.
void write_picture(const Result& result, const std::string& path, const PictureOptions& options = {});

}  // namespace ruche

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ruche/geometry/vectors.hpp"
#include "ruche/output/image.hpp"

namespace ruche {

/// A part of a picture, pixels from its top left corner.
struct PixelBox {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
};

/// What stands out from a photo's background, the largest connected piece of it alone.
struct Foreground {
    PixelBox box;              ///< that was looked at
    std::vector<float> level;  ///< box.width * box.height: how unlike the background, 0 away from the piece
    double threshold = 0.0;    ///< the level at the piece's edge
    std::vector<Vec2> hull;    ///< corners of the piece's convex hull, counter-clockwise in x right, y down

    /// Between the middles of pixels, which have whole coordinates in the photo; 0 outside of the box.
    double at(const Vec2& pixel) const;
};

/// Separates an object from its background in three steps, none of which needs a setting:
///
/// 1. The background's colour is a plane over x and y per channel, fitted to a frame along the box's border
///    (least squares, twice without what lies off by more than three deviations): light may fall unevenly.
/// 2. A pixel's level is the distance of its colour from that, and the threshold the one that separates
///    levels best into two classes (Otsu 1979).
/// 3. Of the connected pieces above it the largest one is the object.
///
/// Throws InputError, naming `file`, when nothing stands out from the background, when the piece is too small
/// to be measured or touches the border of the box.
Foreground find_foreground(const Image& photo, const std::optional<PixelBox>& box, const std::string& file);

}  // namespace ruche

#pragma once

#include <string>
#include <vector>

namespace ruche {

/// A picture as screens show it: 8 bit sRGB, row by row from the top left.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<unsigned char> rgb;    ///< 3 * width * height
    std::vector<unsigned char> alpha;  ///< width * height, 255 = opaque; empty: all is
};

/// The same with red, green, blue and alpha side by side.
std::vector<unsigned char> rgba(const Image& image);

/// The contents of a PNG file. Throws std::runtime_error when libpng fails.
std::string to_png(const Image& image);

}  // namespace ruche

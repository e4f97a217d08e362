#pragma once

#include <string_view>
#include <vector>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// A line of text as pen strokes: capitals are 1 high, y grows upwards from the base line, x from 0.
struct WrittenText {
    std::vector<std::vector<Vec2>> strokes;
    double width = 0.0;
};

/// Writes UTF-8 text in the program's own single-stroke alphabet: ASCII, the accented letters of Latin-1 and
/// a few signs. Anything else, broken UTF-8 included, becomes a box.
WrittenText write_text(std::string_view utf8);

}  // namespace ruche

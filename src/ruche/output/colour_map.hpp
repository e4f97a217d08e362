#pragma once

#include "ruche/output/palette.hpp"

namespace ruche {

/// Colours for numbers, the same as on the page: t from 0 to 1, what is beyond takes the end's colour, what
/// is no number is grey. Both keep their order for colour-blind readers.
enum class ColourMap {
    sequential,  ///< Viridis (van der Walt and Smith 2015, CC0): dark blue, green, yellow
    diverging    ///< blue, pale, rust: straight lines in CIELAB between ends of equal lightness
};

Colour colour_at(ColourMap map, double t);

}  // namespace ruche

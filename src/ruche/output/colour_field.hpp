#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ruche/output/colour_map.hpp"
#include "ruche/output/surface_fields.hpp"
#include "ruche/scene/result.hpp"

namespace ruche {

/// A number per triangle of a result and how to colour it.
struct ColourField {
    std::string label;
    std::string unit;
    ColourMap map = ColourMap::sequential;
    double from = 0.0;  ///< value of the map's first colour
    double to = 1.0;
    std::vector<double> values;

    Colour colour(double value) const { return colour_at(map, (value - from) / (to - from)); }
};

/// "thickness_mm", "stretch_max", "mean_curvature_per_mm", ...
std::vector<std::string> colour_field_names();

/// The field with that name. The colours' range leaves out a hundredth of the values at either end, so that a
/// single spot does not decide; that of curvatures is symmetric about 0. Throws InputError for another name.
ColourField colour_field(std::string_view name, const Result& result, const SurfaceFields& fields);

}  // namespace ruche

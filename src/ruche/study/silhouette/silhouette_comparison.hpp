#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ruche/output/image.hpp"
#include "ruche/output/surface_fields.hpp"
#include "ruche/scene/result.hpp"
#include "ruche/study/silhouette/outline_circle.hpp"

namespace ruche {

/// A photo of the released sheet along the axis that it rolls around, with something of known length in it.
struct SilhouetteOptions {
    double known_length_mm = 0.0;            ///< between the two places; 0 = not said
    std::vector<double> known_length_at_px;  ///< x, y of one end and of the other
    std::optional<PixelBox> box;             ///< where the sheet is in the photo; else anywhere
    double seen_along_deg = 90.0;  ///< direction of the layout, from its x axis, that the photo looks along
};

/// How a result and the silhouette of what was made differ: circles, as in the paper's Fig. 9.
struct SilhouetteComparison {
    OutlineCircle outline;
    double mm_per_px = 0.0;
    double curvature = 0.0;    ///< of the outline in the photo, 1/mm
    double uncertainty = 0.0;  ///< one standard error of it: the fit's, the edge's and the scale's
    double scale_error = 0.0;  ///< relative, of the known length's ends
    /// The same of the result, 1/mm: of the sheet's outer skin, which is the outline, and of its reference
    /// surface, which all other numbers are about.
    double result_outline_curvature = 0.0;
    double result_curvature = 0.0;
    std::vector<std::string> warnings;

    double difference() const { return curvature / result_outline_curvature - 1.0; }  ///< relative
};

/// Throws InputError without a known length, for a photo that shows no single object off its border, and for
/// a result whose silhouette has no circle. `file` is the photo's name.
SilhouetteComparison compare_with_photo(const Result& result, const SurfaceFields& fields, const Image& photo,
                                        const SilhouetteOptions& options, const std::string& file);

/// As compare.json has it.
std::string to_json(const SilhouetteComparison& comparison, const std::string& photo);

/// The photo, small, with what was found on it: the outline's points, the circle and the result's circle.
Image annotated(const Image& photo, const SilhouetteComparison& comparison);

}  // namespace ruche

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ruche/pattern/svg_outline.hpp"

namespace ruche::svg {

/// What a `d` or `points` attribute says, up to its first error, as SVG prescribes.
struct PathReading {
    Outline outline;
    std::optional<std::string> error;  ///< what is wrong, with the place in the text
};

/// Path data with all commands of SVG 1.1 and 2 (MZLHVCSQTA, relative too, implicit repeats, compressed
/// flags).
PathReading parse_path(std::string_view data);

/// The `points` of a polyline or polygon.
PathReading parse_points(std::string_view data, bool closed);

}  // namespace ruche::svg

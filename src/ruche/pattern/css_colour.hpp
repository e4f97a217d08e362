#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ruche {

struct CssColour {
    std::uint8_t red = 0, green = 0, blue = 0;
    double alpha = 1.0;

    bool operator==(const CssColour&) const = default;
};

/// CSS Color 4 as drawing programs write it: the named colours, "transparent", #rgb, #rgba, #rrggbb,
/// #rrggbbaa, rgb(), rgba(), hsl(), hsla(); anything behind it (an icc-color()) is ignored. Empty when the
/// text is no colour.
std::optional<CssColour> parse_css_colour(std::string_view text);

/// "#rrggbb", lower case; the alpha value is left out.
std::string hex_colour(const CssColour& colour);

}  // namespace ruche

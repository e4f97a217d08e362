#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/geometry/polygon.hpp"
#include "ruche/pattern/css_colour.hpp"
#include "ruche/pattern/css_sheet.hpp"

namespace ruche::svg {

struct Paint {
    enum class Kind { none, colour, current_colour, server } kind = Kind::none;
    CssColour colour;    ///< of `colour`; of a server, what to use when it does not exist
    std::string server;  ///< id of a gradient or pattern
    bool fallback = false;
};

/// What an element inherited and what it says itself. Lengths are in its user units.
struct Style {
    Paint fill{Paint::Kind::colour, {}, {}, false};
    bool fill_given = false;  ///< by the element or one around it, not SVG's default black
    FillRule fill_rule = FillRule::nonzero;
    double fill_opacity = 1.0;
    Paint stroke;
    double stroke_opacity = 1.0;
    double stroke_width = 1.0;
    LineCap cap = LineCap::butt;
    LineJoin join = LineJoin::miter;
    double miter_limit = 4.0;
    std::vector<double> dashes;  ///< even count, or empty: solid
    double dash_offset = 0.0;
    CssColour colour;
    bool visible = true;
    std::string markers;  ///< the value that asks for some, or empty

    // Not inherited:
    bool displayed = true;  ///< display is not none, opacity is not 0
    bool non_scaling_stroke = false;
};

/// Told of a value that cannot be read, in words.
using Complain = std::function<void(const std::string&)>;

/// `diagonal`: what 100 % of a stroke width is, in user units.
Style inherit(const Style& parent, const Declared& own, double diagonal, const Complain& complain);

/// The colour that is drawn with, if any; `server_colour` is asked for the colour of a gradient that is one
/// plain colour in truth (Inkscape's swatches).
std::optional<CssColour> painted(const Paint& paint, double opacity, const Style& style,
                                 const std::function<std::optional<CssColour>(const Paint&)>& server_colour);

}  // namespace ruche::svg

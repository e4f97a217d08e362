#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ruche/geometry/polygon.hpp"
#include "ruche/pattern/drawing.hpp"
#include "ruche/pattern/pattern.hpp"

namespace ruche {

/// A chain of points that a pen follows, or the border of a filled area.
struct DrawnLine {
    Polyline points;
    bool closed = false;
};

/// One strip as a person would draw it: lines followed by a pen, or a filled area.
struct DrawnStrip {
    std::string id;
    std::vector<DrawnLine> lines;
    double width = 1.0;  ///< of the pen, mm; 0 = the closed lines are filled instead
    LineCap cap = LineCap::butt;
    Side side = Side::front;
};

/// For the options of generators.
inline constexpr std::string_view cap_names[] = {"butt", "round"};  ///< of LineCap
inline constexpr int most_strips = 20000;
inline constexpr double smallest_gap = 0.1;  ///< between pieces of plastic, mm

/// What a generator draws, mm, y upwards, seen from the printed side.
struct GeneratedPattern {
    std::string name;                ///< of the generator
    std::string description;         ///< "width_mm = 1, length_mm = 30, ...": every option, as resolved
    std::vector<Polyline> fabric;    ///< outlines of the fabric (even-odd); empty: a margin around the print
    std::vector<DrawnStrip> strips;  ///< in drawing order
    std::vector<std::string> warnings;
};

/// Layers that generated strips and outlines lie on, in drawings and in SVG.
inline constexpr const char* front_layer = "front";
inline constexpr const char* back_layer = "back";
inline constexpr const char* fabric_layer = "fabric";
inline constexpr const char* fabric_id = "fabric-outline";

/// Colours by which they can be told apart, and matched by rules.
inline constexpr const char* front_colour = "#d9480f";
inline constexpr const char* back_colour = "#1864ab";
inline constexpr const char* fabric_colour = "#e9ecef";

/// The same as a drawing, as if it had been read from the file that `to_svg` writes: layers "front", "back"
/// and "fabric". Unlike in the file, the origin stays where the generator had it.
Drawing to_drawing(const GeneratedPattern& generated);

/// The printed pattern, by the same way as for a drawing (`make_pattern`). Strips on the back layer are
/// printed on the other side than `rules.side`. Throws InputError.
Pattern to_pattern(const GeneratedPattern& generated, PrintRules rules);

}  // namespace ruche

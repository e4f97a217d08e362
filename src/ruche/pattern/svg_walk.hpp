#pragma once

#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "ruche/pattern/css_colour.hpp"
#include "ruche/pattern/svg_file.hpp"
#include "ruche/pattern/svg_outline.hpp"
#include "ruche/pattern/svg_style.hpp"
#include "ruche/pattern/svg_transform.hpp"

namespace ruche::svg {

/// Where the outermost svg element's user units lie.
struct PageMap {
    Affine to_mm;            ///< from user units; y upwards
    Vec2 user_size;          ///< what 100 % is, in user units
    double mm_per_px = 1.0;  ///< for strokes that do not scale
};

/// A shape that is drawn, before curves become chords.
struct DrawnItem {
    pugi::xml_node node;
    std::shared_ptr<const Outline> outline;  ///< user units
    Affine to_mm;
    Style style;
    std::optional<CssColour> fill, stroke;
    std::string id;  ///< may repeat, may be empty
    std::string label, layer;
    std::vector<std::string> groups;  ///< labels and ids of what is around it, innermost first
};

/// Walks through everything that is drawn: groups, layers, use, symbols, nested svg elements. What cannot be
/// printed becomes a warning. Throws InputError for a drawing that never ends (use inside use inside use).
std::vector<DrawnItem> drawn_items(const SvgFile& file, const PageMap& page, Warnings& warnings);

}  // namespace ruche::svg

#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string_view>

#include "ruche/pattern/css_colour.hpp"
#include "ruche/pattern/svg_file.hpp"

namespace ruche::svg {

/// What is to be done with an element.
enum class Kind { group, svg, switch_, use, shape, silent, not_printed, unknown };

/// By local name; names with a foreign prefix are silent: they belong to drawing programs.
Kind kind_of(std::string_view name);

/// The colour of a gradient all of whose stops have the same one, such as Inkscape's swatches; empty for any
/// other gradient and for what is none.
std::optional<CssColour> plain_gradient(const SvgFile& file, const pugi::xml_node& server);

/// The user's name of an element in a drawing program: Inkscape's label, Illustrator's data-name.
std::string label_of(const pugi::xml_node& node);

}  // namespace ruche::svg

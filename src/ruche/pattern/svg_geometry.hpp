#pragma once

#include <functional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "ruche/pattern/svg_outline.hpp"

namespace ruche::svg {

/// Told what is wrong with an element, in words.
using Remark = std::function<void(const std::string&)>;

/// A length in an element's attribute, in user units; `whole` is 100 %. Remarks on what cannot be read.
double length_attribute(const pugi::xml_node& node, const char* name, double whole, double otherwise,
                        const Remark& remark);

/// path, rect, circle, ellipse, line, polyline, polygon.
bool is_shape(std::string_view name);

/// The geometry of a shape element in user units, as far as it can be read; `viewport` is what percentages
/// refer to. Empty for one without size.
Outline shape_outline(const pugi::xml_node& node, const Vec2& viewport, const Remark& remark);

/// sqrt((width^2 + height^2) / 2): what 100 % of a radius or a stroke width is.
double viewport_diagonal(const Vec2& viewport);

}  // namespace ruche::svg

#include "ruche/pattern/svg_elements.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "ruche/pattern/svg_geometry.hpp"

namespace ruche::svg {

Kind kind_of(std::string_view name) {
    static constexpr std::string_view silent[] = {
        "defs",          "symbol",           "title",          "desc",         "metadata",  "style",
        "script",        "linearGradient",   "radialGradient", "meshgradient", "clipPath",  "mask",
        "pattern",       "marker",           "filter",         "view",         "animate",   "set",
        "animateMotion", "animateTransform", "cursor",         "font",         "font-face", "color-profile",
        "solidColor",    "discard",          "animateColor",   "hatch",        "glyph",     "altGlyphDef",
        "stop",          "missing-glyph",    "hkern",          "vkern",        "namedview"};
    static constexpr std::string_view not_printed[] = {"text",  "flowRoot", "image",  "foreignObject",
                                                       "video", "audio",    "canvas", "iframe"};
    const auto is_in = [&](const auto& names) {
        return std::find(std::begin(names), std::end(names), name) != std::end(names);
    };
    if (is_shape(name)) return Kind::shape;
    if (name == "g" || name == "a") return Kind::group;
    if (name == "svg") return Kind::svg;
    if (name == "switch") return Kind::switch_;
    if (name == "use") return Kind::use;
    if (is_in(not_printed)) return Kind::not_printed;
    return is_in(silent) || name.find(':') != std::string_view::npos ? Kind::silent : Kind::unknown;
}

std::optional<CssColour> plain_gradient(const SvgFile& file, const pugi::xml_node& server) {
    const std::string_view name = local_name(server);
    if (name != "linearGradient" && name != "radialGradient") return std::nullopt;
    std::optional<CssColour> common;
    // A gradient without stops takes those of another one.
    pugi::xml_node gradient = server;
    for (int hop = 0; gradient && !common && hop < 10; ++hop, gradient = file.referenced(gradient)) {
        for (const pugi::xml_node& stop : gradient.children()) {
            if (local_name(stop) != "stop") continue;
            const Declared declared = file.declared(stop);
            const auto value = declared.find(Property::stop_color);
            const std::optional<CssColour> colour =
                value == declared.end() ? CssColour{} : parse_css_colour(value->second);
            if (!colour || (common && *common != *colour)) return std::nullopt;
            common = colour;
        }
    }
    return common;
}

/// Illustrator writes what may not stand in an id as "_x5F_", the character's number; the rest stays.
static std::string unescaped(std::string_view id) {
    std::string name;
    while (!id.empty()) {
        unsigned code = 0;
        const char* end = id.data() + id.size();
        if (id.starts_with("_x")) {
            const auto [stop, error] = std::from_chars(id.data() + 2, end, code, 16);
            if (error == std::errc() && stop != end && *stop == '_' && code >= 0x20U && code < 0x7FU) {
                name += static_cast<char>(code);
                id.remove_prefix(static_cast<std::size_t>(stop - id.data()) + 1);
                continue;
            }
        }
        name += id.front();
        id.remove_prefix(1);
    }
    return name;
}

std::string label_of(const pugi::xml_node& node) {
    for (const char* attribute : {"inkscape:label", "data-name"}) {
        if (const std::string label = node.attribute(attribute).value(); !label.empty()) return label;
    }
    const std::string id = node.attribute("id").value();
    std::string name = unescaped(id);
    return name == id ? std::string() : name;
}

}  // namespace ruche::svg

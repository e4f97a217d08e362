#pragma once

#include <cstdint>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace ruche::svg {

/// The properties that matter for what is printed.
enum class Property {
    fill,
    fill_opacity,
    fill_rule,
    stroke,
    stroke_opacity,
    stroke_width,
    stroke_linecap,
    stroke_linejoin,
    stroke_miterlimit,
    stroke_dasharray,
    stroke_dashoffset,
    color,
    opacity,
    display,
    visibility,
    vector_effect,
    transform,
    transform_origin,
    clip_path,
    mask,
    filter,
    marker,
    marker_start,
    marker_mid,
    marker_end,
    stop_color,
};

struct Declaration {
    Property property;
    std::string value;
    bool important = false;
};

/// "fill: red; stroke-width: 2 !important", as in a style attribute or between the braces of a sheet. What is
/// no known property is left out.
std::vector<Declaration> parse_declarations(std::string_view text);

/// The values that hold for one element before inheritance, each by the strongest declaration.
using Declared = std::map<Property, std::string>;

/// All <style> elements of a drawing: rules with type, class, id and attribute selectors, compound ones,
/// lists, descendants and children.
class StyleSheet {
  public:
    /// Adds rules; returns what was not understood, a sentence each.
    std::vector<std::string> add(std::string_view css);

    /// Presentation attributes, then the sheet's rules by specificity, then the style attribute (given
    /// separately since it may need entities replaced), then the same again for what is !important.
    Declared declared(const pugi::xml_node& element, std::string_view style_attribute) const;

    /// So much comparing of selectors was done (a hostile file could ask for any amount).
    std::size_t effort() const { return effort_; }

  private:
    struct Compound {
        std::string type;  ///< empty: any
        std::vector<std::string> ids, classes;
        std::vector<std::pair<std::string, std::string>> attributes;  ///< equal to
        std::vector<std::string> present;
        bool child = false;  ///< of the compound before it, not only a descendant
    };
    struct Rule {
        std::vector<Compound> compounds;
        std::uint32_t specificity = 0;
        std::size_t declarations = 0;  ///< index into blocks_
    };
    class SelectorReader;

    static bool matches(const Compound& compound, const pugi::xml_node& element);
    bool matches(const Rule& rule, const pugi::xml_node& element) const;
    std::vector<std::size_t> candidates(const pugi::xml_node& element) const;
    void add_block(std::string_view selectors, std::string_view body, std::vector<std::string>& problems);

    std::vector<Rule> rules_;
    std::vector<std::vector<Declaration>> blocks_;
    /// Rules by a key of their last compound: "#id", ".class", "type" or "*".
    std::unordered_map<std::string, std::vector<std::size_t>> by_key_;
    mutable std::size_t effort_ = 0;
};

/// An element's name without the prefix that stands for SVG's namespace.
std::string_view local_name(const pugi::xml_node& element);

/// The parts of a class attribute.
std::vector<std::string> class_names(const pugi::xml_node& element);

}  // namespace ruche::svg

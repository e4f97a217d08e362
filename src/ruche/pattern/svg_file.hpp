#pragma once

#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "ruche/core/error.hpp"
#include "ruche/pattern/css_sheet.hpp"

namespace ruche::svg {

/// Nesting of elements, `use` included.
inline constexpr int deepest_nesting = 200;

/// Remarks for the user: each once, and not without end.
class Warnings {
  public:
    void add(const Place& place, const std::string& text);
    std::vector<std::string> take();

  private:
    std::vector<std::string> texts_;
    std::unordered_set<std::string> seen_;
    std::size_t left_out_ = 0;
};

/// An SVG file as a tree, with what one asks of it: lines, ids, style sheet, entities.
class SvgFile {
  public:
    /// Throws InputError when the file cannot be read or is not SVG.
    SvgFile(const std::string& path, Warnings& warnings);

    const std::string& path() const { return path_; }
    pugi::xml_node root() const { return root_; }
    int line(const pugi::xml_node& node) const;
    /// "kite.svg:12: path 'arm'".
    Place place(const pugi::xml_node& node) const;
    /// An empty node when no element has the id.
    pugi::xml_node by_id(const std::string& id) const;
    /// The element that href or xlink:href points to; empty when it points nowhere in this file.
    pugi::xml_node referenced(const pugi::xml_node& node) const;
    /// What presentation attributes, sheets and the style attribute say about the element.
    Declared declared(const pugi::xml_node& node) const;

  private:
    void parse(const std::string& text);
    void read_entities(std::string_view text);
    std::string with_entities(std::string_view text) const;
    void index(Warnings& warnings);
    int line_at(std::size_t offset) const;

    std::string path_;
    pugi::xml_document document_;
    pugi::xml_node root_;
    std::vector<std::size_t> line_ends_;
    std::unordered_map<std::string, pugi::xml_node> ids_;
    std::unordered_map<std::string, std::string> entities_;
    StyleSheet sheet_;
};

/// The reference in href or xlink:href, white space aside.
std::string_view href(const pugi::xml_node& node);

}  // namespace ruche::svg

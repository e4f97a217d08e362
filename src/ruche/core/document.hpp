#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/error.hpp"

namespace ruche {

/// A value of a TOML file and where it stands. A plain tree, so that only one source file needs the TOML
/// library.
struct Node {
    enum class Kind { boolean, integer, number, text, date, array, table };

    Kind kind = Kind::table;
    bool boolean = false;
    std::int64_t integer = 0;
    double number = 0.0;
    std::string text;
    std::string key;          ///< of an entry of a table
    std::vector<Node> items;  ///< of an array, or a table's entries in the order of the file
    std::shared_ptr<const std::string> source;  ///< file as the user gave it, or "--set mesh.size_mm=2"
    int line = 0;                               ///< 1-based; 0 when it did not come from a file

    Node* find(std::string_view name);  ///< entry of a table; null when there is none
    const Node* find(std::string_view name) const;
};

/// "the text \"abc\"", "the number 1.7", "an array of 3": what was found, for messages.
std::string describe(const Node& node);

/// Where the node stands; `path` is its full name ("fabric.prestretch").
Place place_of(const Node& node, const std::string& path);

/// Parses TOML text; `file` is named in messages. Throws InputError with the line of the first mistake, also
/// for text that is not UTF-8, is nested absurdly deep, or is longer than 4 MB.
Node parse_toml(const std::string& text, const std::string& file);

/// Reads and parses a file. Throws InputError also when it is missing, unreadable or not a text file.
Node read_toml(const std::string& path);

/// The whole file as bytes. Throws InputError when it is missing, a folder, unreadable, or longer than
/// `longest` bytes; `what` it should have been ("scene file") is named in the message.
std::string read_file(const std::string& path, const std::string& what, std::size_t longest);

/// Text as a TOML basic string, quotes included.
std::string toml_quoted(std::string_view text);

}  // namespace ruche

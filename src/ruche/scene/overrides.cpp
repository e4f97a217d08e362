#include "ruche/scene/overrides.hpp"

#include <fmt/format.h>

#include <charconv>

namespace ruche {

Override parse_override(const std::string& text, const std::string& option) {
    const std::size_t equals = text.find('=');
    const std::string written = option + " " + text;
    if (equals == std::string::npos || equals == 0)
        throw InputError({.file = written}, "expected path=value",
                         "For example: " + option + " fabric.prestretch=1.6");
    return {.path = text.substr(0, equals), .value = text.substr(equals + 1), .option = written};
}

static std::vector<std::string> split(const std::string& path) {
    std::vector<std::string> parts(1);
    for (const char c : path) {
        if (c == '.')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

static void set_source(Node& node, const std::shared_ptr<const std::string>& source) {
    node.source = source;
    node.line = 0;
    for (Node& item : node.items) set_source(item, source);
}

/// A TOML value; what is none is a text without quotes, such as back or drawings/kite.svg.
static Node parse_value(const Override& change) {
    Node value;
    value.kind = Node::Kind::text;
    value.text = change.value;
    try {
        const Node root = parse_toml("value = " + change.value, change.option);
        if (root.items.size() == 1 && root.items.front().key == "value") value = root.items.front();
    } catch (const InputError&) {
        if (change.value.find_first_of("\"'[{") == 0) throw;
    }
    set_source(value, std::make_shared<const std::string>(change.option));
    return value;
}

/// The entry of a table (made when missing) or of a list (which must have it).
static Node& step_into(Node& node, const std::string& part, const Override& change) {
    const Place place{.file = change.option, .key = change.path};
    if (part.empty()) throw InputError(place, "a part of the path is empty");
    if (node.kind == Node::Kind::table) {
        if (Node* entry = node.find(part)) return *entry;
        Node table;
        table.key = part;
        set_source(table, std::make_shared<const std::string>(change.option));
        node.items.push_back(table);
        return node.items.back();
    }
    if (node.kind != Node::Kind::array)
        throw InputError(place, fmt::format("{} cannot be set inside {}", part, describe(node)));
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    if (error != std::errc() || end != part.data() + part.size() || index < 1 || index > node.items.size())
        throw InputError(place, fmt::format("\"{}\" is no entry of {}", part, describe(node)),
                         "Lists count from 1.");
    return node.items[index - 1];
}

void apply_overrides(Node& root, const std::vector<Override>& overrides) {
    for (const Override& change : overrides) {
        constexpr std::size_t deepest = 20;
        const std::vector<std::string> parts = split(change.path);
        if (parts.size() > deepest) throw InputError({.file = change.option}, "the path has too many parts");
        Node* node = &root;
        for (const std::string& part : parts) node = &step_into(*node, part, change);
        Node value = parse_value(change);
        value.key = node->key;
        *node = value;
    }
}

}  // namespace ruche

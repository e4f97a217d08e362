#include "ruche/core/document.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace ruche {

Node* Node::find(std::string_view name) {
    for (Node& item : items)
        if (kind == Kind::table && item.key == name) return &item;
    return nullptr;
}

const Node* Node::find(std::string_view name) const { return const_cast<Node*>(this)->find(name); }

static std::string shortened(const std::string& text) {
    constexpr std::size_t longest = 60;
    return text.size() <= longest ? text : text.substr(0, longest).append("...");
}

std::string describe(const Node& node) {
    switch (node.kind) {
        case Node::Kind::boolean:
            return node.boolean ? "true" : "false";
        case Node::Kind::integer:
            return fmt::format("the integer {}", node.integer);
        case Node::Kind::number:
            return fmt::format("the number {}", node.number);
        case Node::Kind::text:
            return fmt::format("the text \"{}\"", shortened(node.text));
        case Node::Kind::date:
            return "a date";
        case Node::Kind::array:
            return fmt::format("an array of {}", node.items.size());
        case Node::Kind::table:
            return "a table";
    }
    return {};
}

Place place_of(const Node& node, const std::string& path) {
    return {.file = node.source ? *node.source : std::string(), .line = node.line, .key = path};
}

static Node converted(const toml::node& from, const std::shared_ptr<const std::string>& source) {
    Node node;
    node.source = source;
    node.line = static_cast<int>(from.source().begin.line);
    if (const auto* boolean = from.as_boolean()) {
        node.kind = Node::Kind::boolean;
        node.boolean = boolean->get();
    } else if (const auto* integer = from.as_integer()) {
        node.kind = Node::Kind::integer;
        node.integer = integer->get();
    } else if (const auto* number = from.as_floating_point()) {
        node.kind = Node::Kind::number;
        node.number = number->get();
    } else if (const auto* text = from.as_string()) {
        node.kind = Node::Kind::text;
        node.text = text->get();
    } else if (const auto* array = from.as_array()) {
        node.kind = Node::Kind::array;
        node.items.reserve(array->size());
        for (const toml::node& item : *array) node.items.push_back(converted(item, source));
    } else if (const auto* table = from.as_table()) {
        for (const auto& [key, item] : *table) {
            node.items.push_back(converted(item, source));
            node.items.back().key = std::string(key.str());
            if (node.items.back().line == 0)
                node.items.back().line = static_cast<int>(key.source().begin.line);
        }
    } else {
        node.kind = Node::Kind::date;
    }
    return node;
}

static int line_at(const std::string& text, std::size_t position) {
    int line = 1;
    for (std::size_t i = 0; i < position; ++i) line += text[i] == '\n' ? 1 : 0;
    return line;
}

/// Length of the UTF-8 sequence at `i`, 0 when it is none (RFC 3629: no overlong forms, no surrogates).
static std::size_t utf8_length(const std::string& text, std::size_t i) {
    const auto byte = [&](std::size_t k) -> unsigned {
        return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0U;
    };
    const auto follows = [&](std::size_t k) { return (byte(k) & 0xC0U) == 0x80U; };
    const unsigned first = byte(0);
    if (first < 0x80U) return 1;
    if (first >= 0xC2U && first < 0xE0U) return follows(1) ? 2 : 0;
    if (first >= 0xE0U && first < 0xF0U) {
        const bool overlong = first == 0xE0U && byte(1) < 0xA0U;
        const bool surrogate = first == 0xEDU && byte(1) >= 0xA0U;
        return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (first >= 0xF0U && first < 0xF5U) {
        const bool overlong = first == 0xF0U && byte(1) < 0x90U;
        const bool beyond = first == 0xF4U && byte(1) >= 0x90U;
        return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
    }
    return 0;
}

static void check_encoding(const std::string& text, const std::string& file) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw InputError({.file = file}, "is encoded as UTF-16", "Save it as UTF-8.");
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = utf8_length(text, i);
        if (length == 0)
            throw InputError(
                {.file = file, .line = line_at(text, i)},
                fmt::format("byte 0x{:02X} is not UTF-8 text", static_cast<unsigned char>(text[i])),
                "Save the file as UTF-8; a binary file cannot be read here.");
        if (text[i] == '\0')
            throw InputError({.file = file, .line = line_at(text, i)},
                             "is a binary file, expected TOML text");
        i += length;
    }
}

/// The TOML library limits the depth of arrays, but a dotted key of 100,000 parts would overflow its stack.
static void check_depth(const std::string& text, const std::string& file) {
    constexpr int deepest = 100;
    int dots = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '.') ++dots;
        if (text[i] == ',' || text[i] == '=' || text[i] == '\n' || text[i] == '{' || text[i] == '[') dots = 0;
        if (dots > deepest)
            throw InputError({.file = file, .line = line_at(text, i)},
                             fmt::format("a key of more than {} parts", deepest));
    }
}

Node parse_toml(const std::string& text, const std::string& file) {
    check_encoding(text, file);
    check_depth(text, file);
    try {
        const toml::table table = toml::parse(text, file);
        Node root = converted(table, std::make_shared<const std::string>(file));
        root.line = 0;
        return root;
    } catch (const toml::parse_error& error) {
        throw InputError({.file = file, .line = static_cast<int>(error.source().begin.line)},
                         "not valid TOML: " + std::string(error.description()));
    }
}

Node read_toml(const std::string& path) {
    constexpr std::size_t four_megabytes = 4U << 20U;
    return parse_toml(read_file(path, "TOML file", four_megabytes), path);
}

std::string read_file(const std::string& path, const std::string& what, std::size_t longest) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError({.file = path}, "is a folder, expected a " + what);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) {
        const bool missing = errno == ENOENT || errno == ENOTDIR;
        throw InputError({.file = path}, missing
                                             ? "there is no such file"
                                             : "cannot be read: " + std::generic_category().message(errno));
    }
    std::string text;
    std::array<char, 65536> buffer{};
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
        text.append(buffer.data(), count);
        if (text.size() > longest)
            throw InputError({.file = path},
                             fmt::format("is longer than {} MB, too long for a {}", longest >> 20U, what));
    }
    if (std::ferror(file.get()) != 0) throw InputError({.file = path}, "cannot be read to its end");
    return text;
}

std::string toml_quoted(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (code < 0x20U || code == 0x7FU)
            quoted += fmt::format("\\u{:04X}", code);
        else
            quoted += c;
    }
    return quoted + '"';
}

}  // namespace ruche

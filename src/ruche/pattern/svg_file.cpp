#include "ruche/pattern/svg_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ruche/pattern/svg_encoding.hpp"
#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

constexpr std::size_t most_warnings = 100;
constexpr std::uintmax_t largest_file = std::uintmax_t{256} << 20U;
constexpr int most_attributes = 1000;
constexpr std::size_t most_effort = 8'000'000;
constexpr std::size_t longest_style = 65536;  // with entities replaced

std::string read_bytes(const std::string& path) {
    std::error_code trouble;
    const std::filesystem::file_status status = std::filesystem::status(path, trouble);
    if (!std::filesystem::exists(status)) {
        throw InputError({path, 0, {}}, "there is no such file", "Check the path of the drawing.");
    }
    if (!std::filesystem::is_regular_file(status)) {
        throw InputError({path, 0, {}}, "is not a file", "Give the path of an SVG file.");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, trouble);
    if (!trouble && size > largest_file) {
        throw InputError({path, 0, {}}, fmt::format("is too large ({} MB, at most 256 MB)", size >> 20U),
                         "Remove embedded images from the drawing.");
    }
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        throw InputError({path, 0, {}}, fmt::format("cannot be opened: {}", std::strerror(errno)),
                         "Check the file's permissions.");
    }
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The element after `node` in document order within `root`, and the change in depth.
pugi::xml_node next_in_order(const pugi::xml_node& node, const pugi::xml_node& root, int& depth) {
    if (const pugi::xml_node child = node.first_child()) {
        ++depth;
        return child;
    }
    pugi::xml_node at = node;
    while (at != root) {
        if (const pugi::xml_node sibling = at.next_sibling()) return sibling;
        at = at.parent();
        --depth;
    }
    return {};
}

std::string text_of(const pugi::xml_node& style) {
    std::string text;
    for (const pugi::xml_node& child : style.children()) text += child.value();
    return text;
}

}  // namespace

std::string_view href(const pugi::xml_node& node) {
    const pugi::xml_attribute plain = node.attribute("href");
    return trimmed(plain ? plain.value() : node.attribute("xlink:href").value());
}

void Warnings::add(const Place& place, const std::string& text) {
    const std::string where = to_string(place);
    std::string whole = where.empty() ? text : where + ": " + text;
    if (!seen_.insert(whole).second) return;
    if (texts_.size() < most_warnings) {
        texts_.push_back(std::move(whole));
    } else {
        ++left_out_;
    }
}

std::vector<std::string> Warnings::take() {
    if (left_out_ > 0) texts_.push_back(fmt::format("... and {} more of such remarks", left_out_));
    return std::move(texts_);
}

SvgFile::SvgFile(const std::string& path, Warnings& warnings) : path_(path) {
    const std::string text = to_utf8(read_bytes(path), path);
    if (trimmed(text).empty()) {
        throw InputError({path, 0, {}}, "is empty", "Save the drawing again as SVG.");
    }
    parse(text);
    read_entities(text);
    index(warnings);
}

void SvgFile::parse(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool carriage_return = text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n');
        if (text[i] == '\n' || carriage_return) line_ends_.push_back(i);
    }
    const pugi::xml_parse_result result =
        document_.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result) {
        std::string problem = result.description();
        if (!problem.empty() && problem.front() >= 'A' && problem.front() <= 'Z') {
            problem.front() = static_cast<char>(problem.front() - 'A' + 'a');
        }
        const bool cut_off = static_cast<std::size_t>(result.offset) + 1 >= text.size();
        throw InputError({path_, line_at(static_cast<std::size_t>(result.offset)), {}},
                         "is not well-formed XML: " + problem,
                         cut_off ? "The file seems to be cut off or is no SVG; export the drawing again."
                                 : "Mend this place or export the drawing again as SVG.");
    }
    root_ = document_.document_element();
    if (local_name(root_) != "svg") {
        throw InputError({path_, line(root_), {}},
                         fmt::format("the outermost element is <{}>, not <svg>", root_.name()),
                         "Export the drawing as SVG.");
    }
}

void SvgFile::read_entities(std::string_view text) {
    // Illustrator may put whole style attributes into entities: <!ENTITY st0 "fill:none;stroke:#000000;">.
    // They are replaced there, once, and nowhere else: what an entity stands for is never looked into.
    const std::size_t doctype = text.find("<!DOCTYPE");
    if (doctype == std::string_view::npos) return;
    std::size_t at = text.find('[', doctype);
    const std::size_t end = std::min(text.find("]>", doctype), text.size());
    while (at < end && (at = text.find("<!ENTITY", at)) < end && entities_.size() < 10000) {
        Scanner scanner(text.substr(at + 8, std::min<std::size_t>(end - at - 8, 8192)));
        at += 8;
        scanner.skip_space();
        const std::string_view rest = scanner.rest();
        const std::size_t name_end = rest.find_first_of(" \t\r\n");
        if (name_end == std::string_view::npos) continue;
        const std::size_t open = rest.find_first_not_of(" \t\r\n", name_end);
        if (open == std::string_view::npos || (rest[open] != '"' && rest[open] != '\'')) continue;
        const std::size_t close = rest.find(rest[open], open + 1);
        if (close == std::string_view::npos) continue;
        entities_.emplace(rest.substr(0, name_end), rest.substr(open + 1, close - open - 1));
    }
}

void SvgFile::index(Warnings& warnings) {
    int depth = 1;
    for (pugi::xml_node node = root_; node; node = next_in_order(node, root_, depth)) {
        if (node.type() != pugi::node_element) continue;
        if (depth > deepest_nesting) {
            throw InputError(place(node),
                             fmt::format("elements are nested more than {} deep", deepest_nesting),
                             "Ungroup the drawing, or export it again.");
        }
        int attributes = 0;
        for (pugi::xml_attribute a = node.first_attribute(); a; a = a.next_attribute()) ++attributes;
        if (attributes > most_attributes) {
            throw InputError(place(node), fmt::format("has {} attributes, which no drawing has", attributes),
                             "Export the drawing again.");
        }
        // Of several elements with one id, the first has it.
        if (const pugi::xml_attribute id = node.attribute("id")) ids_.emplace(id.value(), node);
        const std::string_view type = trimmed(node.attribute("type").value());
        if (local_name(node) == "style" && (type.empty() || type == "text/css")) {
            for (const std::string& problem : sheet_.add(text_of(node))) {
                warnings.add(place(node), "style sheet: " + problem + " is not understood: ignored");
            }
        }
    }
}

int SvgFile::line_at(std::size_t offset) const {
    const auto end = std::lower_bound(line_ends_.begin(), line_ends_.end(), offset);
    return 1 + static_cast<int>(end - line_ends_.begin());
}

int SvgFile::line(const pugi::xml_node& node) const {
    const std::ptrdiff_t offset = node.offset_debug();
    return offset < 0 ? 0 : line_at(static_cast<std::size_t>(offset));
}

Place SvgFile::place(const pugi::xml_node& node) const {
    std::string key(local_name(node).substr(0, 60));
    std::string_view name = node.attribute("id").value();
    if (name.empty()) name = node.attribute("inkscape:label").value();
    if (!name.empty()) key += fmt::format(" '{}'", name.substr(0, 60));
    return {path_, line(node), key};
}

pugi::xml_node SvgFile::by_id(const std::string& id) const {
    const auto found = ids_.find(id);
    return found == ids_.end() ? pugi::xml_node() : found->second;
}

pugi::xml_node SvgFile::referenced(const pugi::xml_node& node) const {
    const std::string_view reference = href(node);
    if (!reference.starts_with('#')) return {};
    return by_id(std::string(reference.substr(1)));
}

std::string SvgFile::with_entities(std::string_view text) const {
    std::string replaced;
    std::size_t first = 0;
    while (first < text.size() && replaced.size() < longest_style) {
        const std::size_t open = text.find('&', first);
        const std::size_t close = open == std::string_view::npos ? open : text.find(';', open);
        if (close == std::string_view::npos) break;
        const auto entity = entities_.find(std::string(text.substr(open + 1, close - open - 1)));
        const bool known = entity != entities_.end();
        replaced += text.substr(first, (known ? open : close + 1) - first);
        if (known) replaced += entity->second;
        first = close + 1;
    }
    return replaced += text.substr(std::min(first, text.size()));
}

Declared SvgFile::declared(const pugi::xml_node& node) const {
    if (sheet_.effort() > most_effort) {
        throw InputError({path_, 0, "style"}, "the style sheet is too entangled to be a drawing's",
                         "Export the drawing with presentation attributes instead of a style sheet.");
    }
    const std::string_view style = node.attribute("style").value();
    return entities_.empty() ? sheet_.declared(node, style) : sheet_.declared(node, with_entities(style));
}

}  // namespace ruche::svg

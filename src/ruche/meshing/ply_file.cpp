#include "ruche/meshing/ply_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "ruche/core/error.hpp"

namespace ruche {
namespace {

constexpr std::int64_t most_items = 50'000'000;

std::optional<PlyType> type_named(std::string_view name) {
    if (name == "char" || name == "int8") return PlyType::int8;
    if (name == "uchar" || name == "uint8") return PlyType::uint8;
    if (name == "short" || name == "int16") return PlyType::int16;
    if (name == "ushort" || name == "uint16") return PlyType::uint16;
    if (name == "int" || name == "int32") return PlyType::int32;
    if (name == "uint" || name == "uint32") return PlyType::uint32;
    if (name == "float" || name == "float32") return PlyType::float32;
    if (name == "double" || name == "float64") return PlyType::float64;
    return std::nullopt;
}

class HeaderReader {
  public:
    HeaderReader(TextScan& scan, const std::string& file, const char* advice)
        : scan_(scan), file_(file), advice_(advice) {}

    PlyHeader read() {
        if (scan_.take_line() != "ply") fail("this is not a PLY file: it does not begin with \"ply\"");
        while (!scan_.at_end()) {
            std::string_view line = scan_.take_line();
            if (line.size() > 1000) fail("the header has a line of more than 1000 characters");
            const std::string_view word = take_word(line);
            if (word == "end_header") {
                if (!has_format_) fail("the header names no format");
                return std::move(header_);
            }
            if (word == "format") read_format(line);
            if (word == "element") read_element(line);
            if (word == "property") read_property(line);
            if (word == "comment") read_comment(line);
            const bool known = word.empty() || word == "comment" || word == "obj_info" || word == "format" ||
                               word == "element" || word == "property";
            if (!known) fail(fmt::format("unknown word \"{}\" in the header", word.substr(0, 40)));
        }
        fail("the file ends within its header");
    }

  private:
    void read_format(std::string_view line) {
        const std::string_view name = take_word(line);
        has_format_ = true;
        if (name == "ascii")
            header_.format = PlyFormat::ascii;
        else if (name == "binary_little_endian")
            header_.format = PlyFormat::little_endian;
        else if (name == "binary_big_endian")
            header_.format = PlyFormat::big_endian;
        else
            fail(fmt::format("unknown format \"{}\"", name));
    }

    /// "strip 0 arm" names a strip; all else is for people.
    void read_comment(std::string_view line) {
        int number = -1;
        if (take_word(line) != "strip" || !read_number(take_word(line), number) || number < 0) return;
        const std::size_t begin = line.find_first_not_of(" \t");
        const std::size_t end = line.find_last_not_of(" \t\r");
        if (begin != std::string_view::npos)
            header_.strip_names[number] = line.substr(begin, end - begin + 1);
    }

    void read_element(std::string_view line) {
        PlyElement element{std::string(take_word(line)), -1, {}};
        const std::string_view count = take_word(line);
        if (!read_number(count, element.count) || element.count < 0 || element.count > most_items)
            fail(fmt::format("\"{}\" is not a number of {} elements", count, element.name));
        header_.elements.push_back(std::move(element));
    }

    void read_property(std::string_view line) {
        if (header_.elements.empty()) fail("a property before the first element");
        PlyProperty property;
        std::string_view type = take_word(line);
        if (type == "list") {
            const std::string_view count = take_word(line);
            property.count_type = type_named(count);
            const bool whole = property.count_type && *property.count_type < PlyType::float32;
            if (!whole) fail(fmt::format("\"{}\" is not a type for a list's length", count));
            type = take_word(line);
        }
        const std::optional<PlyType> known = type_named(type);
        if (!known) fail(fmt::format("unknown type \"{}\"", type));
        property.type = *known;
        property.name = take_word(line);
        if (property.name.empty()) fail("a property without a name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError({.file = file_, .line = scan_.line()}, problem, advice_);
    }

    TextScan& scan_;
    const std::string& file_;
    const char* advice_;
    PlyHeader header_;
    bool has_format_ = false;
};

}  // namespace

PlyHeader read_ply_header(TextScan& scan, const std::string& file, const char* advice) {
    return HeaderReader(scan, file, advice).read();
}

void PlyBody::begin_item(const PlyElement& element, std::int64_t index) {
    element_ = &element;
    index_ = index;
    if (format_ != PlyFormat::ascii) return;
    do {
        if (scan_.at_end()) fail_short();
        line_ = scan_.take_line();
    } while (line_.find_first_not_of(" \t") == std::string_view::npos);
}

template <class Number>
double PlyBody::take_bytes() {
    if (bytes_.size() < sizeof(Number)) fail_short();
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), bytes_.data(), raw.size());
    bytes_.remove_prefix(raw.size());
    const bool swap = (format_ == PlyFormat::big_endian) != (std::endian::native == std::endian::big);
    if (swap) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<Number>(raw));
}

double PlyBody::take(PlyType type) {
    if (format_ == PlyFormat::ascii) return take_text();
    switch (type) {
        case PlyType::int8:
            return take_bytes<std::int8_t>();
        case PlyType::uint8:
            return take_bytes<std::uint8_t>();
        case PlyType::int16:
            return take_bytes<std::int16_t>();
        case PlyType::uint16:
            return take_bytes<std::uint16_t>();
        case PlyType::int32:
            return take_bytes<std::int32_t>();
        case PlyType::uint32:
            return take_bytes<std::uint32_t>();
        case PlyType::float32:
            return take_bytes<float>();
        case PlyType::float64:
            return take_bytes<double>();
    }
    return 0.0;
}

int PlyBody::take_count(const PlyProperty& list) {
    const double count = take(*list.count_type);
    if (!(count >= 0 && count < 1e9)) fail(fmt::format("a list of {} values", count));
    return static_cast<int>(count);
}

void PlyBody::fail(const std::string& problem) const {
    throw InputError({.file = file_,
                      .line = format_ == PlyFormat::ascii ? scan_.line() : 0,
                      .key = fmt::format("{} {}", element_->name, index_)},
                     problem, advice_);
}

double PlyBody::take_text() {
    const std::string_view word = take_word(line_);
    double number = 0.0;
    if (word.empty()) fail("the line ends too early");
    if (!read_number(word, number)) fail(fmt::format("\"{}\" is not a number", word.substr(0, 40)));
    return number;
}

void PlyBody::fail_short() const {
    fail(fmt::format("the file ends here, {} more {} elements are missing", element_->count - index_,
                     element_->name));
}

int ply_index(double value) {
    constexpr double largest = 2e9;
    return value >= 0 && value < largest ? static_cast<int>(value) : -1;
}

}  // namespace ruche

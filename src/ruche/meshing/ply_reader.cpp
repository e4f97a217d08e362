#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/meshing/raw_mesh.hpp"

namespace ruche {
namespace {

constexpr std::size_t longest_file = std::size_t{1} << 30U;
constexpr std::int64_t most_items = 50'000'000;

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> type_named(std::string_view name) {
    if (name == "char" || name == "int8") return Type::int8;
    if (name == "uchar" || name == "uint8") return Type::uint8;
    if (name == "short" || name == "int16") return Type::int16;
    if (name == "ushort" || name == "uint16") return Type::uint16;
    if (name == "int" || name == "int32") return Type::int32;
    if (name == "uint" || name == "uint32") return Type::uint32;
    if (name == "float" || name == "float32") return Type::float32;
    if (name == "double" || name == "float64") return Type::float64;
    return std::nullopt;
}

struct Property {
    std::string name;
    Type type = Type::float64;
    std::optional<Type> count_type;  ///< of a list
};

struct Element {
    std::string name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

enum class Format { ascii, little_endian, big_endian };

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::map<int, std::string> strip_names;
};

constexpr const char* advice =
    "A PLY for a layout has vertices x, y and triangles (vertex_indices) with the properties front_mm and "
    "back_mm: printed thickness, 0 for none.";

class HeaderReader {
  public:
    HeaderReader(TextScan& scan, const std::string& file) : scan_(scan), file_(file) {}

    Header read() {
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
            header_.format = Format::ascii;
        else if (name == "binary_little_endian")
            header_.format = Format::little_endian;
        else if (name == "binary_big_endian")
            header_.format = Format::big_endian;
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
        Element element{std::string(take_word(line)), -1, {}};
        const std::string_view count = take_word(line);
        if (!read_number(count, element.count) || element.count < 0 || element.count > most_items)
            fail(fmt::format("\"{}\" is not a number of {} elements", count, element.name));
        header_.elements.push_back(std::move(element));
    }

    void read_property(std::string_view line) {
        if (header_.elements.empty()) fail("a property before the first element");
        Property property;
        std::string_view type = take_word(line);
        if (type == "list") {
            const std::string_view count = take_word(line);
            property.count_type = type_named(count);
            const bool whole = property.count_type && *property.count_type < Type::float32;
            if (!whole) fail(fmt::format("\"{}\" is not a type for a list's length", count));
            type = take_word(line);
        }
        const std::optional<Type> known = type_named(type);
        if (!known) fail(fmt::format("unknown type \"{}\"", type));
        property.type = *known;
        property.name = take_word(line);
        if (property.name.empty()) fail("a property without a name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError({.file = file_, .line = scan_.line()}, problem, advice);
    }

    TextScan& scan_;
    const std::string& file_;
    Header header_;
    bool has_format_ = false;
};

/// Takes values one after the other from what follows the header.
class Body {
  public:
    Body(TextScan scan, Format format, const std::string& file)
        : scan_(scan), bytes_(scan.rest()), format_(format), file_(file) {}

    void begin_item(const Element& element, std::int64_t index) {
        element_ = &element;
        index_ = index;
        if (format_ != Format::ascii) return;
        do {
            if (scan_.at_end()) fail_short();
            line_ = scan_.take_line();
        } while (line_.find_first_not_of(" \t") == std::string_view::npos);
    }

    double take(Type type) {
        if (format_ == Format::ascii) return take_text();
        switch (type) {
            case Type::int8:
                return take_bytes<std::int8_t>();
            case Type::uint8:
                return take_bytes<std::uint8_t>();
            case Type::int16:
                return take_bytes<std::int16_t>();
            case Type::uint16:
                return take_bytes<std::uint16_t>();
            case Type::int32:
                return take_bytes<std::int32_t>();
            case Type::uint32:
                return take_bytes<std::uint32_t>();
            case Type::float32:
                return take_bytes<float>();
            case Type::float64:
                return take_bytes<double>();
        }
        return 0.0;
    }

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError({.file = file_,
                          .line = format_ == Format::ascii ? scan_.line() : 0,
                          .key = fmt::format("{} {}", element_->name, index_)},
                         problem, advice);
    }

  private:
    double take_text() {
        const std::string_view word = take_word(line_);
        double number = 0.0;
        if (word.empty()) fail("the line ends too early");
        if (!read_number(word, number)) fail(fmt::format("\"{}\" is not a number", word.substr(0, 40)));
        return number;
    }

    template <class Number>
    double take_bytes() {
        if (bytes_.size() < sizeof(Number)) fail_short();
        std::array<char, sizeof(Number)> raw;
        std::memcpy(raw.data(), bytes_.data(), raw.size());
        bytes_.remove_prefix(raw.size());
        const bool swap = (format_ == Format::big_endian) != (std::endian::native == std::endian::big);
        if (swap) std::reverse(raw.begin(), raw.end());
        return static_cast<double>(std::bit_cast<Number>(raw));
    }

    [[noreturn]] void fail_short() const {
        fail(fmt::format("the file ends here, {} more {} elements are missing", element_->count - index_,
                         element_->name));
    }

    TextScan scan_;
    std::string_view bytes_;
    Format format_;
    const std::string& file_;
    std::string_view line_;
    const Element* element_ = nullptr;
    std::int64_t index_ = 0;
};

int index_of(double value) {
    constexpr double largest = 2e9;
    return value >= 0 && value < largest ? static_cast<int>(value) : -1;
}

/// Where a value of a vertex or face goes; nullptr: nowhere.
double* vertex_target(Vec3& vertex, const std::string& name) {
    if (name == "x") return &vertex.x();
    if (name == "y") return &vertex.y();
    if (name == "z") return &vertex.z();
    return nullptr;
}

struct Face {
    Print print;
    double thickness = 0.0;
    double strip = -1.0;  // on whichever side is printed
    double front_strip = -1.0;
    double back_strip = -1.0;
    bool has_corners = false;
    Triangle corners = {};
};

double* face_target(Face& face, const std::string& name) {
    if (name == "front_mm") return &face.print.front;
    if (name == "back_mm") return &face.print.back;
    if (name == "thickness_mm") return &face.thickness;
    if (name == "strip") return &face.strip;
    if (name == "front_strip") return &face.front_strip;
    if (name == "back_strip") return &face.back_strip;
    if (name == "front_modulus_mpa") return &face.print.front_modulus;
    if (name == "back_modulus_mpa") return &face.print.back_modulus;
    return nullptr;
}

void read_list(Body& body, const Property& property, Face* face) {
    const double count = body.take(*property.count_type);
    const bool corners =
        face != nullptr && (property.name == "vertex_indices" || property.name == "vertex_index");
    if (!(count >= 0 && count < 1e9)) body.fail(fmt::format("a list of {} values", count));
    if (corners && count != 3)
        body.fail(fmt::format("a face with {} corners; a layout mesh has triangles only", count));
    for (int i = 0; i < static_cast<int>(count); ++i) {
        const double value = body.take(property.type);
        if (corners) face->corners[i] = index_of(value);
    }
    if (corners) face->has_corners = true;
}

bool has_property(const Header& header, std::string_view element, std::string_view property) {
    for (const Element& e : header.elements) {
        for (const Property& p : e.properties) {
            if (e.name == element && p.name == property) return true;
        }
    }
    return false;
}

void check_properties(const Header& header, const std::string& file) {
    const auto has = [&](const char* element, const char* property) {
        return has_property(header, element, property);
    };
    const auto fail = [&](const char* problem) { throw InputError({.file = file}, problem, advice); };
    if (!has("vertex", "x") || !has("vertex", "y")) fail("the vertices have no x and y");
    if (!has("face", "vertex_indices") && !has("face", "vertex_index")) fail("there are no faces");
    const bool sides = has("face", "front_mm") || has("face", "back_mm");
    const bool is_signed = has("face", "thickness_mm");
    if (sides && is_signed) fail("the faces have both thickness_mm and front_mm or back_mm");
    if (!sides && !is_signed) fail("the faces have neither front_mm, back_mm nor thickness_mm");
}

}  // namespace

RawMesh read_ply(const std::string& path) {
    const std::string text = read_file(path, "PLY mesh", longest_file);
    TextScan scan(text);
    const Header header = HeaderReader(scan, path).read();
    check_properties(header, path);
    Body body(scan, header.format, path);
    RawMesh mesh;
    mesh.strip_names = header.strip_names;
    const bool strip_per_side =
        has_property(header, "face", "front_strip") || has_property(header, "face", "back_strip");
    for (const Element& element : header.elements) {
        const bool vertices = element.name == "vertex";
        const bool faces = element.name == "face";
        for (std::int64_t i = 0; i < element.count; ++i) {
            body.begin_item(element, i);
            Vec3 vertex = Vec3::Zero();
            Face face;
            for (const Property& property : element.properties) {
                if (property.count_type) {
                    read_list(body, property, faces ? &face : nullptr);
                    continue;
                }
                const double value = body.take(property.type);
                double* target = vertices ? vertex_target(vertex, property.name)
                                 : faces  ? face_target(face, property.name)
                                          : nullptr;
                if (target != nullptr) *target = value;
            }
            if (vertices) mesh.vertices.push_back(vertex);
            if (!faces) continue;
            if (face.thickness < 0.0)
                face.print.back = -face.thickness;
            else if (face.thickness > 0.0 || face.thickness != face.thickness)
                face.print.front = face.thickness;
            mesh.triangles.push_back(face.corners);
            mesh.print.push_back(face.print);
            mesh.strip.push_back({index_of(strip_per_side ? face.front_strip : face.strip),
                                  index_of(strip_per_side ? face.back_strip : face.strip)});
        }
    }
    return mesh;
}

}  // namespace ruche

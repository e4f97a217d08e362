#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/core/text_scan.hpp"

namespace ruche {

/// What a PLY file says of itself, and its values one after the other: text or binary of either byte order.
/// What they mean is for the caller to say.
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float64;
    std::optional<PlyType> count_type;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::int64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

/// The header, and the names of strips from comments ("comment strip 0 arm").
struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::map<int, std::string> strip_names;
};

/// Takes the header from the text. Throws InputError, with `advice`.
PlyHeader read_ply_header(TextScan& scan, const std::string& file, const char* advice);

/// Takes values one after the other from what follows the header.
class PlyBody {
  public:
    PlyBody(TextScan scan, PlyFormat format, const std::string& file, const char* advice)
        : scan_(scan), bytes_(scan.rest()), format_(format), file_(file), advice_(advice) {}

    /// To be called before the values of each item.
    void begin_item(const PlyElement& element, std::int64_t index);
    double take(PlyType type);
    /// The length of a list. Throws InputError for one that cannot be.
    int take_count(const PlyProperty& list);
    [[noreturn]] void fail(const std::string& problem) const;

  private:
    double take_text();
    template <class Number>
    double take_bytes();
    [[noreturn]] void fail_short() const;

    TextScan scan_;
    std::string_view bytes_;
    PlyFormat format_;
    const std::string& file_;
    const char* advice_;
    std::string_view line_;
    const PlyElement* element_ = nullptr;
    std::int64_t index_ = 0;
};

/// A vertex number as files write it; -1 for what is none.
int ply_index(double value);

}  // namespace ruche

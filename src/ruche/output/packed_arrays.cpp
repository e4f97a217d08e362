#include "ruche/output/packed_arrays.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ruche/core/error.hpp"
#include "ruche/output/little_endian.hpp"

namespace ruche {
namespace {

constexpr double most_16 = 65535.0;

template <class Number>
void append_numbers(std::string& bytes, std::span<const int> values) {
    for (const int v : values)
        append_bytes(bytes, v < 0 ? std::numeric_limits<Number>::max() : static_cast<Number>(v));
}

}  // namespace

PackedArray& PackedArrays::begin(const std::string& name, const char* type, std::size_t values,
                                 int components) {
    // Readers lay an array of 4-byte numbers over the bytes as they are.
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    list_.push_back({.name = name,
                     .type = type,
                     .at = bytes_.size(),
                     .count = values / static_cast<std::size_t>(components),
                     .components = components});
    return list_.back();
}

void PackedArrays::add_numbers(const std::string& name, std::span<const int> values, int components) {
    const int largest = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
    if (largest < 0xff) {
        begin(name, "u8", values.size(), components);
        append_numbers<std::uint8_t>(bytes_, values);
    } else if (largest < 0xffff) {
        begin(name, "u16", values.size(), components);
        append_numbers<std::uint16_t>(bytes_, values);
    } else {
        begin(name, "u32", values.size(), components);
        append_numbers<std::uint32_t>(bytes_, values);
    }
}

void PackedArrays::add_even(const std::string& name, std::span<const double> values, int components) {
    PackedArray& about = begin(name, "u16", values.size(), components);
    const auto parts = static_cast<std::size_t>(components);
    for (std::size_t k = 0; k < parts; ++k) {
        double low = values.empty() ? 0.0 : values[k];
        double high = low;
        for (std::size_t i = k; i < values.size(); i += parts) {
            low = std::min(low, values[i]);
            high = std::max(high, values[i]);
        }
        about.origin.push_back(low);
        about.scale.push_back((high - low) / most_16);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double step = about.scale[i % parts];
        const double q = step > 0.0 ? std::round((values[i] - about.origin[i % parts]) / step) : 0.0;
        append_bytes(bytes_, static_cast<std::uint16_t>(std::clamp(q, 0.0, most_16)));
    }
}

void PackedArrays::add_relative(const std::string& name, std::span<const double> values) {
    begin(name, "f16", values.size(), 1);
    constexpr double most = 65504.0;
    for (const double v : values) {
        const double kept = std::isnan(v) ? v : std::clamp(v, -most, most);
        append_bytes(bytes_, Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(static_cast<float>(kept))));
    }
}

static constexpr std::string_view base64_letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string base64(const std::string& bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8U | (k < left ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= left ? base64_letters[word >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string from_base64(const std::string& text) {
    const std::size_t end = std::min(text.find('='), text.size());
    bool sound = text.size() % 4 == 0 && text.size() - end <= 2 && end % 4 != 1 &&
                 text.find_first_not_of('=', end) == std::string::npos;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < end && sound; ++i) {
        const std::size_t digit = base64_letters.find(text[i]);
        sound = digit != std::string_view::npos;
        word = word << 6U | static_cast<std::uint32_t>(digit);
        if (i % 4 != 0) bytes += static_cast<char>(word >> (6 - 2 * (i % 4)) & 255U);
    }
    if (!sound) throw InputError({}, "these bytes are not in base64 (RFC 4648)");
    return bytes;
}

}  // namespace ruche

#include "ruche/output/animated_png.hpp"

#include <zlib.h>

#include <string_view>

namespace ruche {
namespace {

constexpr std::size_t signature_bytes = 8;
constexpr std::size_t size_bytes = 4;
constexpr std::size_t kind_bytes = 4;
constexpr std::size_t sum_bytes = 4;
constexpr std::size_t ihdr_bytes = 13;

std::string big_endian(unsigned value, int bytes = 4) {
    std::string text;
    for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 255U);
    return text;
}

unsigned from_big_endian(std::string_view text) {
    unsigned value = 0;
    for (const char c : text.substr(0, size_bytes)) value = value << 8U | static_cast<unsigned char>(c);
    return value;
}

std::string chunk(const char* kind, const std::string& data) {
    const std::string body = kind + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<unsigned>(data.size())) + body + big_endian(static_cast<unsigned>(sum));
}

/// What stands in a PNG's chunks of one kind, put together.
std::string contents(const std::string& png, std::string_view kind) {
    std::string data;
    for (std::size_t at = signature_bytes; at + size_bytes + kind_bytes <= png.size();) {
        const std::size_t size = from_big_endian(std::string_view(png).substr(at));
        const std::size_t begin = at + size_bytes + kind_bytes;
        if (std::string_view(png).substr(at + size_bytes, kind_bytes) == kind)
            data += png.substr(begin, size);
        at = begin + size + sum_bytes;
    }
    return data;
}

}  // namespace

void AnimatedPng::add(const Image& image, int milliseconds) {
    const std::string png = to_png(image);
    constexpr unsigned whole_picture_again = 0;  // neither disposed of nor blended
    frames_ += chunk("fcTL", big_endian(sequence_++) + big_endian(static_cast<unsigned>(image.width)) +
                                 big_endian(static_cast<unsigned>(image.height)) + big_endian(0) +
                                 big_endian(0) + big_endian(static_cast<unsigned>(milliseconds), 2) +
                                 big_endian(1000, 2) + big_endian(whole_picture_again, 2));
    if (frame_count_++ == 0) {
        head_ = png.substr(0, signature_bytes) + chunk("IHDR", contents(png, "IHDR").substr(0, ihdr_bytes));
        frames_ += chunk("IDAT", contents(png, "IDAT"));
    } else {
        frames_ += chunk("fdAT", big_endian(sequence_++) + contents(png, "IDAT"));
    }
}

std::string AnimatedPng::file() const {
    constexpr unsigned for_ever = 0;
    return head_ + chunk("acTL", big_endian(frame_count_) + big_endian(for_ever)) + frames_ +
           chunk("IEND", "");
}

}  // namespace ruche

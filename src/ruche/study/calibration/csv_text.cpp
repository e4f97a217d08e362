#include "ruche/study/calibration/csv_text.hpp"

#include <algorithm>
#include <cstdint>

#include "ruche/core/error.hpp"

namespace ruche {
namespace {

void append_utf8(std::string& text, std::uint32_t code) {
    if (code < 0x80U) {
        text += static_cast<char>(code);
    } else if (code < 0x800U) {
        text += static_cast<char>(0xC0U | code >> 6U);
        text += static_cast<char>(0x80U | (code & 0x3FU));
    } else {
        text += static_cast<char>(0xE0U | code >> 12U);
        text += static_cast<char>(0x80U | (code >> 6U & 0x3FU));
        text += static_cast<char>(0x80U | (code & 0x3FU));
    }
}

/// Marks that programs put into numbers and units stand between 0x80 and 0x9F; the rest is Latin-1.
std::uint32_t windows_1252(unsigned char byte) {
    switch (byte) {
        case 0x91:
        case 0x92:
            return 0x2019U;  // apostrophes
        case 0x96:
            return 0x2013U;  // a dash
        default:
            return byte;
    }
}

/// Machines write nothing beyond the first plane of Unicode; a surrogate becomes a replacement character.
std::string from_utf16(std::string_view bytes, bool big_endian) {
    std::string text;
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        const auto a = static_cast<unsigned char>(bytes[i]);
        const auto b = static_cast<unsigned char>(bytes[i + 1]);
        const std::uint32_t code = big_endian ? 256U * a + b : 256U * b + a;
        append_utf8(text, code >= 0xD800U && code < 0xE000U ? 0xFFFDU : code);
    }
    return text;
}

bool is_utf8(std::string_view bytes) {
    std::size_t follow = 0;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (follow > 0) {
            if ((byte & 0xC0U) != 0x80U) return false;
            --follow;
        } else if (byte >= 0x80U) {
            if (byte < 0xC2U || byte > 0xF4U) return false;
            follow = byte < 0xE0U ? 1 : byte < 0xF0U ? 2 : 3;
        }
    }
    return follow == 0;
}

}  // namespace

std::string text_of(std::string_view bytes, const std::string& file) {
    if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes, false);
    if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes, true);
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    if (bytes.find('\0') != std::string_view::npos)
        throw InputError({.file = file}, "is a binary file, expected a table as text",
                         "Export the test as CSV or text; spreadsheets (xls, xlsx) cannot be read.");
    std::string text;
    if (is_utf8(bytes))
        text = bytes;
    else
        for (const char c : bytes) append_utf8(text, windows_1252(static_cast<unsigned char>(c)));
    // Old Macs end lines with a carriage return alone.
    if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
    return text;
}

}  // namespace ruche

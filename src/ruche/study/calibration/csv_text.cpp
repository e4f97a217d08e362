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

/// UTF-16 without a mark: every other byte of the beginning, which is ASCII, is 0, and no other.
bool is_bare_utf16(std::string_view bytes, bool big_endian) {
    const std::string_view head = bytes.substr(0, 64);
    if (head.size() < 16) return false;
    for (std::size_t i = 0; i < head.size(); ++i) {
        const bool high = (i % 2 == 0) == big_endian;
        if ((head[i] == '\0') != high) return false;
    }
    return true;
}

/// Machines write nothing beyond the first plane of Unicode; a surrogate becomes a replacement character.
std::string from_utf16(std::string_view bytes, bool big_endian) {
    std::string text;
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        const auto a = static_cast<unsigned char>(bytes[i]);
        const auto b = static_cast<unsigned char>(bytes[i + 1]);
        const std::uint32_t code = big_endian ? 256U * a + b : 256U * b + a;
        append_utf8(text, code >= 0xD800U && code < 0xE000U ? 0xFFFDU : code);
    }
    return text;
}

/// What a file is that is no table: people take the plot, the report or the spreadsheet for the readings.
std::string_view kind_of_other_file(std::string_view bytes) {
    struct Kind {
        std::string_view begin, name;
    };
    constexpr Kind kinds[] = {{"%PDF", "a PDF"},
                              {"\x89PNG", "a picture (PNG)"},
                              {"\xFF\xD8\xFF", "a picture (JPEG)"},
                              {"GIF8", "a picture (GIF)"},
                              {"PK\x03\x04", "a spreadsheet (xlsx, ods) or a zip file"},
                              {"\xD0\xCF\x11\xE0", "an old spreadsheet (xls)"},
                              {"{\\rtf", "a text document (RTF)"},
                              {"<?xml", "an XML or SVG file"},
                              {"<svg", "an SVG file"},
                              {"<!", "an HTML or XML file"},
                              {"<html", "an HTML file"}};
    const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
    if (begin != std::string_view::npos) bytes.remove_prefix(begin);
    for (const Kind& kind : kinds)
        if (bytes.starts_with(kind.begin)) return kind.name;
    return {};
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
    if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes.substr(2), false);
    if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes.substr(2), true);
    if (is_bare_utf16(bytes, false)) return from_utf16(bytes, false);
    if (is_bare_utf16(bytes, true)) return from_utf16(bytes, true);
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    std::string kind(kind_of_other_file(bytes));
    if (kind.empty() && bytes.find('\0') != std::string_view::npos) kind = "a binary file";
    if (!kind.empty())
        throw InputError(
            {.file = file}, "is " + kind + ", expected a table as text",
            "Export the readings of the test as CSV or text, not its report, plot or spreadsheet.");
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

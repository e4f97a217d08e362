#include "ruche/pattern/svg_encoding.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

void append_utf8(std::string& out, std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80U) {
        put(code);
    } else if (code < 0x800U) {
        put(0xC0U | code >> 6U);
        put(0x80U | (code & 0x3FU));
    } else if (code < 0x10000U) {
        put(0xE0U | code >> 12U);
        put(0x80U | (code >> 6U & 0x3FU));
        put(0x80U | (code & 0x3FU));
    } else {
        put(0xF0U | code >> 18U);
        put(0x80U | (code >> 12U & 0x3FU));
        put(0x80U | (code >> 6U & 0x3FU));
        put(0x80U | (code & 0x3FU));
    }
}

std::uint32_t byte_at(std::string_view bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

std::string from_utf16(std::string_view bytes, bool big_endian) {
    const auto unit = [&](std::size_t i) {
        const std::uint32_t a = byte_at(bytes, i), b = byte_at(bytes, i + 1);
        return big_endian ? a << 8U | b : b << 8U | a;
    };
    std::string text;
    text.reserve(bytes.size());
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        std::uint32_t code = unit(i);
        if (code >= 0xD800U && code < 0xDC00U && i + 3 < bytes.size()) {
            const std::uint32_t low = unit(i + 2);
            if (low >= 0xDC00U && low < 0xE000U) {
                code = 0x10000U + ((code - 0xD800U) << 10U) + (low - 0xDC00U);
                i += 2;
            }
        }
        // A lone surrogate is no character.
        append_utf8(text, code >= 0xD800U && code < 0xE000U ? 0xFFFDU : code);
    }
    return text;
}

/// Latin-1; Windows-1252's characters from 0x80 to 0x9F lose their meaning, which only shows in labels.
std::string from_latin_1(std::string_view bytes) {
    std::string text;
    text.reserve(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) append_utf8(text, byte_at(bytes, i));
    return text;
}

/// The position of the first byte that is not UTF-8.
std::optional<std::size_t> first_not_utf8(std::string_view bytes) {
    std::size_t i = 0;
    while (i < bytes.size()) {
        const std::uint32_t lead = byte_at(bytes, i);
        const std::size_t length = lead < 0x80U                     ? 1
                                   : lead >= 0xC2U && lead < 0xE0U  ? 2
                                   : lead >= 0xE0U && lead < 0xF0U  ? 3
                                   : lead >= 0xF0U && lead <= 0xF4U ? 4
                                                                    : 0;
        if (length == 0 || i + length > bytes.size()) return i;
        for (std::size_t k = 1; k < length; ++k) {
            if ((byte_at(bytes, i + k) & 0xC0U) != 0x80U) return i;
        }
        i += length;
    }
    return std::nullopt;
}

/// The encoding in the XML declaration, lower case; empty when there is none.
std::string declared_encoding(std::string_view text) {
    if (!text.starts_with("<?xml")) return {};
    const std::string_view declaration = text.substr(0, text.find("?>"));
    const std::size_t key = declaration.find("encoding");
    if (key == std::string_view::npos) return {};
    const std::size_t open = declaration.find_first_of("\"'", key);
    if (open == std::string_view::npos) return {};
    const std::size_t close = declaration.find(declaration[open], open + 1);
    if (close == std::string_view::npos) return {};
    return lower_case(declaration.substr(open + 1, close - open - 1));
}

int line_at(std::string_view text, std::size_t position) {
    return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(position), '\n'));
}

bool is_latin_1(const std::string& encoding) {
    return encoding == "iso-8859-1" || encoding == "latin1" || encoding == "latin-1" ||
           encoding == "iso-8859-15" || encoding == "windows-1252" || encoding == "cp1252";
}

}  // namespace

std::string to_utf8(std::string_view bytes, const std::string& file) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes.substr(2), false);
    if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes.substr(2), true);
    if (bytes.starts_with(std::string_view("<\0", 2))) return from_utf16(bytes, false);
    if (bytes.starts_with(std::string_view("\0<", 2))) return from_utf16(bytes, true);

    if (bytes.starts_with("\x1F\x8B")) {
        throw InputError({file, 0, {}}, "is a compressed SVG (.svgz)",
                         "Save it as plain SVG, or unpack it: gunzip -S .svgz");
    }
    if (bytes.starts_with("%PDF") || bytes.starts_with("%!PS")) {
        throw InputError({file, 0, {}}, "is a PDF or PostScript file, not SVG",
                         "Export the drawing as SVG (Illustrator: File > Export > SVG).");
    }
    const std::size_t nul = bytes.find('\0');
    if (nul != std::string_view::npos) {
        throw InputError({file, 0, {}}, "is not text (it holds a zero byte), so it is no SVG file",
                         "Export the drawing as plain SVG.");
    }
    const std::string encoding = declared_encoding(bytes);
    if (is_latin_1(encoding)) return from_latin_1(bytes);
    const std::optional<std::size_t> bad = first_not_utf8(bytes);
    if (!bad) return std::string(bytes);
    const std::string claim = encoding.empty() || encoding == "utf-8"
                                  ? "the text is not UTF-8, as it should be"
                                  : "the encoding '" + encoding.substr(0, 40) + "' is not supported";
    throw InputError({file, line_at(bytes, *bad), {}}, claim, "Save the drawing again as UTF-8.");
}

}  // namespace ruche::svg

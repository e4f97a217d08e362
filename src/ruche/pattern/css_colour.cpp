#include "ruche/pattern/css_colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "ruche/pattern/svg_scanner.hpp"

namespace ruche {

namespace {

struct NamedColour {
    std::string_view name;
    std::uint32_t rgb;
};

// CSS Color 4, section 6.1, by name.
constexpr NamedColour named_colours[] = {
    {"aliceblue", 0xf0f8ff},
    {"antiquewhite", 0xfaebd7},
    {"aqua", 0x00ffff},
    {"aquamarine", 0x7fffd4},
    {"azure", 0xf0ffff},
    {"beige", 0xf5f5dc},
    {"bisque", 0xffe4c4},
    {"black", 0x000000},
    {"blanchedalmond", 0xffebcd},
    {"blue", 0x0000ff},
    {"blueviolet", 0x8a2be2},
    {"brown", 0xa52a2a},
    {"burlywood", 0xdeb887},
    {"cadetblue", 0x5f9ea0},
    {"chartreuse", 0x7fff00},
    {"chocolate", 0xd2691e},
    {"coral", 0xff7f50},
    {"cornflowerblue", 0x6495ed},
    {"cornsilk", 0xfff8dc},
    {"crimson", 0xdc143c},
    {"cyan", 0x00ffff},
    {"darkblue", 0x00008b},
    {"darkcyan", 0x008b8b},
    {"darkgoldenrod", 0xb8860b},
    {"darkgray", 0xa9a9a9},
    {"darkgreen", 0x006400},
    {"darkgrey", 0xa9a9a9},
    {"darkkhaki", 0xbdb76b},
    {"darkmagenta", 0x8b008b},
    {"darkolivegreen", 0x556b2f},
    {"darkorange", 0xff8c00},
    {"darkorchid", 0x9932cc},
    {"darkred", 0x8b0000},
    {"darksalmon", 0xe9967a},
    {"darkseagreen", 0x8fbc8f},
    {"darkslateblue", 0x483d8b},
    {"darkslategray", 0x2f4f4f},
    {"darkslategrey", 0x2f4f4f},
    {"darkturquoise", 0x00ced1},
    {"darkviolet", 0x9400d3},
    {"deeppink", 0xff1493},
    {"deepskyblue", 0x00bfff},
    {"dimgray", 0x696969},
    {"dimgrey", 0x696969},
    {"dodgerblue", 0x1e90ff},
    {"firebrick", 0xb22222},
    {"floralwhite", 0xfffaf0},
    {"forestgreen", 0x228b22},
    {"fuchsia", 0xff00ff},
    {"gainsboro", 0xdcdcdc},
    {"ghostwhite", 0xf8f8ff},
    {"gold", 0xffd700},
    {"goldenrod", 0xdaa520},
    {"gray", 0x808080},
    {"green", 0x008000},
    {"greenyellow", 0xadff2f},
    {"grey", 0x808080},
    {"honeydew", 0xf0fff0},
    {"hotpink", 0xff69b4},
    {"indianred", 0xcd5c5c},
    {"indigo", 0x4b0082},
    {"ivory", 0xfffff0},
    {"khaki", 0xf0e68c},
    {"lavender", 0xe6e6fa},
    {"lavenderblush", 0xfff0f5},
    {"lawngreen", 0x7cfc00},
    {"lemonchiffon", 0xfffacd},
    {"lightblue", 0xadd8e6},
    {"lightcoral", 0xf08080},
    {"lightcyan", 0xe0ffff},
    {"lightgoldenrodyellow", 0xfafad2},
    {"lightgray", 0xd3d3d3},
    {"lightgreen", 0x90ee90},
    {"lightgrey", 0xd3d3d3},
    {"lightpink", 0xffb6c1},
    {"lightsalmon", 0xffa07a},
    {"lightseagreen", 0x20b2aa},
    {"lightskyblue", 0x87cefa},
    {"lightslategray", 0x778899},
    {"lightslategrey", 0x778899},
    {"lightsteelblue", 0xb0c4de},
    {"lightyellow", 0xffffe0},
    {"lime", 0x00ff00},
    {"limegreen", 0x32cd32},
    {"linen", 0xfaf0e6},
    {"magenta", 0xff00ff},
    {"maroon", 0x800000},
    {"mediumaquamarine", 0x66cdaa},
    {"mediumblue", 0x0000cd},
    {"mediumorchid", 0xba55d3},
    {"mediumpurple", 0x9370db},
    {"mediumseagreen", 0x3cb371},
    {"mediumslateblue", 0x7b68ee},
    {"mediumspringgreen", 0x00fa9a},
    {"mediumturquoise", 0x48d1cc},
    {"mediumvioletred", 0xc71585},
    {"midnightblue", 0x191970},
    {"mintcream", 0xf5fffa},
    {"mistyrose", 0xffe4e1},
    {"moccasin", 0xffe4b5},
    {"navajowhite", 0xffdead},
    {"navy", 0x000080},
    {"oldlace", 0xfdf5e6},
    {"olive", 0x808000},
    {"olivedrab", 0x6b8e23},
    {"orange", 0xffa500},
    {"orangered", 0xff4500},
    {"orchid", 0xda70d6},
    {"palegoldenrod", 0xeee8aa},
    {"palegreen", 0x98fb98},
    {"paleturquoise", 0xafeeee},
    {"palevioletred", 0xdb7093},
    {"papayawhip", 0xffefd5},
    {"peachpuff", 0xffdab9},
    {"peru", 0xcd853f},
    {"pink", 0xffc0cb},
    {"plum", 0xdda0dd},
    {"powderblue", 0xb0e0e6},
    {"purple", 0x800080},
    {"rebeccapurple", 0x663399},
    {"red", 0xff0000},
    {"rosybrown", 0xbc8f8f},
    {"royalblue", 0x4169e1},
    {"saddlebrown", 0x8b4513},
    {"salmon", 0xfa8072},
    {"sandybrown", 0xf4a460},
    {"seagreen", 0x2e8b57},
    {"seashell", 0xfff5ee},
    {"sienna", 0xa0522d},
    {"silver", 0xc0c0c0},
    {"skyblue", 0x87ceeb},
    {"slateblue", 0x6a5acd},
    {"slategray", 0x708090},
    {"slategrey", 0x708090},
    {"snow", 0xfffafa},
    {"springgreen", 0x00ff7f},
    {"steelblue", 0x4682b4},
    {"tan", 0xd2b48c},
    {"teal", 0x008080},
    {"thistle", 0xd8bfd8},
    {"tomato", 0xff6347},
    {"turquoise", 0x40e0d0},
    {"violet", 0xee82ee},
    {"wheat", 0xf5deb3},
    {"white", 0xffffff},
    {"whitesmoke", 0xf5f5f5},
    {"yellow", 0xffff00},
    {"yellowgreen", 0x9acd32},
};

CssColour from_rgb(std::uint32_t rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8),
            static_cast<std::uint8_t>(rgb), 1.0};
}

std::uint8_t channel(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

std::optional<CssColour> named(std::string_view name) {
    const auto* found = std::lower_bound(std::begin(named_colours), std::end(named_colours), name,
                                         [](const NamedColour& a, std::string_view b) { return a.name < b; });
    if (found == std::end(named_colours) || found->name != name) return std::nullopt;
    return from_rgb(found->rgb);
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
}

std::optional<CssColour> from_hex(std::string_view text) {
    std::vector<int> digits;
    for (const char c : text.substr(0, text.find_first_of(" \t\r\n"))) {
        digits.push_back(hex_digit(c));
        if (digits.back() < 0 || digits.size() > 8) return std::nullopt;
    }
    if (digits.size() == 3 || digits.size() == 4) {
        std::vector<int> doubled;
        for (const int digit : digits) doubled.insert(doubled.end(), 2, digit);
        digits = doubled;
    }
    if (digits.size() != 6 && digits.size() != 8) return std::nullopt;
    const auto byte = [&](std::size_t i) { return 16 * digits[2 * i] + digits[2 * i + 1]; };
    return CssColour{static_cast<std::uint8_t>(byte(0)), static_cast<std::uint8_t>(byte(1)),
                     static_cast<std::uint8_t>(byte(2)), digits.size() == 8 ? byte(3) / 255.0 : 1.0};
}

struct Argument {
    double value;
    bool percent;
};

/// What stands in the brackets of rgb(...) and hsl(...): three or four numbers, with commas or without.
std::vector<Argument> colour_arguments(svg::Scanner& scanner) {
    std::vector<Argument> values;
    if (!scanner.accept('(')) return {};
    scanner.skip_space();
    while (!scanner.accept(')')) {
        const std::optional<double> value = scanner.number();
        if (!value) return {};
        double factor = 1.0;
        if (scanner.peek() == 't') factor = 360.0;  // "turn"
        const std::string_view unit = scanner.word();
        if (!unit.empty() && unit != "deg" && unit != "turn") return {};
        values.push_back({*value * factor, scanner.accept('%')});
        scanner.skip_separator();
        if (values.size() == 3 && scanner.accept('/')) scanner.skip_space();
    }
    if (values.size() != 3 && values.size() != 4) return {};
    return values;
}

double fraction(const Argument& argument) {
    return std::clamp(argument.percent ? argument.value / 100.0 : argument.value, 0.0, 1.0);
}

/// CSS Color 4, section 7.1; hue in degrees.
CssColour from_hsl(double hue, double saturation, double lightness) {
    const auto component = [&](double n) {
        const double k = std::fmod(n + hue / 30.0, 12.0);
        const double amplitude = saturation * std::min(lightness, 1.0 - lightness);
        return channel(255.0 * (lightness - amplitude * std::max(-1.0, std::min({k - 3.0, 9.0 - k, 1.0}))));
    };
    return {component(0.0), component(8.0), component(4.0), 1.0};
}

std::optional<CssColour> from_function(std::string_view text) {
    svg::Scanner scanner(text);
    const std::string_view name = scanner.word();
    if (name != "rgb" && name != "rgba" && name != "hsl" && name != "hsla") return std::nullopt;
    const std::vector<Argument> values = colour_arguments(scanner);
    if (values.empty()) return std::nullopt;
    CssColour colour;
    if (name.starts_with("rgb")) {
        const auto component = [&](std::size_t i) {
            return channel(values[i].percent ? values[i].value * 2.55 : values[i].value);
        };
        colour = {component(0), component(1), component(2), 1.0};
    } else {
        // A bare saturation or lightness is in percent as well (CSS Color 4).
        const auto share = [&](std::size_t i) { return std::clamp(values[i].value / 100.0, 0.0, 1.0); };
        const double turn = std::fmod(values[0].value, 360.0);
        colour = from_hsl(turn < 0.0 ? turn + 360.0 : turn, share(1), share(2));
    }
    if (values.size() == 4) colour.alpha = fraction(values[3]);
    return colour;
}

}  // namespace

std::optional<CssColour> parse_css_colour(std::string_view text) {
    const std::string lower = svg::lower_case(svg::trimmed(text));
    if (lower.starts_with('#')) return from_hex(std::string_view(lower).substr(1));
    if (lower == "transparent") return CssColour{0, 0, 0, 0.0};
    if (const std::optional<CssColour> colour = named(lower)) return colour;
    return from_function(lower);
}

std::string hex_colour(const CssColour& colour) {
    return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

}  // namespace ruche

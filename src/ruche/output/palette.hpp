#pragma once

#include <array>
#include <cmath>
#include <string>

namespace ruche {

/// A colour as screens and style sheets write it, each component 0 to 255.
struct Colour {
    std::array<unsigned char, 3> srgb;

    /// The same as amounts of light, 0 to 1 (IEC 61966-2-1).
    std::array<double, 3> linear() const {
        std::array<double, 3> result;
        for (int i = 0; i < 3; ++i) {
            const double c = srgb[i] / 255.0;
            result[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        }
        return result;
    }
};

/// "#rrggbb".
inline std::string css(const Colour& colour) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text = "#";
    for (const unsigned char part : colour.srgb) {
        text += digits[part >> 4U];
        text += digits[part & 15U];
    }
    return text;
}

/// The colours of everything that shows a result, so that a picture, a page and a viewer agree.
namespace palette {
inline constexpr Colour fabric{{244, 186, 82}};       // honey
inline constexpr Colour plastic_front{{56, 48, 52}};  // dark comb
inline constexpr Colour plastic_back{{38, 84, 96}};   // petrol
inline constexpr Colour paper{{246, 240, 231}};       // warm white
inline constexpr Colour ink{{66, 56, 50}};
inline constexpr Colour alarm{{196, 43, 32}};
}  // namespace palette

}  // namespace ruche

#include "ruche/output/colour_map.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "ruche/geometry/vectors.hpp"

namespace ruche {
namespace {

constexpr Colour grey{{150, 150, 150}};

/// Every 32nd of Viridis' 256 colours; between them it is straight in CIELAB within two levels of sRGB.
constexpr Colour viridis[] = {{{68, 1, 84}},    {{71, 45, 123}},  {{59, 82, 139}},
                              {{44, 114, 142}}, {{33, 145, 140}}, {{40, 174, 128}},
                              {{94, 201, 98}},  {{173, 220, 48}}, {{253, 231, 37}}};
constexpr Colour blue_to_rust[] = {{{10, 93, 168}}, {{240, 236, 230}}, {{168, 68, 10}}};

// CIELAB of 1976, of sRGB's white (D65).
constexpr double white[3] = {0.95047, 1.0, 1.08883};
constexpr double linear_below = 6.0 / 29.0;

Vec3 to_lab(const Colour& colour) {
    const auto rgb = colour.linear();
    const Vec3 light(rgb[0], rgb[1], rgb[2]);
    const Mat3 to_xyz{{0.4124564, 0.3575761, 0.1804375},
                      {0.2126729, 0.7151522, 0.0721750},
                      {0.0193339, 0.1191920, 0.9503041}};
    const Vec3 xyz = to_xyz * light;
    Vec3 f;
    for (int i = 0; i < 3; ++i) {
        const double t = xyz[i] / white[i];
        f[i] = t > linear_below * linear_below * linear_below
                   ? std::cbrt(t)
                   : t / (3.0 * linear_below * linear_below) + 4.0 / 29.0;
    }
    return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

Colour from_lab(const Vec3& lab) {
    const double middle = (lab[0] + 16.0) / 116.0;
    const Vec3 f(middle + lab[1] / 500.0, middle, middle - lab[2] / 200.0);
    Vec3 xyz;
    for (int i = 0; i < 3; ++i)
        xyz[i] = white[i] * (f[i] > linear_below ? f[i] * f[i] * f[i]
                                                 : 3.0 * linear_below * linear_below * (f[i] - 4.0 / 29.0));
    const Mat3 to_rgb{{3.2404542, -1.5371385, -0.4985314},
                      {-0.9692660, 1.8760108, 0.0415560},
                      {0.0556434, -0.2040259, 1.0572252}};
    const Vec3 light = to_rgb * xyz;
    Colour colour{};
    for (int i = 0; i < 3; ++i) {
        const double c =
            light[i] <= 0.0031308 ? 12.92 * light[i] : 1.055 * std::pow(light[i], 1.0 / 2.4) - 0.055;
        colour.srgb[i] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(c, 0.0, 1.0)));
    }
    return colour;
}

}  // namespace

Colour colour_at(ColourMap map, double t) {
    if (std::isnan(t)) return grey;
    const std::span<const Colour> stops = map == ColourMap::sequential
                                              ? std::span<const Colour>(viridis)
                                              : std::span<const Colour>(blue_to_rust);
    const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    const double part = at - static_cast<double>(below);
    const Vec3 from = to_lab(stops[below]), to = to_lab(stops[below + 1]);
    return from_lab(from + part * (to - from));
}

}  // namespace ruche

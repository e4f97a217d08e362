#include "ruche/output/colour_map.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace ruche;

namespace {

/// Relative luminance (IEC 61966-2-1): what remains of a colour for who sees none, and in a grey print.
double luminance(const Colour& colour) {
    const auto rgb = colour.linear();
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

}  // namespace

TEST_CASE("colour map: the sequential one grows lighter all the way") {
    double before = -1.0;
    for (int i = 0; i <= 64; ++i) {
        const double now = luminance(colour_at(ColourMap::sequential, i / 64.0));
        CHECK(now > before);
        before = now;
    }
}

TEST_CASE("colour map: the diverging one is palest in its middle and weighs both ends the same") {
    CHECK(luminance(colour_at(ColourMap::diverging, 0.5)) > 0.8);
    // 8 of 255 levels of lightness are not seen apart.
    for (const double t : {0.0, 0.2, 0.4})
        CHECK(std::cbrt(luminance(colour_at(ColourMap::diverging, t))) ==
              doctest::Approx(std::cbrt(luminance(colour_at(ColourMap::diverging, 1.0 - t)))).epsilon(0.04));
}

TEST_CASE("colour map: stops are met exactly, what is beyond takes the end, no number is grey") {
    CHECK(colour_at(ColourMap::sequential, 0.0).srgb == std::array<unsigned char, 3>{68, 1, 84});
    CHECK(colour_at(ColourMap::sequential, 0.5).srgb == std::array<unsigned char, 3>{33, 145, 140});
    CHECK(colour_at(ColourMap::sequential, 7.0).srgb == colour_at(ColourMap::sequential, 1.0).srgb);
    CHECK(colour_at(ColourMap::diverging, std::nan("")).srgb == std::array<unsigned char, 3>{150, 150, 150});
}

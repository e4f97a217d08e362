#include "ruche/output/portrait.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "output/sample_results.hpp"
#include "ruche/core/error.hpp"
#include "ruche/output/animation.hpp"

using namespace ruche;

namespace {

constexpr PortraitOptions small_portrait = {.width_px = 96, .height_px = 80};

int unlike(const Image& a, const Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) count += std::abs(a.rgb[i] - b.rgb[i]) > 12 ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("portrait: transparent is clear in the corners and opaque on the sheet") {
    PortraitOptions options = small_portrait;
    options.transparent = true;
    const Image image = Portrait(sample::half_torus(11), options).released();
    REQUIRE(image.alpha.size() == 96U * 80U);
    CHECK(image.alpha.front() == 0);
    CHECK(image.alpha.back() == 0);
    int opaque = 0;
    for (const unsigned char a : image.alpha) opaque += a == 255 ? 1 : 0;
    CHECK(opaque > 900);
    CHECK(opaque < 96 * 80 / 2);
    CHECK(Portrait(sample::half_torus(11), small_portrait).released().alpha.empty());
}

TEST_CASE("portrait: the whole sheet is inside, from every side") {
    const Result result = sample::rolled_sheet();
    PortraitOptions options = small_portrait;
    options.transparent = true;
    const Portrait portrait(result, options);
    for (const double turn : {0.0, 60.0, 135.0}) {
        const Image image = portrait.released(turn);
        for (int x = 0; x < image.width; ++x) {
            CHECK(image.alpha[x] < 255);
            CHECK(image.alpha[image.alpha.size() - 1 - x] < 255);
        }
    }
}

TEST_CASE("portrait: walking around, looking from above and colouring each change it") {
    const Result result = sample::rolled_sheet();
    const Image usual = Portrait(result, small_portrait).released();
    CHECK(unlike(usual, Portrait(result, small_portrait).released(90.0)) > 500);
    PortraitOptions above = small_portrait;
    above.elevation_deg = 89.9;
    CHECK(unlike(usual, Portrait(result, above).released()) > 500);
    PortraitOptions coloured = small_portrait;
    coloured.colour = "mean_curvature_per_mm";
    CHECK(unlike(usual, Portrait(result, coloured).released()) > 500);
    coloured.colour = "mean_curvatur_per_mm";
    CHECK_THROWS_WITH_AS(Portrait(result, coloured), doctest::Contains("did you mean mean_curvature_per_mm"),
                         InputError);
}

TEST_CASE("animation: a WebP with a frame for each picture") {
    Animation film(AnimationKind::webp, 96, 80);
    const Result result = sample::rolled_sheet();
    const Portrait portrait(result, small_portrait);
    for (const double turn : {0.0, 40.0, 80.0}) film.add(portrait.released(turn), 50);
    const std::string bytes = film.file();
    CHECK(bytes.starts_with("RIFF"));
    CHECK(bytes.substr(8, 8) == "WEBPVP8X");
    int frames = 0;
    for (std::size_t at = bytes.find("ANMF"); at != std::string::npos; at = bytes.find("ANMF", at + 4))
        ++frames;
    CHECK(frames == 3);
}

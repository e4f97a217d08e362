#include "ruche/output/picture.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>

#include "output/sample_results.hpp"
#include "ruche/core/parallel.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/output/stroke_font.hpp"

using namespace ruche;

namespace {

constexpr PictureOptions small = {.width_px = 160, .height_px = 120};

/// Pixels of columns [left, right) that are strongly of the fabric's hue.
int fabric_pixels(const Image& image, int left, int right) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = left; x < right; ++x) {
            const unsigned char* p = &image.rgb[3 * (y * image.width + x)];
            if (p[0] > p[2] + 60 && p[1] > p[2] + 20) ++count;
        }
    return count;
}

int dark_pixels(const Image& image, int left, int right) {
    int count = 0;
    // Without the caption and the scale bars.
    for (int y = image.height * 16 / 100; y < image.height * 84 / 100; ++y)
        for (int x = left; x < right; ++x)
            if (image.rgb[3 * (y * image.width + x)] < 110) ++count;
    return count;
}

int alarm_pixels(const Image& image) {
    int count = 0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
        if (image.rgb[i] > 180 && image.rgb[i + 1] < 70 && image.rgb[i + 2] < 60) ++count;
    return count;
}

}  // namespace

TEST_CASE("picture: drawing on the left and shape on the right, both with fabric and plastic") {
    const Image image = draw_picture(sample::half_torus(11), small);
    REQUIRE(image.rgb.size() == 3U * 160 * 120);
    CHECK(fabric_pixels(image, 0, 61) > 300);
    CHECK(fabric_pixels(image, 62, 160) > 300);
    CHECK(dark_pixels(image, 62, 160) > 300);
    CHECK(dark_pixels(draw_picture(sample::rolled_sheet(), small), 0, 61) > 50);
    // The corners are paper.
    CHECK(image.rgb[0] > 220);
    CHECK(image.rgb[3 * 159] > 220);
}

TEST_CASE("picture: same bits at any thread count") {
    const Result result = sample::rolled_sheet();
    const int before = thread_count();
    set_thread_count(1);
    const Image one = draw_picture(result, small);
    set_thread_count(3);
    const Image three = draw_picture(result, small);
    set_thread_count(before);
    CHECK(one.rgb == three.rgb);
}

TEST_CASE("picture: a red mark when not converged or not stable, and none otherwise") {
    Result result = sample::rolled_sheet();
    CHECK(alarm_pixels(draw_picture(result, small)) == 0);
    result.equilibrium.stable = false;
    CHECK(alarm_pixels(draw_picture(result, small)) > 30);
    result.equilibrium.status = SolveStatus::not_converged;
    CHECK(alarm_pixels(draw_picture(result, small)) > 30);
}

TEST_CASE("picture: what passes through itself is not shown as fabric or plastic, and there is a red mark") {
    Result result = sample::rolled_sheet();
    const int usual = fabric_pixels(draw_picture(result, small), 0, 160);
    for (int t = 1; t < result.layout.mesh.triangle_count(); ++t)
        result.self_intersections.push_back({{t - 1, t}, Vec3::Zero()});
    const Image image = draw_picture(result, small);
    CHECK(fabric_pixels(image, 0, 160) < usual / 10);
    CHECK(alarm_pixels(image) > 30);
}

TEST_CASE("picture: the shape fills its part of the picture whatever its size and place") {
    for (const double size : {1e-3, 1.0, 1e4}) {
        Result result = sample::rolled_sheet();
        for (Vec3& p : result.shape) p = size * (p + Vec3(100, -50, 20));
        for (Vec2& v : result.layout.mesh.vertices) v *= size;
        for (Print& p : result.layout.print) p = {.front = p.front * size, .back = p.back * size};
        result.scene.material.fabric_thickness *= size;
        const Image image = draw_picture(result, small);
        CHECK(fabric_pixels(image, 62, 160) + dark_pixels(image, 62, 160) > 1500);
    }
}

TEST_CASE("picture: positions that are not finite, no area and no triangles do not crash") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Result some = sample::rolled_sheet();
    some.shape[40].x() = nan;
    some.shape[41].y() = std::numeric_limits<double>::infinity();
    CHECK(fabric_pixels(draw_picture(some, small), 62, 160) > 300);
    Result all = sample::rolled_sheet();
    for (Vec3& p : all.shape) p = Vec3::Constant(nan);
    CHECK(fabric_pixels(draw_picture(all, small), 0, 61) > 300);
    CHECK(fabric_pixels(draw_picture(all, small), 62, 160) == 0);
    for (Vec3& p : all.shape) p = Vec3::Zero();
    CHECK(draw_picture(all, small).width == 160);
    CHECK(draw_picture(Result{}, {.width_px = 1, .height_px = 1}).width == 64);
}

TEST_CASE("picture: a long strip, print on one or both sides and a portrait format are drawn") {
    const auto everywhere = [](const Vec2& p) { return p.y() < 0.5; };
    const Result strip = sample::result(sample::grid({.width = 300, .height = 1, .nx = 300, .ny = 2}),
                                        {{"s", everywhere, {.front = 0.4, .back = 0.4}}},
                                        [](const Vec2& p) { return Vec3(p.x(), p.y(), 0); });
    const Image image = draw_picture(strip, {.width_px = 120, .height_px = 200});
    CHECK(image.rgb.size() == 3U * 120 * 200);
}

TEST_CASE("png: header, size and end are those of a PNG file") {
    const std::string file = to_png({2, 1, {255, 0, 0, 0, 0, 255}});
    CHECK(file.starts_with("\x89PNG\r\n\x1a\n"));
    CHECK(file.substr(16, 8) == std::string("\0\0\0\2\0\0\0\1", 8));
    CHECK(file.find("IEND") != std::string::npos);
}

TEST_CASE("stroke font: every printable ASCII and Latin-1 letter is drawn, broken text becomes boxes") {
    const std::size_t box = write_text("\x01").strokes[0].size();
    for (char c = '!'; c <= '~'; ++c) {
        const WrittenText text = write_text(std::string(1, c));
        CAPTURE(c);
        CHECK(!text.strokes.empty());
        CHECK(text.width > 0.0);
        for (const auto& stroke : text.strokes)
            for (const Vec2& p : stroke) {
                CHECK(p.x() > -0.2);
                CHECK(p.x() < text.width + 0.2);
                CHECK(p.y() > -0.45);
                CHECK(p.y() < 1.2);
            }
    }
    CHECK(write_text("ä").strokes.size() == write_text("a").strokes.size() + 2);
    CHECK(write_text("Ç").strokes.size() == write_text("C").strokes.size() + 1);
    CHECK(write_text("\xC3").strokes[0].size() == box);
    CHECK(write_text("\xE6\x97\xA5").strokes.size() == 1);
    CHECK(write_text("a b").width > write_text("ab").width);
    CHECK(write_text("").width == 0.0);
}

#include "ruche/study/silhouette/silhouette_comparison.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

// After <cstdio>, which it does not include itself.
#include <jpeglib.h>

#include "output/sample_results.hpp"
#include "ruche/core/error.hpp"
#include "ruche/study/scan/skin.hpp"
#include "ruche/study/silhouette/photo.hpp"
#include "temporary_file.hpp"

using namespace ruche;
using ruche::test::TemporaryFile;

namespace {

/// A photo of something dark before a light background that is brighter on the right; `covers` says how much
/// of the place is covered, and is asked at 4 x 4 places of a pixel. Noise of so many levels.
struct PhotoOf {
    int width = 600;
    int height = 500;
    double noise = 3.0;
    unsigned seed = 1;
};
template <class Covers>
Image photo_of(const Covers& covers, const PhotoOf& how = {}) {
    std::mt19937 random(how.seed);
    const auto roll = [&] { return static_cast<double>(random()) * 0x1p-32; };
    Image image{.width = how.width, .height = how.height};
    for (int y = 0; y < how.height; ++y)
        for (int x = 0; x < how.width; ++x) {
            double cover = 0.0;
            for (int k = 0; k < 16; ++k)
                cover +=
                    covers(Vec2(x - 0.375 + 0.25 * (k % 4), y - 0.375 + 0.25 * (k / 4))) ? 1.0 / 16 : 0.0;
            const double light = 190.0 + 50.0 * x / how.width;
            for (const double dark : {60.0, 50.0, 55.0}) {
                // Twelve evenly distributed numbers make nearly a normal one.
                double noise = -6.0;
                for (int k = 0; k < 12; ++k) noise += roll();
                const double value = light + cover * (dark - light) + how.noise * noise;
                image.rgb.push_back(static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0))));
            }
        }
    return image;
}

auto disc(const Vec2& centre, double radius) {
    return [=](const Vec2& p) { return (p - centre).norm() < radius; };
}

OutlineCircle outline_of(const Image& photo, const std::optional<PixelBox>& box = {}) {
    return fit_outline_circle(find_foreground(photo, box, "photo"), "photo");
}

std::string message_of(const auto& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was refused";
}

/// A strip of 40 x 4 mm, printed on its front, around a cylinder whose axis is the layout's y.
Result roll_of(double radius) {
    return sample::result(sample::grid({.width = 40, .height = 4, .nx = 160, .ny = 4}),
                          {{"a", [](const Vec2&) { return true; }, {.front = 0.6}}}, [radius](const Vec2& p) {
                              const double angle = p.x() / radius;
                              return Vec3(radius * std::sin(angle), p.y(), radius * std::cos(angle));
                          });
}

double across(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

bool in_triangle(const Vec2& p, const std::array<Vec2, 3>& t) {
    const double a = across(t[1] - t[0], p - t[0]);
    const double b = across(t[2] - t[1], p - t[1]);
    const double c = across(t[0] - t[2], p - t[2]);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// A photo of a result along y from afar: what lies between its skins. `mm_per_px`, the z axis upwards.
Image front_view(const Result& result, double mm_per_px, const PhotoOf& how = {}) {
    const SurfaceFields fields = surface_fields(result);
    const std::vector<Corners> front = front_skin(result, fields);
    const std::vector<Corners> back = back_skin(result, fields);
    const auto pixel = [&](const Vec3& p) {
        return Vec2(0.5 * how.width + p.x() / mm_per_px, 0.5 * how.height - p.z() / mm_per_px);
    };
    constexpr int fine = 4;
    const int columns = fine * how.width;
    std::vector<char> covered(static_cast<std::size_t>(columns) * fine * how.height, 0);
    const auto fill = [&](const std::array<Vec2, 3>& t) {
        Vec2 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
        Vec2 high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
        // The middle of small square i lies at (i + 0.5) / fine - 0.5.
        for (int y = static_cast<int>(fine * low.y()); y <= static_cast<int>(fine * (high.y() + 1)); ++y)
            for (int x = static_cast<int>(fine * low.x()); x <= static_cast<int>(fine * (high.x() + 1)); ++x)
                if (in_triangle(Vec2((x + 0.5) / fine - 0.5, (y + 0.5) / fine - 0.5), t))
                    covered[static_cast<std::size_t>(y) * columns + x] = 1;
    };
    for (std::size_t t = 0; t < front.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            fill({pixel(front[t][k]), pixel(front[t][next]), pixel(back[t][k])});
            fill({pixel(front[t][next]), pixel(back[t][next]), pixel(back[t][k])});
        }
    return photo_of(
        [&](const Vec2& p) {
            const int x = static_cast<int>(fine * (p.x() + 0.5));
            const int y = static_cast<int>(fine * (p.y() + 0.5));
            return x >= 0 && y >= 0 && x < columns && y < fine * how.height &&
                   covered[static_cast<std::size_t>(y) * columns + x] != 0;
        },
        how);
}

std::string to_jpeg(const Image& image) {
    jpeg_compress_struct state = {};
    jpeg_error_mgr errors = {};
    state.err = jpeg_std_error(&errors);
    jpeg_create_compress(&state);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&state, &bytes, &size);
    state.image_width = static_cast<JDIMENSION>(image.width);
    state.image_height = static_cast<JDIMENSION>(image.height);
    state.input_components = 3;
    state.in_color_space = JCS_RGB;
    jpeg_set_defaults(&state);
    jpeg_set_quality(&state, 85, TRUE);
    jpeg_start_compress(&state, TRUE);
    std::vector<unsigned char> pixels = image.rgb;
    while (state.next_scanline < state.image_height) {
        JSAMPROW row = pixels.data() + 3 * static_cast<std::size_t>(state.next_scanline) * image.width;
        jpeg_write_scanlines(&state, &row, 1);
    }
    jpeg_finish_compress(&state);
    const std::string file(reinterpret_cast<char*>(bytes), size);
    jpeg_destroy_compress(&state);
    std::free(bytes);
    return file;
}

const SilhouetteOptions scale_of_tenth_mm = {.known_length_mm = 40.0,
                                             .known_length_at_px = {30, 20, 430, 20}};

}  // namespace

TEST_CASE("silhouette: a disc's circle is found to a tenth of a pixel under uneven light and noise") {
    const OutlineCircle found = outline_of(photo_of(disc({281.3, 247.8}, 152.6), {.noise = 6.0}));
    CHECK((found.centre - Vec2(281.3, 247.8)).norm() < 0.1);
    CHECK(std::abs(found.radius - 152.6) < 0.1);
    CHECK(found.rms < 0.5);
    CHECK(found.arc_deg == doctest::Approx(360.0).epsilon(0.01));
    CHECK(found.followed > 0.98);
}

TEST_CASE("silhouette: of an open roll only the outer side counts, not ends, inside, or a ruler beside it") {
    const Vec2 centre(300, 260);
    const auto roll = [&](const Vec2& p) {
        const Vec2 at = p - centre;
        const double angle = std::atan2(at.y(), at.x());
        const bool band = at.norm() > 118 && at.norm() < 130 && std::abs(angle) > 0.7;
        // Something seen through the opening hangs on to the band inside.
        const bool flap = std::abs(at.y() - 20) < 5 && at.x() < 60 && at.x() > -125;
        const bool ruler = p.y() > 440 && p.y() < 452 && p.x() > 40 && p.x() < 560;
        return band || flap || ruler;
    };
    const OutlineCircle found = outline_of(photo_of(roll));
    CHECK((found.centre - centre).norm() < 0.15);
    CHECK(std::abs(found.radius - 130.0) < 0.15);
    CHECK(found.arc_deg == doctest::Approx((2.0 * M_PI - 1.4) * 180.0 / M_PI).epsilon(0.03));
}

TEST_CASE("silhouette: a shallow arc has its circle outside of the picture") {
    const Vec2 centre(300, 900);
    const auto arc = [&](const Vec2& p) {
        const double r = (p - centre).norm();
        return r > 688 && r < 700 && std::abs(p.x() - 300) < 250;
    };
    const OutlineCircle found = outline_of(photo_of(arc));
    CHECK(found.radius == doctest::Approx(700.0).epsilon(0.005));
}

TEST_CASE("silhouette: the error that is said is the error that is made") {
    // Outlines with bumps of two pixels that are a few degrees wide: a hundred times more points than bumps.
    double squares = 0.0;
    constexpr int photos = 60;
    for (unsigned seed = 1; seed <= photos; ++seed) {
        std::mt19937 random(seed);
        std::vector<double> bumps(60);
        for (double& b : bumps) b = 4.0 * static_cast<double>(random()) * 0x1p-32 - 2.0;
        const auto bumpy = [&](const Vec2& p) {
            const Vec2 at = p - Vec2(80, 70);
            const double turn = (std::atan2(at.y(), at.x()) / (2.0 * M_PI) + 0.5) * 60.0;
            const auto i = static_cast<std::size_t>(turn);
            const double share = turn - std::floor(turn);
            return at.norm() < 50.0 + (1.0 - share) * bumps[i % 60] + share * bumps[(i + 1) % 60];
        };
        const OutlineCircle found = outline_of(photo_of(bumpy, {.width = 160, .height = 140, .seed = seed}));
        const double error = (found.radius - 50.0) / 50.0;
        squares += error * error / (found.fit_error * found.fit_error) / photos;
    }
    // An error over one that is estimated from ten parts follows Student's distribution with nine degrees of
    // freedom: its square is 9/7 on average with a deviation of 2.3, the mean of 60 within 0.5 and 2.1 in 99
    // of 100 such sets.
    CHECK(squares > 0.5);
    CHECK(squares < 2.1);
}

TEST_CASE("silhouette: a rolled result photographed from its front agrees with its own circle") {
    const Result result = roll_of(9.0);
    const Image photo = front_view(result, 0.05);
    const SilhouetteComparison found =
        compare_with_photo(result, surface_fields(result), photo,
                           {.known_length_mm = 20.0, .known_length_at_px = {30, 20, 430, 20}}, "photo");
    CHECK(found.mm_per_px == doctest::Approx(0.05));
    // The print lies outside, on the front: 0.6 mm further out than the reference surface.
    CHECK(found.result_curvature == doctest::Approx(1.0 / 9.0).epsilon(1e-4));
    CHECK(found.result_outline_curvature == doctest::Approx(1.0 / 9.6).epsilon(1e-3));
    CHECK(std::abs(found.difference()) < 2e-3);
    // Nothing but the scale is uncertain: a pixel at either end of 400.
    CHECK(found.uncertainty / found.curvature == doctest::Approx(std::sqrt(2.0) / 400.0).epsilon(0.3));
    CHECK(found.warnings.empty());
    // Bent more than simulated: a positive difference.
    const SilhouetteComparison tighter =
        compare_with_photo(roll_of(10.0), surface_fields(roll_of(10.0)), photo,
                           {.known_length_mm = 20.0, .known_length_at_px = {30, 20, 430, 20}}, "photo");
    CHECK(tighter.difference() == doctest::Approx(10.6 / 9.6 - 1.0).epsilon(0.05));
}

TEST_CASE("silhouette: the photo may look along any direction of the layout") {
    Result result = roll_of(9.0);
    for (Vec2& p : result.layout.mesh.vertices) p = Vec2(-p.y(), p.x());  // a quarter turn
    const SilhouetteComparison found = compare_with_photo(
        result, surface_fields(result), front_view(result, 0.05),
        {.known_length_mm = 20.0, .known_length_at_px = {30, 20, 430, 20}, .seen_along_deg = 180.0}, "photo");
    CHECK(std::abs(found.difference()) < 2e-3);
}

TEST_CASE("silhouette: PNG and JPEG are read, what is broken is refused") {
    const Image photo = photo_of(disc({60, 50}, 30), {.width = 120, .height = 100});
    const TemporaryFile png(to_png(photo), "silhouette.png");
    CHECK(is_photo(png.path()));
    CHECK(read_photo(png.path()).rgb == photo.rgb);
    const std::string packed = to_jpeg(photo);
    const TemporaryFile jpeg(packed, "silhouette.jpg");
    CHECK(is_photo(jpeg.path()));
    const Image read = read_photo(jpeg.path());
    REQUIRE(read.rgb.size() == photo.rgb.size());
    CHECK(std::abs(outline_of(read).radius - 30.0) < 0.2);
    const TemporaryFile half(packed.substr(0, packed.size() / 2), "silhouette-half.jpg");
    CHECK(message_of([&] { (void)read_photo(half.path()); }).find("not a complete JPEG") !=
          std::string::npos);
    const TemporaryFile cut(to_png(photo).substr(0, 200), "silhouette-cut.png");
    CHECK(message_of([&] { (void)read_photo(cut.path()); }).find("not a complete PNG") != std::string::npos);
    const TemporaryFile text("ruche", "silhouette.txt");
    CHECK_FALSE(is_photo(text.path()));
    CHECK_FALSE(is_photo("no such file"));
}

TEST_CASE(
    "silhouette: without a scale, before an empty background or over the border there is no comparison") {
    const Result result = roll_of(9.0);
    const SurfaceFields fields = surface_fields(result);
    const auto refused = [&](const Image& photo, const SilhouetteOptions& options) {
        return message_of([&] { (void)compare_with_photo(result, fields, photo, options, "photo.png"); });
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    const Image good = photo_of(disc({300, 250}, 100));
    CHECK(has(refused(good, {}), "--known-length-mm: is missing"));
    CHECK(has(refused(good, {.known_length_mm = 40.0}), "needs X1,Y1,X2,Y2"));
    CHECK(has(refused(good, {.known_length_mm = 40.0, .known_length_at_px = {1, 1, 2, 2}}), "pixels apart"));
    CHECK(has(refused(photo_of([](const Vec2&) { return false; }), scale_of_tenth_mm), "stands out"));
    CHECK(has(refused(photo_of(disc({300, 250}, 5)), scale_of_tenth_mm), "nothing larger than"));
    CHECK(has(refused(photo_of(disc({80, 250}, 100)), scale_of_tenth_mm), "touches the border of the photo"));
    SilhouetteOptions boxed = scale_of_tenth_mm;
    boxed.box = PixelBox{250, 100, 200, 300};
    CHECK(has(refused(good, boxed), "touches the border of the box"));
    boxed.box = PixelBox{500, 400, 200, 200};
    CHECK(has(refused(good, boxed), "not a part of the photo"));
    const auto bar = [](const Vec2& p) { return p.x() > 100 && p.x() < 500 && std::abs(p.y() - 250) < 6; };
    CHECK(has(refused(photo_of(bar), scale_of_tenth_mm), "bends nowhere"));
}

TEST_CASE("silhouette: a box leaves out what is larger than the sheet") {
    const auto scene = [](const Vec2& p) { return disc({200, 200}, 80)(p) || (p.x() > 400 && p.y() > 20); };
    const OutlineCircle found = outline_of(photo_of(scene), PixelBox{90, 90, 220, 220});
    CHECK((found.centre - Vec2(200, 200)).norm() < 0.1);
    CHECK(std::abs(found.radius - 80.0) < 0.1);
}

TEST_CASE("silhouette: the picture of what was found shows both circles") {
    const Result result = roll_of(9.0);
    const Image photo = front_view(result, 0.05);
    const Image drawn = annotated(
        photo, compare_with_photo(result, surface_fields(result), photo, scale_of_tenth_mm, "photo"));
    REQUIRE(drawn.rgb.size() == photo.rgb.size());
    int orange = 0;
    int blue = 0;
    for (std::size_t i = 0; i < drawn.rgb.size(); i += 3) {
        orange += drawn.rgb[i] > 220 && drawn.rgb[i + 2] < 60 ? 1 : 0;
        blue += drawn.rgb[i] < 20 && drawn.rgb[i + 2] > 160 ? 1 : 0;
    }
    CHECK(orange > 500);
    CHECK(blue > 200);  // half as large here: the scale is another one
}

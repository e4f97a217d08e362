#include "ruche/output/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ruche/core/atomic_file.hpp"
#include "ruche/output/caption.hpp"
#include "ruche/output/develop.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/output/pen.hpp"
#include "ruche/output/render.hpp"

namespace ruche {
namespace {

constexpr int smallest_side = 64;
constexpr int largest_side = 16384;

/// Where things are on the picture, pixels.
struct Composition {
    int width, height;
    float unit;   ///< a hundredth of the picture's height (of a landscape picture)
    float split;  ///< column between drawing and shape
    Frame drawing, shape;
};

Composition compose(const PictureOptions& options) {
    Composition c;
    c.width = std::clamp(options.width_px, smallest_side, largest_side);
    c.height = std::clamp(options.height_px, smallest_side, largest_side);
    const auto w = static_cast<float>(c.width), h = static_cast<float>(c.height);
    c.unit = std::min(h, 0.75F * w) / 100.0F;
    c.split = std::round(0.385F * w);
    const float top = 16.0F * c.unit, bottom = h - 18.0F * c.unit;
    c.drawing = {5.0F * c.unit, top, c.split - 3.0F * c.unit, bottom};
    c.shape = {c.split + 4.0F * c.unit, top, w - 9.0F * c.unit, bottom};
    return c;
}

struct Panel {
    Stage stage;
    Camera camera;
    float pixels_per_mm = 1.0F;  ///< in the middle of the sheet
};

Panel make_panel(Stage stage, float elevation_deg, float distance, const Frame& frame) {
    Panel panel{.stage = std::move(stage), .camera = {}};
    panel.camera = fit_camera(panel.stage.outline, elevation_deg, distance, frame);
    panel.pixels_per_mm = panel.camera.focal / distance * panel.stage.per_mm;
    return panel;
}

std::optional<Panel> drawing_panel(const Result& result, const Composition& c) {
    std::vector<Vec3> flat;
    flat.reserve(result.layout.mesh.vertices.size());
    for (const Vec2& v : result.layout.mesh.vertices) flat.emplace_back(v.x(), v.y(), 0.0);
    Stage stage = make_stage(result, flat, place_flat(flat, result.layout.mesh.triangles));
    if (stage.outline.empty()) return {};
    stage.ground -= 0.02F;
    return make_panel(std::move(stage), 90.0F, 40.0F, c.drawing);
}

std::optional<Panel> shape_panel(const Result& result, const Composition& c) {
    const View view = choose_view(result);
    Stage stage = make_stage(result, result.shape, view.placement);
    if (stage.outline.empty()) return {};
    return make_panel(std::move(stage), view.elevation_deg, 7.0F, c.shape);
}

/// The longest round length, mm, whose bar is not longer than `room` pixels.
double round_length(double pixels_per_mm, double room) {
    const double longest = room / pixels_per_mm;
    const double decade = std::pow(10.0, std::floor(std::log10(longest)));
    for (const double digit : {5.0, 2.0})
        if (digit * decade <= longest) return digit * decade;
    return decade;
}

void draw_scale_bar(Image& image, const Composition& c, const Panel& panel, const Frame& frame,
                    const char* label) {
    const double room = 0.3 * (frame.right - frame.left);
    const double length = round_length(panel.pixels_per_mm, room);
    const double half = 0.5 * length * panel.pixels_per_mm;
    const double x = 0.5 * (frame.left + frame.right), y = c.height - 8.6 * c.unit, tick = 0.55 * c.unit;
    Pen pen(image, palette::ink);
    pen.lines({{{x - half, y}, {x + half, y}},
               {{x - half, y - tick}, {x - half, y + tick}},
               {{x + half, y - tick}, {x + half, y + tick}}},
              0.22 * c.unit);
    pen.text(fmt::format("{:g} mm", length), {x, y - 1.4 * c.unit},
             {.cap_height = 1.35 * c.unit, .anchor = Pen::Anchor::centre});
    pen.text(label, {x, y + 3.6 * c.unit}, {.cap_height = 1.35 * c.unit, .anchor = Pen::Anchor::centre});
}

void draw_caption(Image& image, const Composition& c, const Caption& caption) {
    Pen pen(image, palette::ink);
    const double left = 5.0 * c.unit;
    double mark_width = 0.0;
    if (!caption.alarm.empty()) {
        const double cap = 1.7 * c.unit;
        mark_width = text_width(caption.alarm, cap) + 3.2 * c.unit;
        const Vec2 corner(c.width - 5.0 * c.unit, 4.2 * c.unit);
        Pen(image, palette::alarm)
            .rounded_box({corner.x() - mark_width, corner.y()}, {corner.x(), corner.y() + 4.4 * c.unit},
                         0.8 * c.unit);
        Pen(image, palette::paper)
            .text(caption.alarm, {corner.x() - 1.6 * c.unit, corner.y() + 3.05 * c.unit},
                  {.cap_height = cap, .weight = 0.15, .anchor = Pen::Anchor::right});
    }
    const double room = c.width - 2.0 * left - mark_width - 2.0 * c.unit;
    const auto fitting = [&](const std::string& text, double cap) {
        return cap * std::min(1.0, room / std::max(1.0, text_width(text, cap)));
    };
    pen.text(caption.title, {left, 7.4 * c.unit},
             {.cap_height = fitting(caption.title, 2.7 * c.unit), .weight = 0.125});
    pen.text(caption.details, {left, 11.2 * c.unit},
             {.cap_height = fitting(caption.details, 1.45 * c.unit), .weight = 0.11});
}

}  // namespace

Image draw_picture(const Result& result, const PictureOptions& options) {
    const Composition c = compose(options);
    const std::vector<Vec3f> ground = backdrop(c.width, c.height, {0.52F, 0.45F});
    Film film(c.width, c.height);
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        film.pixels[i].albedo = ground[i];
        film.pixels[i].light = Vec3f::Ones();
    }
    const auto split = static_cast<int>(c.split);
    const std::optional<Panel> drawing = drawing_panel(result, c), shape = shape_panel(result, c);
    const auto shoot = [&](const std::optional<Panel>& panel, int left, int right) {
        if (!panel) return;
        for (int y = 0; y < film.height; ++y)
            for (int x = left; x < right; ++x) film.at(x, y) = FilmPixel{};
        expose(film, {.stage = &panel->stage, .camera = panel->camera, .left = left, .right = right}, ground);
    };
    shoot(drawing, 0, split);
    shoot(shape, split, c.width);
    develop_light(film, 0.01F);
    if (drawing) fade_borders(film, {.left = 0, .right = split, .reach = 8.0F * c.unit});
    if (shape) fade_borders(film, {.left = split, .right = c.width, .reach = 12.0F * c.unit});
    Image image = print(film);
    if (drawing) draw_scale_bar(image, c, *drawing, c.drawing, "printed flat on stretched fabric");
    if (shape) draw_scale_bar(image, c, *shape, c.shape, "released");
    draw_caption(image, c, make_caption(result, options.title));
    return image;
}

void write_picture(const Result& result, const std::string& path, const PictureOptions& options) {
    write_file_atomically(path, to_png(draw_picture(result, options)));
}

}  // namespace ruche

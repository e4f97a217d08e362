#include "ruche/output/portrait.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ruche/output/develop.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/output/pen.hpp"
#include "ruche/output/render.hpp"
#include "ruche/output/stage.hpp"

namespace ruche {
namespace {

constexpr float distance = 7.0F;  ///< of the camera, in radii of the shape

struct Box {
    Vec3 low = Vec3::Constant(1e300);
    Vec3 high = Vec3::Constant(-1e300);
    Vec3 middle() const { return 0.5 * (low + high); }
};

Box box_of(const std::vector<Vec3>& points, const Mat3& rotation) {
    Box box;
    for (const Vec3& p : points) {
        box.low = box.low.cwiseMin(rotation * p);
        box.high = box.high.cwiseMax(rotation * p);
    }
    return box;
}

Mat3 about_z(double degrees) {
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vec3::UnitZ()).toRotationMatrix();
}

std::vector<Vec3f> tints(const ColourField& field) {
    std::vector<Vec3f> list;
    list.reserve(field.values.size());
    for (const double v : field.values) {
        const auto rgb = field.colour(v).linear();
        list.emplace_back(static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]));
    }
    return list;
}

/// The camera of all pictures: a ball of radius 1 fills the frame.
Camera camera_of(const PortraitOptions& options, float elevation_deg) {
    const auto w = static_cast<float>(options.width_px), h = static_cast<float>(options.height_px);
    const float margin = 0.05F * std::min(w, h);
    Camera camera = fit_camera({}, elevation_deg, distance, {});
    // Half the angle under which the ball is seen.
    const float tangent = 1.0F / std::sqrt(distance * distance - 1.0F);
    camera.focal = (0.5F * std::min(w, h) - margin) / tangent;
    camera.centre = {0.5F * w, 0.5F * h};
    return camera;
}

}  // namespace

Portrait::Portrait(const Result& result, PortraitOptions options, const std::vector<FilmFrame>& others)
    : result_(result), options_(std::move(options)), view_(choose_view(result)) {
    if (options_.elevation_deg) view_.elevation_deg = static_cast<float>(*options_.elevation_deg);
    if (!options_.colour.empty())
        field_ = colour_field(options_.colour, result, surface_fields(result, result.energy_density));
    const auto cover = [&](const std::vector<Vec3>& shape) {
        const Vec3 middle = box_of(shape, view_.placement.rotation).middle();
        for (const Vec3& p : shape)
            radius_ = std::max(radius_, (view_.placement.rotation * p - middle).norm());
    };
    radius_ = 1e-6;
    cover(result.shape);
    for (const FilmFrame& frame : others) cover(frame.shape);
}

Placement Portrait::placement(const std::vector<Vec3>& shape, double turn_deg) const {
    const Mat3& upright = view_.placement.rotation;
    Placement placement;
    placement.rotation = about_z(-options_.azimuth_deg - turn_deg) * upright;
    placement.middle = upright.transpose() * box_of(shape, upright).middle();
    placement.scale = 1.0 / radius_;
    return placement;
}

Image Portrait::take(const Result& result, const std::vector<Vec3>& shape, double turn_deg,
                     bool coloured) const {
    Stage stage = make_stage(result, shape, placement(shape, turn_deg));
    if (coloured && field_) stage.tint = tints(*field_);
    const int w = options_.width_px, h = options_.height_px;
    const std::vector<Vec3f> ground = options_.transparent
                                          ? std::vector<Vec3f>(static_cast<std::size_t>(w) * h, Vec3f::Zero())
                                          : backdrop(w, h, {0.5F, 0.45F});
    Film film(w, h);
    expose(film, {.stage = &stage, .camera = camera_of(options_, view_.elevation_deg), .left = 0, .right = w},
           ground);
    develop_light(film, 0.01F);
    fade_borders(film, {.left = 0, .right = w, .reach = 0.12F * static_cast<float>(std::min(w, h))});
    Image image = options_.transparent ? print_transparent(film) : print(film);
    if (coloured && field_ && !options_.transparent) draw_legend(image);
    return image;
}

Image Portrait::released(double turn_deg) const { return take(result_, result_.shape, turn_deg, true); }

Image Portrait::other(const PrintMesh& layout, const std::vector<Vec3>& shape) const {
    Result result;
    result.scene = result_.scene;
    result.layout = layout;
    result.shape = shape;
    return take(result, shape, 0.0, false);
}

void Portrait::draw_legend(Image& image) const {
    const double unit = 0.01 * std::min(image.width, image.height);
    const double width = 44.0 * unit, height = 2.2 * unit, left = 4.0 * unit, top = image.height - 9.0 * unit;
    constexpr int steps = 128;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps;
        Pen(image, colour_at(field_->map, t))
            .rounded_box({left + width * i / steps, top},
                         {left + width * (i + 1) / steps + 0.5, top + height}, 0.0);
    }
    Pen pen(image, palette::ink);
    const double cap = 1.7 * unit;
    const std::string unit_text = field_->unit.empty() ? "" : ", " + field_->unit;
    pen.text(field_->label + unit_text, {left, top - 1.4 * unit}, {.cap_height = cap});
    const auto mark = [&](double share, Pen::Anchor anchor) {
        const double value = field_->from + share * (field_->to - field_->from);
        pen.text(fmt::format("{:.3g}", value), {left + share * width, top + height + 3.0 * unit},
                 {.cap_height = cap, .anchor = anchor});
    };
    mark(0.0, Pen::Anchor::left);
    mark(0.5, Pen::Anchor::centre);
    mark(1.0, Pen::Anchor::right);
}

}  // namespace ruche

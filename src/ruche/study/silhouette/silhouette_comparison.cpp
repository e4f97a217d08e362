#include "ruche/study/silhouette/silhouette_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ruche/core/error.hpp"
#include "ruche/output/pen.hpp"
#include "ruche/study/scan/skin.hpp"
#include "ruche/study/validation/sheet_measures.hpp"

namespace ruche {
namespace {

constexpr Colour of_photo{{238, 119, 20}};  // the orange of the paper's circle
constexpr Colour of_result{{0, 114, 178}};
constexpr Colour of_points{{180, 20, 120}};

double known_length_px(const SilhouetteOptions& options) {
    constexpr const char* how =
        "A photo has no scale: lay a ruler beside the near rim of the roll, and say the length between two "
        "of its marks and where these are in the photo: --known-length-mm 50 --known-length-at "
        "120,80,932,85.";
    if (!(options.known_length_mm > 0.0))
        throw InputError({.key = "--known-length-mm"}, "is missing: a length in mm, larger than 0", how);
    if (options.known_length_at_px.size() != 4)
        throw InputError({.key = "--known-length-at"},
                         fmt::format("needs X1,Y1,X2,Y2, the pixels of both ends; got {} numbers",
                                     options.known_length_at_px.size()),
                         how);
    const std::vector<double>& at = options.known_length_at_px;
    const double length = std::hypot(at[2] - at[0], at[3] - at[1]);
    constexpr double shortest = 20.0;
    if (!(length >= shortest))
        throw InputError(
            {.key = "--known-length-at"},
            fmt::format("the ends are {:.3g} pixels apart, at least {} are needed", length, shortest),
            "A length as long as the roll is wide gives the best scale.");
    return length;
}

/// The released shape with its printed vertices on a skin.
std::vector<Vec3> on_skin(const Result& result, const std::vector<Corners>& skin) {
    std::vector<Vec3> shape = result.shape;
    for (std::size_t t = 0; t < skin.size(); ++t)
        if (!result.layout.print[t].bare())
            for (std::size_t k = 0; k < 3; ++k)
                shape[static_cast<std::size_t>(result.layout.mesh.triangles[t][k])] = skin[t][k];
    return shape;
}

std::vector<Vec2> circle_line(const Vec2& centre, double radius) {
    std::vector<Vec2> line;
    constexpr int pieces = 360;
    for (int i = 0; i <= pieces; ++i) {
        const double angle = 2.0 * M_PI * i / pieces;
        line.emplace_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    return line;
}

/// Every pixel the mean of `factor` x `factor`.
Image smaller(const Image& photo, int factor) {
    Image image{.width = photo.width / factor, .height = photo.height / factor};
    image.rgb.reserve(3 * static_cast<std::size_t>(image.width) * image.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                int sum = 0;
                for (int v = 0; v < factor; ++v)
                    for (int u = 0; u < factor; ++u)
                        sum += photo.rgb[3 * (static_cast<std::size_t>(y * factor + v) * photo.width +
                                              x * factor + u) +
                                         channel];
                image.rgb.push_back(static_cast<unsigned char>(sum / (factor * factor)));
            }
    return image;
}

void warn(SilhouetteComparison& comparison) {
    constexpr double most_of_it = 0.7;
    constexpr double shortest_arc = 60.0;
    const OutlineCircle& outline = comparison.outline;
    if (outline.followed < most_of_it)
        comparison.warnings.push_back(
            fmt::format("only {:.0f} % of the outline lies on one circle: look at silhouette.png",
                        100.0 * outline.followed));
    if (outline.arc_deg < shortest_arc)
        comparison.warnings.push_back(fmt::format(
            "the arc is short, {:.0f} degrees: its curvature depends on every bump", outline.arc_deg));
}

}  // namespace

SilhouetteComparison compare_with_photo(const Result& result, const SurfaceFields& fields, const Image& photo,
                                        const SilhouetteOptions& options, const std::string& file) {
    const double length_px = known_length_px(options);
    SilhouetteComparison found;
    found.mm_per_px = options.known_length_mm / length_px;
    constexpr double end_error_px = 1.0;  // of either end, as a person points at it
    found.scale_error = std::sqrt(2.0) * end_error_px / length_px;

    const double seen_along = options.seen_along_deg * M_PI / 180.0;
    const Vec2 along(std::cos(seen_along), std::sin(seen_along));
    found.result_curvature = silhouette_curvature(result.layout, result.shape, 1.0, along);
    // What is outside has the larger radius.
    found.result_outline_curvature =
        std::min(silhouette_curvature(result.layout, on_skin(result, front_skin(result, fields)), 1.0, along),
                 silhouette_curvature(result.layout, on_skin(result, back_skin(result, fields)), 1.0, along));
    if (!(found.result_outline_curvature > 0.0))
        throw InputError(
            {.key = "--seen-along-deg"},
            fmt::format("seen along {:g} degrees of the layout, the result's print has no circle",
                        options.seen_along_deg),
            "A sheet without print has none, nor has one that does not bend.");

    found.outline = fit_outline_circle(find_foreground(photo, options.box, file), file);
    found.curvature = 1.0 / (found.outline.radius * found.mm_per_px);
    found.uncertainty =
        found.curvature * std::hypot(found.outline.fit_error, found.outline.edge_error, found.scale_error);
    warn(found);
    return found;
}

std::string to_json(const SilhouetteComparison& comparison, const std::string& photo) {
    const OutlineCircle& outline = comparison.outline;
    nlohmann::ordered_json json;
    json["photo"] = photo;
    json["curvature_per_mm"] = comparison.curvature;
    json["uncertainty_per_mm"] = comparison.uncertainty;
    json["relative_errors"] = {
        {"fit", outline.fit_error}, {"edge", outline.edge_error}, {"scale", comparison.scale_error}};
    json["result_outline_curvature_per_mm"] = comparison.result_outline_curvature;
    json["result_curvature_per_mm"] = comparison.result_curvature;
    json["difference"] = comparison.difference();
    json["mm_per_px"] = comparison.mm_per_px;
    json["circle_px"] = {{"centre", {outline.centre.x(), outline.centre.y()}},
                         {"radius", outline.radius},
                         {"rms", outline.rms},
                         {"arc_deg", outline.arc_deg},
                         {"followed", outline.followed}};
    json["warnings"] = comparison.warnings;
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Image annotated(const Image& photo, const SilhouetteComparison& comparison) {
    constexpr int longest = 1600;
    const int factor = std::max(1, (std::max(photo.width, photo.height) + longest - 1) / longest);
    Image image = smaller(photo, factor);
    const auto here = [&](const Vec2& pixel) { return Vec2((pixel + Vec2::Constant(0.5)) / factor); };
    const OutlineCircle& outline = comparison.outline;
    const double line_width = std::max(1.5, 0.002 * std::max(image.width, image.height));
    const double result_radius = 1.0 / (comparison.result_outline_curvature * comparison.mm_per_px);
    // The result's circle touches the other one where the arc has its middle; around a full turn they are
    // concentric.
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : outline.points)
        middle += (p - outline.centre).normalized() / static_cast<double>(outline.points.size());
    const Vec2 result_centre = outline.centre + (outline.radius - result_radius) * middle;
    Pen(image, of_result).lines({circle_line(here(result_centre), result_radius / factor)}, line_width);
    Pen(image, of_photo).lines({circle_line(here(outline.centre), outline.radius / factor)}, line_width);
    std::vector<std::vector<Vec2>> dots;
    const std::size_t step = std::max<std::size_t>(1, outline.points.size() / 180);
    for (std::size_t i = 0; i < outline.points.size(); i += step)
        dots.push_back({here(outline.points[i]), here(outline.points[i])});
    Pen(image, of_points).lines(dots, 2.0 * line_width);
    const double height = std::max(10.0, 0.015 * image.height);
    Pen(image, of_photo)
        .text(fmt::format("photo {:.4f} +- {:.4f} /mm", comparison.curvature, comparison.uncertainty),
              {height, 2.0 * height}, {.cap_height = height});
    Pen(image, of_result)
        .text(fmt::format("result {:.4f} /mm", comparison.result_outline_curvature), {height, 4.0 * height},
              {.cap_height = height});
    return image;
}

}  // namespace ruche

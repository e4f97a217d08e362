#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/pattern/generators.hpp"
#include "ruche/pattern/tiling.hpp"

namespace ruche {
namespace {

constexpr std::string_view style_names[] = {"outlined", "filled"};
constexpr double most_cells = 20000;

void check_disc(double radius, double edge) {
    // A disc of radius r has pi r^2 / (3 sqrt(3)/2 edge^2) cells.
    if (radius * radius / (edge * edge) * M_PI / 2.6 <= most_cells) return;
    throw InputError(
        {.key = "radius_mm"}, fmt::format("a disc of {} mm has too many cells of edge {} mm", radius, edge),
        fmt::format("At most {} cells are drawn: make the disc smaller or the edge longer.", most_cells));
}

[[noreturn]] void nothing_fits(double radius) {
    throw InputError({.key = "radius_mm"}, fmt::format("nothing fits on a disc of {} mm radius", radius),
                     "Make radius_mm larger or edge_mm smaller.");
}

Polyline hexagon(const Vec2& centre, double edge) {
    Polyline corners;
    for (int k = 0; k < 6; ++k)
        corners.emplace_back(centre + edge * Vec2(std::cos(k * M_PI / 3), std::sin(k * M_PI / 3)));
    return corners;
}

}  // namespace

template <>
std::span<const Field<StarTilingOptions>> fields<StarTilingOptions>() {
    using S = StarTilingOptions;
    static const Field<S> table[] = {
        {"edge_mm", &S::edge, "mm", 0.5, 1e3, "Edge of the tiling: distance between neighbouring stars."},
        {"arm_mm", &S::arm, "mm", 0.2, 1e3, "Length of an arm from the star's centre."},
        {"width_mm", &S::width, "mm", 0.1, 1e3, "Width of an arm."},
        {"radius_mm", &S::radius, "mm", 1.0, 1e4, "Radius of the disc of fabric."},
        {"rim_mm", &S::rim, "mm", 0.0, 1e3, "Bare fabric left along the disc's edge, at least."},
    };
    return table;
}

template <>
std::span<const Field<HexagonTilingOptions>> fields<HexagonTilingOptions>() {
    using S = HexagonTilingOptions;
    static const Field<S> table[] = {
        {"edge_mm", &S::edge, "mm", 0.5, 1e3, "Edge of the tiling, from cell corner to cell corner."},
        {"gap_mm", &S::gap, "mm", 0.1, 1e3, "Fabric between the plastic of neighbouring hexagons."},
        {"style", choice<&S::style>(style_names), "", 0, 0, "Print outlines or whole hexagons."},
        {"width_mm", &S::width, "mm", 0.1, 1e3, "Width of an outline."},
        {"radius_mm", &S::radius, "mm", 1.0, 1e4, "Radius of the disc of fabric."},
        {"rim_mm", &S::rim, "mm", 0.0, 1e3, "Bare fabric left along the disc's edge, at least."},
    };
    return table;
}

GeneratedPattern generate_stars(const StarTilingOptions& options) {
    if (2 * options.arm > options.edge - smallest_gap)
        throw InputError({.key = "arm_mm"},
                         fmt::format("arms of {} mm of stars {} mm apart touch", options.arm, options.edge),
                         "Give an arm_mm of less than half of edge_mm.");
    if (options.width >= options.arm)
        throw InputError(
            {.key = "width_mm"},
            fmt::format("arms {} mm wide and {} mm long make no star", options.width, options.arm),
            "Give a width_mm less than arm_mm.");
    check_disc(options.radius, options.edge);
    GeneratedPattern result;
    const double limit = options.radius - options.rim;
    for (const TilingVertex& vertex : hexagon_vertices(options.edge, options.radius)) {
        DrawnStrip star{.id = fmt::format("star-{}", result.strips.size() + 1), .width = options.width};
        bool fits = true;
        for (int k = 0; k < 3; ++k) {
            const double angle = vertex.first_angle + 2 * M_PI * k / 3;
            const Vec2 along(std::cos(angle), std::sin(angle));
            const Vec2 across(-along.y(), along.x());
            const Vec2 tip = vertex.at + options.arm * along;
            for (const double side : {0.5, -0.5})
                fits = fits && (tip + side * options.width * across).norm() <= limit;
            star.lines.push_back({{vertex.at, tip}, false});
        }
        if (fits) result.strips.push_back(std::move(star));
    }
    if (result.strips.empty()) nothing_fits(options.radius);
    result.fabric.push_back(circle_polygon(options.radius));
    return result;
}

GeneratedPattern generate_hexagons(const HexagonTilingOptions& options) {
    // Taking a border of width b off a hexagon takes 2 b / sqrt(3) off its edge.
    const double plastic = options.edge - options.gap / std::sqrt(3.0);
    const double pen_line = plastic - options.width / std::sqrt(3.0);
    const bool outlined = options.style == HexagonStyle::outlined;
    if (plastic * std::sqrt(3.0) < smallest_gap)
        throw InputError(
            {.key = "gap_mm"},
            fmt::format("a gap of {} mm leaves nothing of hexagons of edge {} mm", options.gap, options.edge),
            "Make gap_mm smaller or edge_mm larger.");
    if (outlined && pen_line * std::sqrt(3.0) < options.width + smallest_gap)
        throw InputError({.key = "width_mm"},
                         fmt::format("an outline {} mm wide leaves no hole in hexagons of edge {:.4g} mm",
                                     options.width, plastic),
                         "Make width_mm smaller, or write style = \"filled\".");
    check_disc(options.radius, options.edge);
    GeneratedPattern result;
    for (const Vec2& centre : hexagon_centres(options.edge, options.radius)) {
        const Polyline border = hexagon(centre, plastic);
        const bool fits = std::ranges::all_of(
            border, [&](const Vec2& x) { return x.norm() <= options.radius - options.rim; });
        if (!fits) continue;
        const std::string id = fmt::format("hexagon-{}", result.strips.size() + 1);
        if (outlined)
            result.strips.push_back(
                {.id = id, .lines = {{hexagon(centre, pen_line), true}}, .width = options.width});
        else
            result.strips.push_back({.id = id, .lines = {{border, true}}, .width = 0.0});
    }
    if (result.strips.empty()) nothing_fits(options.radius);
    result.fabric.push_back(circle_polygon(options.radius));
    return result;
}

}  // namespace ruche

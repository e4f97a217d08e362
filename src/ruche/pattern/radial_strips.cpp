#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/pattern/generators.hpp"
#include "ruche/pattern/tiling.hpp"

namespace ruche {
namespace {

constexpr double chord_tolerance = 0.01;  // mm, of the outline

struct Ring {
    double radius = 0.0;
    int count = 0;
};

std::string_view trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

[[noreturn]] void fail(const std::string& problem) {
    throw InputError({.key = "rings"}, problem,
                     "Write \"radius : count, radius : count, ...\", radii in mm growing outward, such as "
                     "\"12:20, 16.5:20, 22:40\".");
}

std::vector<Ring> read_rings(std::string_view text) {
    std::vector<Ring> rings;
    while (true) {
        const auto comma = text.find(',');
        const std::string_view entry = trimmed(text.substr(0, comma));
        const auto colon = entry.find(':');
        Ring ring;
        if (colon == std::string_view::npos || !read_number(trimmed(entry.substr(0, colon)), ring.radius) ||
            !read_number(trimmed(entry.substr(colon + 1)), ring.count))
            fail(fmt::format("\"{}\" is not a ring", entry));
        if (!std::isfinite(ring.radius) || ring.radius <= 0 || ring.count < 1 || ring.count > most_strips)
            fail(fmt::format("\"{}\": radius and count must be positive (at most {} strips)", entry,
                             most_strips));
        rings.push_back(ring);
        if (rings.size() > 1000) fail("more than 1000 rings");
        if (comma == std::string_view::npos) return rings;
        text.remove_prefix(comma + 1);
    }
}

/// First angle of `count` evenly spaced strips as far as possible from those at `taken`.
double best_first_angle(const std::vector<double>& taken, int count) {
    if (taken.empty()) return 0.0;
    const double period = 2 * M_PI / count;
    std::vector<double> rest;
    for (const double angle : taken) {
        double r = std::fmod(angle, period);
        if (period - r < 1e-9) r = 0.0;
        rest.push_back(r);
    }
    std::ranges::sort(rest);
    double best = 0.0;
    double widest = -1.0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const double next = i + 1 < rest.size() ? rest[i + 1] : rest.front() + period;
        if (next - rest[i] > widest + 1e-9) {
            widest = next - rest[i];
            best = rest[i] + 0.5 * widest;
        }
    }
    return best;
}

/// Smallest angle between two directions of a sorted set on the circle.
double smallest_angle(const std::vector<double>& sorted) {
    double smallest = 2 * M_PI;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double next = i + 1 < sorted.size() ? sorted[i + 1] : sorted.front() + 2 * M_PI;
        smallest = std::min(smallest, next - sorted[i]);
    }
    return smallest;
}

/// The circle with straight pieces where strips of that width end on it, so that their corners are corners of
/// the outline and nothing has to be cut off.
Polyline outline_with_ends(double radius, const std::vector<double>& sorted, double width) {
    const double half = std::asin(0.5 * width / radius);
    const double step = 2.0 * std::acos(1.0 - std::min(chord_tolerance / radius, 0.5));
    Polyline points;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double next = i + 1 < sorted.size() ? sorted[i + 1] : sorted.front() + 2 * M_PI;
        const Vec2 along(std::cos(sorted[i]), std::sin(sorted[i]));
        const Vec2 across(-along.y(), along.x());
        const Vec2 middle = radius * std::cos(half) * along;
        points.emplace_back(middle - 0.5 * width * across);
        points.emplace_back(middle + 0.5 * width * across);
        const double begin = sorted[i] + half;
        const double arc = next - half - begin;
        const int pieces = std::max(1, static_cast<int>(std::ceil(arc / step)));
        for (int k = 1; k < pieces; ++k) {
            const double angle = begin + arc * k / pieces;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        }
    }
    return points;
}

void check_options(const RadialStripsOptions& options, const std::vector<Ring>& rings) {
    if (options.inner >= options.outer)
        throw InputError({.key = "inner_mm"},
                         fmt::format("{} is not smaller than outer_mm = {}", options.inner, options.outer),
                         "The fabric is the annulus between the two radii.");
    if (options.width >= 2 * options.inner)
        throw InputError({.key = "width_mm"},
                         fmt::format("strips {} mm wide do not fit around a hole of radius {} mm",
                                     options.width, options.inner));
    for (std::size_t i = 0; i < rings.size(); ++i) {
        if (rings[i].radius < options.inner - 1e-9)
            fail(fmt::format("strips from r = {} mm begin inside the hole, inner_mm = {}", rings[i].radius,
                             options.inner));
        if (rings[i].radius > options.outer - options.width)
            fail(fmt::format("strips from r = {} mm have no length left to outer_mm = {}", rings[i].radius,
                             options.outer));
        if (i > 0 && rings[i].radius < rings[i - 1].radius) fail("the radii do not grow outward");
    }
}

void check_room(const RadialStripsOptions& options, const Ring& ring, const std::vector<double>& sorted) {
    const double apart = 2 * ring.radius * std::sin(std::min(0.5 * smallest_angle(sorted), M_PI / 2));
    if (sorted.size() < 2 || apart >= options.width + smallest_gap) return;
    fail(fmt::format(
        "at r = {} mm {} strips of {} mm width are {:.3g} mm apart from centre to centre: they touch",
        ring.radius, sorted.size(), options.width, apart));
}

}  // namespace

template <>
std::span<const Field<RadialStripsOptions>> fields<RadialStripsOptions>() {
    using S = RadialStripsOptions;
    static const Field<S> table[] = {
        {"inner_mm", &S::inner, "mm", 0.5, 1e4, "Radius of the hole in the fabric."},
        {"outer_mm", &S::outer, "mm", 1.0, 1e4, "Radius of the fabric; all strips end there."},
        {"width_mm", &S::width, "mm", 0.1, 1e3, "Width of each strip."},
        {"rings", &S::rings, "", -infinity, infinity,
         "Where strips begin and how many: \"radius : count, ...\" from the inside outward."},
    };
    return table;
}

GeneratedPattern generate_radial(const RadialStripsOptions& options) {
    const std::vector<Ring> rings = read_rings(options.rings);
    check_options(options, rings);
    GeneratedPattern result;
    std::vector<double> angles;
    std::vector<double> at_inner;
    const double half = 0.5 * options.width;
    // A strip that ends on a circle ends with its corners on it.
    const auto end_at = [&](double radius) { return std::sqrt(radius * radius - half * half); };
    for (std::size_t r = 0; r < rings.size(); ++r) {
        const Ring& ring = rings[r];
        const double first = best_first_angle(angles, ring.count);
        const bool on_rim = std::abs(ring.radius - options.inner) <= 1e-9;
        for (int k = 0; k < ring.count; ++k) {
            const double angle = first + 2 * M_PI * k / ring.count;
            const Vec2 along(std::cos(angle), std::sin(angle));
            const double from = on_rim ? end_at(options.inner) : ring.radius;
            result.strips.push_back({.id = fmt::format("ring-{}-strip-{}", r + 1, k + 1),
                                     .lines = {{{from * along, end_at(options.outer) * along}, false}},
                                     .width = options.width});
            angles.push_back(angle);
        }
        if (angles.size() > most_strips) fail(fmt::format("more than {} strips", most_strips));
        std::ranges::sort(angles);
        if (on_rim) at_inner = angles;
        check_room(options, ring, angles);
    }
    result.fabric.push_back(outline_with_ends(options.outer, angles, options.width));
    result.fabric.push_back(at_inner.empty() ? circle_polygon(options.inner)
                                             : outline_with_ends(options.inner, at_inner, options.width));
    return result;
}

}  // namespace ruche

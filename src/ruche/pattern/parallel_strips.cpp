#include <fmt/format.h>

#include <algorithm>

#include "ruche/core/error.hpp"
#include "ruche/pattern/generators.hpp"

namespace ruche {
namespace {

LineCap pen_cap(StripCap cap) { return cap == StripCap::round ? LineCap::round : LineCap::butt; }

/// A strip along x from `from` to `to` (its ends, caps included).
DrawnStrip straight_strip(std::string id, const Vec2& from, const Vec2& to, double width, StripCap cap) {
    const double inset = cap == StripCap::round ? 0.5 * width : 0.0;
    return {.id = std::move(id),
            .lines = {{{{from.x() + inset, from.y()}, {to.x() - inset, to.y()}}, false}},
            .width = width,
            .cap = pen_cap(cap)};
}

void check_shape(double length, double width) {
    if (length > width) return;
    throw InputError({.key = "length_mm"},
                     fmt::format("a strip {} mm long and {} mm wide is wider than long", length, width),
                     "Give a length_mm greater than width_mm.");
}

}  // namespace

template <>
std::span<const Field<SingleStripOptions>> fields<SingleStripOptions>() {
    using S = SingleStripOptions;
    static const Field<S> table[] = {
        {"length_mm", &S::length, "mm", 0.2, 1e4, "Length of the strip from end to end."},
        {"width_mm", &S::width, "mm", 0.1, 1e3, "Width of the strip."},
        {"cap", choice<&S::cap>(cap_names), "", 0, 0, "Shape of the ends."},
    };
    return table;
}

template <>
std::span<const Field<StaggeredStripsOptions>> fields<StaggeredStripsOptions>() {
    using S = StaggeredStripsOptions;
    static const Field<S> table[] = {
        {"width_mm", &S::width, "mm", 0.1, 1e3, "Width of each strip."},
        {"length_mm", &S::length, "mm", 0.2, 1e4, "Length of each strip from end to end."},
        {"axial_gap_mm", &S::axial_gap, "mm", 0.1, 1e3, "Fabric between the ends of neighbours in a row."},
        {"pitch_mm", &S::pitch, "mm", 0.2, 1e3, "Distance between the centre lines of neighbouring rows."},
        {"rows", &S::rows, "", 1, 2000, "Number of rows."},
        {"strips_per_row", &S::strips_per_row, "", 1, 2000, "Whole strips in the rows that are not shifted."},
        {"half_strips", &S::half_strips, "", 0, 0, "Fill the ends of shifted rows with half strips."},
        {"alternate_sides", &S::alternate_sides, "", 0, 0, "Print every other row on the other side."},
        {"cap", choice<&S::cap>(cap_names), "", 0, 0, "Shape of the ends."},
    };
    return table;
}

GeneratedPattern generate_strip(const SingleStripOptions& options) {
    check_shape(options.length, options.width);
    const double half = 0.5 * options.length;
    GeneratedPattern result;
    result.strips.push_back(straight_strip("strip", {-half, 0}, {half, 0}, options.width, options.cap));
    return result;
}

GeneratedPattern generate_staggered(const StaggeredStripsOptions& options) {
    check_shape(options.length, options.width);
    if (options.pitch < options.width + 0.1)
        throw InputError(
            {.key = "pitch_mm"},
            fmt::format("rows {} mm apart of strips {} mm wide touch", options.pitch, options.width),
            "Give a pitch_mm of at least width_mm + 0.1.");
    if (options.rows * options.strips_per_row > most_strips)
        throw InputError({.key = "rows"},
                         fmt::format("{} x {} strips are too many", options.rows, options.strips_per_row),
                         fmt::format("At most {} strips are drawn.", most_strips));

    const double period = options.length + options.axial_gap;
    const double extent = period * options.strips_per_row - options.axial_gap;
    GeneratedPattern result;
    const auto add = [&](int row, int number, double from, double to) {
        if (to - from <= options.width) return;  // what the patch's end leaves of a strip is no strip
        const double y = options.pitch * (row - 0.5 * (options.rows - 1));
        DrawnStrip strip =
            straight_strip(fmt::format("strip-{}-{}", row + 1, number), {from - 0.5 * extent, y},
                           {to - 0.5 * extent, y}, options.width, options.cap);
        if (options.alternate_sides && row % 2 == 1) strip.side = Side::back;
        result.strips.push_back(std::move(strip));
    };
    for (int row = 0; row < options.rows; ++row) {
        const bool shifted = row % 2 == 1;
        for (int k = 0; k < options.strips_per_row + (shifted ? 1 : 0); ++k) {
            const double from = period * (shifted ? k - 0.5 : k);
            const double to = from + options.length;
            const bool whole = from >= -1e-9 && to <= extent + 1e-9;
            if (whole || options.half_strips) add(row, k + 1, std::max(from, 0.0), std::min(to, extent));
        }
    }
    return result;
}

}  // namespace ruche

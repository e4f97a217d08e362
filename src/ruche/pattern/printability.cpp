#include "ruche/pattern/printability.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ruche/geometry/polyline.hpp"

namespace ruche {

namespace {

constexpr double arc_tolerance = 0.002;
// A strip of exactly the narrowest width passes in spite of rounding and chords.
constexpr double inset = 0.5 * narrowest_feature_mm - 2.0 * arc_tolerance;
constexpr double longest_tip = 1.0;

[[noreturn]] void too_narrow(const Place& place, const std::string& what) {
    throw InputError(
        place, what,
        fmt::format("Nothing narrower than {} mm can be printed. Draw it wider, take it out, or check "
                    "the drawing's units.",
                    narrowest_feature_mm));
}

}  // namespace

bool is_sliver(const Polygon& polygon) { return offset({polygon}, -inset, arc_tolerance).empty(); }

void check_strip(const Strip& strip, const Place& place) {
    if (!(strip.thickness > 0.0) || !std::isfinite(strip.thickness)) {
        throw InputError(
            place, fmt::format("a print thickness of {} mm", strip.thickness),
            "A thickness is a positive number of mm. To leave something unprinted, ignore it by a "
            "rule.");
    }
    if (!(strip.youngs_modulus >= 0.0) || !std::isfinite(strip.youngs_modulus)) {
        throw InputError(place, fmt::format("a Young's modulus of {} MPa", strip.youngs_modulus),
                         "A modulus is a positive number of MPa; 0 takes the material card's.");
    }
    if (strip.region.empty()) too_narrow(place, "covers no area: nothing would be printed");
    const Region region = simplify(strip.region, arc_tolerance);  // many points make offsets slow
    const Region core = offset(region, -inset, arc_tolerance);
    if (core.empty()) {
        too_narrow(place, fmt::format("is {:.3g} mm wide", strip_width(strip.region.front())));
    }
    // What the printer's pen of that width can reach; its round tip leaves out corners.
    const Region reachable = offset(core, inset + 4.0 * arc_tolerance, arc_tolerance);
    for (const Polygon& rest : subtract(region, reachable)) {
        const double extent = 0.5 * length(rest.outer, true);
        if (extent > longest_tip) {
            const Vec2& at = rest.outer.front();
            too_narrow(place,
                       fmt::format("is narrower than {} mm for {:.3g} mm near x = {:.4g}, y = {:.4g} mm",
                                   narrowest_feature_mm, extent, at.x(), at.y()));
        }
    }
}

}  // namespace ruche

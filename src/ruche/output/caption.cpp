#include "ruche/output/caption.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ruche/output/export_surface.hpp"

namespace ruche {
namespace {

std::string range(double low, double high, const char* between) {
    return low == high ? fmt::format("{:g}", low) : fmt::format("{:g}{}{:g}", low, between, high);
}

/// "0.6 mm front", "0.4-0.8 mm front, 0.5 mm back", or "none".
std::string plastic(const std::vector<Print>& print) {
    std::string text;
    for (const auto& [member, side] : {std::pair(&Print::front, "front"), std::pair(&Print::back, "back")}) {
        double low = 0.0, high = 0.0;
        for (const Print& p : print) {
            const double t = p.*member;
            if (!(t > 0.0)) continue;
            low = high > 0.0 ? std::min(low, t) : t;
            high = std::max(high, t);
        }
        if (high > 0.0)
            text += fmt::format("{}{} mm {}", text.empty() ? "" : ", ", range(low, high, "\u2013"), side);
    }
    return text.empty() ? "none" : text;
}

}  // namespace

Caption make_caption(const Result& result, const std::string& title) {
    const auto& s = result.scene.fabric.prestretch;
    Caption caption;
    caption.title = title.empty() ? result_title(result) : title;
    caption.details = fmt::format("pre-stretch {}  \u00B7  plastic {}  \u00B7  fabric {:g} mm",
                                  s[0] == s[1] ? fmt::format("{:g}", s[0]) : range(s[0], s[1], " \u00D7 "),
                                  plastic(result.layout.print), result.scene.material.fabric_thickness);
    switch (result.equilibrium.status) {
        case SolveStatus::not_converged:
            caption.alarm = "NOT CONVERGED";
            break;
        case SolveStatus::interrupted:
            caption.alarm = "INTERRUPTED";
            break;
        case SolveStatus::converged:
            caption.alarm = result.equilibrium.stable ? "" : "NOT STABLE";
            break;
    }
    if (caption.alarm.empty() && !result.self_intersections.empty()) caption.alarm = "PASSES THROUGH ITSELF";
    return caption;
}

}  // namespace ruche

#include "ruche/statics/sheet_symmetry.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ruche/geometry/layout_frame.hpp"
#include "ruche/meshing/point_locator.hpp"

namespace ruche {
namespace {

Print exchanged(const Print& print) {
    return {.front = print.back,
            .back = print.front,
            .front_modulus = print.back_modulus,
            .back_modulus = print.front_modulus};
}

/// Which turns of its axes the material allows.
enum class Isotropy { none, axes_alike, full };
Isotropy isotropy_of(const ModelInput& sheet) {
    const Material& m = sheet.material;
    if (sheet.prestretch[0] != sheet.prestretch[1]) return Isotropy::none;
    const bool printed_all_over =
        std::ranges::none_of(sheet.print, [](const Print& print) { return print.bare(); });
    const bool isotropic_laminate = sheet.options.fabric_ply == FabricPlyLaw::linear;
    if (printed_all_over && !sheet.print.empty() && isotropic_laminate) return Isotropy::full;
    const bool alike = m.alpha_1 == m.alpha_2 && m.beta_1 == m.beta_2 && m.gamma_1 == m.gamma_2;
    return alike ? Isotropy::axes_alike : Isotropy::none;
}

bool maps_onto_itself(const ModelInput& sheet, const SheetSymmetry& map, const PointLocator& locator) {
    constexpr double beside = 0.01;    // mm: how well round outlines are followed
    constexpr double may_miss = 1e-3;  // of the area
    constexpr double alike = 1e-6;     // mm, MPa
    const auto same = [&](const Print& a, const Print& b) {
        return std::abs(a.front - b.front) < alike && std::abs(a.back - b.back) < alike &&
               std::abs(a.front_modulus - b.front_modulus) < alike &&
               std::abs(a.back_modulus - b.back_modulus) < alike;
    };
    double missed = 0.0;
    double area = 0.0;
    for (int t = 0; t < sheet.mesh.triangle_count(); ++t) {
        area += layout_area(sheet.mesh, t);
        const Vec2 there = map.turn * (layout_centroid(sheet.mesh, t) - map.centre) + map.centre;
        const Print print = sheet.print.empty() ? Print{} : sheet.print[t];
        const auto at = locator.find(there, beside);
        const Print found = at && !sheet.print.empty() ? sheet.print[at->triangle] : Print{};
        if (!at || !same(map.sides_exchanged ? exchanged(print) : print, found))
            missed += layout_area(sheet.mesh, t);
    }
    return missed < may_miss * area;
}

bool loaded(const ModelInput& sheet) {
    return !sheet.supports.empty() || !sheet.forces.empty() || sheet.table.present ||
           std::ranges::any_of(sheet.gravity, [](double g) { return g != 0.0; });
}

}  // namespace

std::vector<SheetSymmetry> find_symmetries(const ModelInput& sheet) {
    // Rods are not compared: no image of a state is looked for.
    if (loaded(sheet) || !sheet.rods.empty()) return {};
    constexpr double degree = std::numbers::pi / 180.0;
    const LayoutFrame frame = layout_frame(sheet.mesh);
    const Isotropy isotropy = isotropy_of(sheet);
    const double axis = isotropy == Isotropy::full ? frame.longest : sheet.fabric_axis_deg * degree;
    const int step = isotropy == Isotropy::none ? 2 : 1;

    std::vector<SheetSymmetry> candidates = {{.name = "itself"}};
    for (int quarter = step; quarter < 4; quarter += step) {
        const double angle = 90.0 * quarter;
        const Vec2 c(std::round(std::cos(angle * degree)), std::round(std::sin(angle * degree)));
        SheetSymmetry turned{.name = "turned by " + std::to_string(90 * quarter) + " degrees"};
        turned.turn << c.x(), -c.y(), c.y(), c.x();
        candidates.push_back(turned);
    }
    for (int eighth = 0; eighth < 4; eighth += step) {
        const double angle = axis + 45.0 * eighth * degree;
        double shown = std::fmod(std::round(angle / degree), 180.0);
        if (shown < 0.0) shown += 180.0;
        SheetSymmetry mirrored{.name = "mirrored at the axis at " + std::to_string(static_cast<int>(shown)) +
                                       " degrees"};
        mirrored.turn << std::cos(2 * angle), std::sin(2 * angle), std::sin(2 * angle), -std::cos(2 * angle);
        candidates.push_back(mirrored);
    }
    const PointLocator locator(sheet.mesh);
    std::vector<SheetSymmetry> found;
    for (SheetSymmetry& map : candidates) {
        map.centre = frame.centre;
        for (const bool exchange : {false, true}) {
            if (!exchange && map.turn.isIdentity()) continue;
            SheetSymmetry tried = map;
            tried.sides_exchanged = exchange;
            if (exchange) tried.name += ", sides exchanged";
            if (maps_onto_itself(sheet, tried, locator)) found.push_back(tried);
        }
    }
    return found;
}

ShapeImage image(const SheetSymmetry& symmetry, const ModelInput& sheet, const Eigen::VectorXd& x) {
    ShapeImage image{.layout = sheet.mesh, .print = sheet.print, .x = x.head(3 * sheet.mesh.vertices.size())};
    // What is at the map of p goes to p: vertices move by the inverse map.
    for (Vec2& p : image.layout.vertices)
        p = symmetry.turn.transpose() * (p - symmetry.centre) + symmetry.centre;
    if (symmetry.turn.determinant() < 0.0) {
        for (Triangle& tri : image.layout.triangles) std::swap(tri[1], tri[2]);
    }
    if (symmetry.sides_exchanged) {
        for (Print& print : image.print) print = exchanged(print);
    }
    if (symmetry.reflects_space()) {
        for (Eigen::Index v = 0; v < image.x.size() / 3; ++v) image.x[3 * v + 2] *= -1.0;
    }
    return image;
}

}  // namespace ruche

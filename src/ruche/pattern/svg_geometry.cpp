#include "ruche/pattern/svg_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "ruche/pattern/css_sheet.hpp"
#include "ruche/pattern/svg_path.hpp"
#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

class ShapeReader {
  public:
    ShapeReader(const pugi::xml_node& node, const Vec2& viewport, const Remark& remark)
        : node_(node), viewport_(viewport), remark_(remark) {}

    Outline run(std::string_view name) {
        if (name == "path") return taken(parse_path(node_.attribute("d").value()), "path data");
        if (name == "polyline")
            return taken(parse_points(node_.attribute("points").value(), false), "points");
        if (name == "polygon") return taken(parse_points(node_.attribute("points").value(), true), "points");
        if (name == "line") return polygon_outline({{x("x1"), y("y1")}, {x("x2"), y("y2")}}, false);
        if (name == "rect") return rectangle();
        if (name == "circle") {
            const double r = length_attribute(node_, "r", viewport_diagonal(viewport_), 0.0, remark_);
            return ellipse({r, r});
        }
        const std::optional<double> rx = radius("rx", viewport_.x()), ry = radius("ry", viewport_.y());
        return ellipse({rx.value_or(ry.value_or(0.0)), ry.value_or(rx.value_or(0.0))});
    }

  private:
    double x(const char* name) { return length_attribute(node_, name, viewport_.x(), 0.0, remark_); }
    double y(const char* name) { return length_attribute(node_, name, viewport_.y(), 0.0, remark_); }

    /// Empty when absent or "auto".
    std::optional<double> radius(const char* name, double whole) {
        const std::string_view text = trimmed(node_.attribute(name).value());
        if (text.empty() || text == "auto") return std::nullopt;
        return length_attribute(node_, name, whole, 0.0, remark_);
    }

    Outline taken(PathReading reading, const std::string& what) {
        if (reading.error) remark_(what + ": " + *reading.error + "; only what comes before is printed");
        if (reading.outline.empty() && !reading.error) remark_("has no " + what + ": not printed");
        return std::move(reading.outline);
    }

    Outline rectangle() {
        const Box box{{x("x"), y("y")}, {x("width"), y("height")}};
        if (!(box.size.minCoeff() > 0.0)) {
            remark_("a width or height that is not positive: not printed");
            return {};
        }
        const std::optional<double> rx = radius("rx", viewport_.x()), ry = radius("ry", viewport_.y());
        const Vec2 radii(rx.value_or(ry.value_or(0.0)), ry.value_or(rx.value_or(0.0)));
        return rectangle_outline(box, radii.cwiseMax(0.0));
    }

    Outline ellipse(const Vec2& radii) {
        if (!(radii.minCoeff() > 0.0)) {
            remark_("a radius that is not positive: not printed");
            return {};
        }
        return ellipse_outline({x("cx"), y("cy")}, radii);
    }

    pugi::xml_node node_;
    Vec2 viewport_;
    const Remark& remark_;
};

}  // namespace

double length_attribute(const pugi::xml_node& node, const char* name, double whole, double otherwise,
                        const Remark& remark) {
    const pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute) return otherwise;
    const std::optional<Length> length = parse_length(attribute.value());
    const double px = length ? length->px(whole) : 0.0;
    if (length && std::isfinite(px)) return px;
    remark(std::string(name) + ": '" + std::string(attribute.value()).substr(0, 60) +
           "' is not a length: ignored");
    return otherwise;
}

bool is_shape(std::string_view name) {
    static constexpr std::string_view names[] = {"path", "rect",     "circle", "ellipse",
                                                 "line", "polyline", "polygon"};
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

Outline shape_outline(const pugi::xml_node& node, const Vec2& viewport, const Remark& remark) {
    return ShapeReader(node, viewport, remark).run(local_name(node));
}

double viewport_diagonal(const Vec2& viewport) { return viewport.norm() / std::numbers::sqrt2; }

}  // namespace ruche::svg

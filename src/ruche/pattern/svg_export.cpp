#include "ruche/pattern/svg_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/fields.hpp"

namespace ruche {
namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    }
    return result;
}

/// Six decimals (1 nm) without trailing zeros.
std::string number(double value) {
    std::string text = fmt::format("{:.6f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

/// The part of the plane that the page shows, in whole mm.
struct PageExtent {
    double left = infinity;
    double right = -infinity;
    double bottom = infinity;
    double top = -infinity;

    void add(const Polyline& points, double around) {
        for (const Vec2& x : points) {
            left = std::min(left, std::floor(x.x() - around));
            right = std::max(right, std::ceil(x.x() + around));
            bottom = std::min(bottom, std::floor(x.y() - around));
            top = std::max(top, std::ceil(x.y() + around));
        }
    }
    double width() const { return right - left; }
    double height() const { return top - bottom; }

    /// "12.5,3": a point in the file's coordinates, y downwards.
    std::string place(const Vec2& x) const { return number(x.x() - left) + "," + number(top - x.y()); }
};

PageExtent page_of(const GeneratedPattern& generated, double margin) {
    PageExtent page;
    for (const Polyline& outline : generated.fabric) page.add(outline, margin);
    for (const DrawnStrip& strip : generated.strips) {
        for (const DrawnLine& line : strip.lines) page.add(line.points, 0.5 * strip.width + margin);
    }
    if (page.left > page.right) page = {0, 0, 0, 0};
    return page;
}

std::string path_data(const PageExtent& page, const Polyline& points, bool closed) {
    std::string data;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i == 0) data += "M ";
        if (i == 1) data += " L ";
        if (i > 1) data += " ";
        data += page.place(points[i]);
    }
    return closed ? data + " Z" : data;
}

void begin_layer(std::string& svg, const char* name, const std::string& style) {
    svg += fmt::format("  <g id=\"layer-{0}\" inkscape:groupmode=\"layer\" inkscape:label=\"{0}\" {1}>\n",
                       name, style);
}

void add_strip(std::string& svg, const PageExtent& page, const DrawnStrip& strip, const char* colour) {
    std::string data;
    for (const DrawnLine& line : strip.lines) {
        if (!data.empty()) data += " ";
        data += path_data(page, line.points, line.closed);
    }
    const char* cap = strip.cap == LineCap::round    ? "round"
                      : strip.cap == LineCap::square ? "square"
                                                     : "butt";
    const std::string pen =
        strip.width > 0.0
            ? fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"{}\"", colour,
                          number(strip.width), cap)
            : fmt::format("fill=\"{}\" fill-rule=\"evenodd\" stroke=\"none\"", colour);
    svg += fmt::format("    <path id=\"{}\" {}\n      d=\"{}\"/>\n", escaped(strip.id), pen, data);
}

void add_side(std::string& svg, const PageExtent& page, const GeneratedPattern& generated, Side side) {
    const auto on_side = [&](const DrawnStrip& strip) { return strip.side == side; };
    if (std::ranges::none_of(generated.strips, on_side)) return;
    begin_layer(svg, side == Side::front ? front_layer : back_layer,
                "stroke-linejoin=\"miter\" stroke-miterlimit=\"4\"");
    for (const DrawnStrip& strip : generated.strips) {
        if (on_side(strip)) add_strip(svg, page, strip, side == Side::front ? front_colour : back_colour);
    }
    svg += "  </g>\n";
}

std::string description(const GeneratedPattern& generated, const PageExtent& page,
                        const SvgOptions& options) {
    std::string text = fmt::format("Pattern \"{}\", drawn by {}", generated.name, options.generated_by);
    if (!generated.description.empty()) text += " with " + generated.description;
    text += ". One unit is one mm; seen from the printed side.";
    if (options.thickness > 0.0) text += fmt::format(" Printed {} mm thick.", number(options.thickness));
    text += fmt::format(" The pattern's origin is at {}.", page.place(Vec2::Zero()));
    return escaped(text);
}

}  // namespace

std::string to_svg(const GeneratedPattern& generated, const SvgOptions& options) {
    const PageExtent page = page_of(generated, options.page_margin);
    const std::string width = number(page.width());
    const std::string height = number(page.height());
    std::string svg =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\"\n"
        "  xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n";
    svg += fmt::format("  width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 {0} {1}\">\n", width, height);
    svg += fmt::format("  <title>{}</title>\n", escaped(generated.name));
    svg += fmt::format("  <desc>{}</desc>\n", description(generated, page, options));
    if (!generated.fabric.empty()) {
        begin_layer(svg, fabric_layer, "stroke=\"none\"");
        std::string data;
        for (const Polyline& outline : generated.fabric)
            data += (data.empty() ? "" : " ") + path_data(page, outline, true);
        svg +=
            fmt::format("    <path id=\"{}\" fill=\"{}\" fill-rule=\"evenodd\"\n      d=\"{}\"/>\n  </g>\n",
                        fabric_id, fabric_colour, data);
    }
    add_side(svg, page, generated, Side::back);
    add_side(svg, page, generated, Side::front);
    return svg + "</svg>\n";
}

}  // namespace ruche

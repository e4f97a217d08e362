#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ruche/pattern/drawing.hpp"
#include "ruche/pattern/pattern.hpp"

namespace ruche::test {

inline Polyline box(double x0, double y0, double x1, double y1) {
    return {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)};
}

inline Polyline circle(const Vec2& centre, double radius, int count = 96) {
    Polyline points;
    for (int i = 0; i < count; ++i) {
        const double a = 2.0 * std::numbers::pi * i / count;
        points.emplace_back(centre + radius * Vec2(std::cos(a), std::sin(a)));
    }
    return points;
}

/// A stroked line as an importer would hand it over.
inline Shape stroked(const std::string& id, const Polyline& line, double width, bool closed = false,
                     const std::string& colour = "#000000") {
    Shape shape;
    shape.id = id;
    shape.stroke_colour = colour;
    shape.stroked = stroke(line, closed, {.width = width});
    shape.lines = {line};
    shape.closed = {closed};
    shape.stroke_width = width;
    shape.line = 7;
    return shape;
}

inline Shape filled(const std::string& id, const Polyline& loop, const std::string& colour = "#000000") {
    Shape shape;
    shape.id = id;
    shape.fill_colour = colour;
    shape.filled = region_from_loops({&loop, 1}, FillRule::nonzero);
    shape.lines = {loop};
    shape.closed = {true};
    shape.line = 7;
    return shape;
}

inline Drawing drawing(std::vector<Shape> shapes) {
    return {.file = "test.svg", .shapes = std::move(shapes), .width = 100, .height = 100, .warnings = {}};
}

inline Strip strip(const std::string& id, const Polyline& line, double width, double thickness = 0.6,
                   Side side = Side::front) {
    Strip result;
    result.id = id;
    result.region = stroke(line, false, {.width = width});
    result.centreline = {line};
    result.thickness = thickness;
    result.side = side;
    return result;
}

}  // namespace ruche::test

#include "ruche/pattern/generated_pattern.hpp"

#include <algorithm>

namespace ruche {
namespace {

Shape strip_shape(const DrawnStrip& strip) {
    Shape shape{.id = strip.id, .layer = strip.side == Side::front ? front_layer : back_layer};
    const std::string colour = strip.side == Side::front ? front_colour : back_colour;
    std::vector<Region> pieces;
    std::vector<Polyline> loops;
    for (const DrawnLine& line : strip.lines) {
        shape.lines.push_back(line.points);
        shape.closed.push_back(line.closed);
        if (strip.width > 0.0)
            pieces.push_back(stroke(line.points, line.closed, {.width = strip.width, .cap = strip.cap}));
        else
            loops.push_back(line.points);
    }
    if (strip.width > 0.0) {
        shape.stroked = unite(pieces);
        shape.stroke_colour = colour;
        shape.stroke_width = strip.width;
    } else {
        shape.filled = region_from_loops(loops, FillRule::evenodd);
        shape.fill_colour = colour;
    }
    return shape;
}

}  // namespace

Drawing to_drawing(const GeneratedPattern& generated) {
    Drawing drawing{.file = generated.name, .warnings = generated.warnings};
    if (!generated.fabric.empty())
        drawing.shapes.push_back({.id = fabric_id,
                                  .layer = fabric_layer,
                                  .fill_colour = fabric_colour,
                                  .filled = region_from_loops(generated.fabric, FillRule::evenodd),
                                  .lines = generated.fabric,
                                  .closed = std::vector<bool>(generated.fabric.size(), true)});
    for (const DrawnStrip& strip : generated.strips) drawing.shapes.push_back(strip_shape(strip));
    return drawing;
}

Pattern to_pattern(const GeneratedPattern& generated, PrintRules rules) {
    if (!generated.fabric.empty() && !rules.fabric_from_outline) {
        rules.fabric_from_outline = true;
        rules.fabric_layer = fabric_layer;
    }
    const bool both_sides =
        std::ranges::any_of(generated.strips, [](const DrawnStrip& s) { return s.side == Side::back; });
    if (both_sides)
        rules.rules.push_back({.match = back_layer,
                               .thickness = rules.thickness,
                               .side = rules.side == Side::front ? Side::back : Side::front});
    return make_pattern(to_drawing(generated), rules);
}

}  // namespace ruche

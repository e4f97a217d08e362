#include <fmt/format.h>

#include <optional>

#include "ruche/core/error.hpp"
#include "ruche/pattern/drawing.hpp"
#include "ruche/pattern/svg_file.hpp"
#include "ruche/pattern/svg_page.hpp"
#include "ruche/pattern/svg_shapes.hpp"
#include "ruche/pattern/svg_walk.hpp"

namespace ruche {

namespace {

using namespace svg;

void check_options(const DrawingOptions& options) {
    const double tolerance = options.flatten_tolerance_mm;
    if (!(tolerance >= 1e-4 && tolerance <= 10.0)) {
        throw InputError({"", 0, "flatten_tolerance_mm"},
                         fmt::format("{} is outside [0.0001, 10]", tolerance),
                         "Largest distance between a curve and its chords.");
    }
    if (!(options.width_mm >= 0.0 && options.width_mm <= largest_page)) {
        throw InputError({"", 0, "width_mm"},
                         fmt::format("{} is outside [0, {}]", options.width_mm, largest_page),
                         "The page's width on the frame; 0 takes the size from the file.");
    }
}

std::vector<Shape> shapes_on(const SvgFile& file, const PageMap& page, const DrawingOptions& options,
                             Warnings& warnings) {
    const std::vector<DrawnItem> items = drawn_items(file, page, warnings);
    return make_shapes(file, items, page, options.flatten_tolerance_mm, warnings);
}

Extent extent_of(const Shape& shape) {
    Extent extent;
    extent.include(shape.filled);
    extent.include(shape.stroked);
    return extent;
}

Page measured_page(const SvgFile& file, const DrawingOptions& options, Warnings& warnings) {
    Warnings unheard;  // everything is said when the drawing is read in earnest
    Extent all;
    for (const Shape& shape : shapes_on(file, measuring_map(), options, unheard)) {
        all.include(shape.filled);
        all.include(shape.stroked);
    }
    if (all.empty()) all.low = all.high = Vec2::Zero();
    return page_around(file, all.low, all.high, options.width_mm, warnings);
}

void remark_on_outsiders(const Drawing& drawing, Warnings& warnings) {
    for (const Shape& shape : drawing.shapes) {
        const Extent extent = extent_of(shape);
        const bool outside = extent.high.x() < 0.0 || extent.low.x() > drawing.width ||
                             extent.high.y() < 0.0 || extent.low.y() > drawing.height;
        if (!outside) continue;
        warnings.add({drawing.file, shape.line, fmt::format("'{}'", shape.id)},
                     "lies outside of the page; it is printed all the same");
    }
}

}  // namespace

Drawing read_svg(const std::string& path, const DrawingOptions& options) {
    check_options(options);
    Warnings warnings;
    const SvgFile file(path, warnings);
    std::optional<Page> page = page_of(file, options.width_mm, warnings);
    if (!page) page = measured_page(file, options, warnings);
    Drawing drawing;
    drawing.file = path;
    drawing.width = page->size.x();
    drawing.height = page->size.y();
    drawing.shapes = shapes_on(file, page->map, options, warnings);
    remark_on_outsiders(drawing, warnings);
    drawing.warnings = warnings.take();
    return drawing;
}

}  // namespace ruche

#pragma once

#include <string>
#include <vector>

#include "ruche/geometry/polygon.hpp"

namespace ruche {

/// One drawn thing, whatever file it came from: what the pen or the fill covers, in mm, y upwards, seen from
/// the printed side.
struct Shape {
    std::string id;                    ///< the element's id, else its label, else "path-7" by order
    std::string label;                 ///< Inkscape's label, if any
    std::string layer;                 ///< name of the innermost layer or group with a label or id
    std::vector<std::string> classes;  ///< CSS classes
    std::string stroke_colour;         ///< "#rrggbb", or empty when not stroked
    std::string fill_colour;           ///< "#rrggbb", or empty when not filled
    Region stroked;                    ///< covered by the stroke
    Region filled;                     ///< covered by the fill
    std::vector<Polyline>
        lines;  ///< the geometry itself: a stroke's centre lines (subpaths; dashes not applied)
    std::vector<bool> closed;   ///< for each line
    double stroke_width = 0.0;  ///< mm, after transforms; 0 when not stroked
    int line = 0;               ///< in the file
};

/// What was read from a drawing file, before anyone decided what is printed where.
struct Drawing {
    std::string file;
    std::vector<Shape> shapes;
    double width = 0.0;  ///< page size, mm
    double height = 0.0;
    std::vector<std::string>
        warnings;  ///< unit guesses, elements that are not printed (with id and line), ...
};

struct DrawingOptions {
    double flatten_tolerance_mm = 0.01;  ///< largest distance between a curve and its chords
    double width_mm = 0.0;               ///< if positive: scale so that the page is this wide
};

/// Reads an SVG file as Inkscape, Illustrator and Rhino write it. Throws InputError.
Drawing read_svg(const std::string& path, const DrawingOptions& options = {});

/// Picks the importer by the file's ending (.svg; DXF later). Throws InputError.
Drawing read_drawing(const std::string& path, const DrawingOptions& options = {});

}  // namespace ruche

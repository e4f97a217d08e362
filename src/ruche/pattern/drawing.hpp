#pragma once

#include <string>
#include <vector>

#include "ruche/geometry/polygon.hpp"

namespace ruche {

/// One drawn thing, whatever file it came from: what the pen or the fill covers, in mm, y upwards, seen from
/// the printed side.
struct Shape {
    std::string id;     ///< unique: the element's id, else its label, else "path-7" by order (see read_svg)
    std::string label;  ///< the user's name for it: Inkscape's label, Illustrator's data-name or escaped id
    std::string layer;  ///< name of the innermost Inkscape layer, else of the innermost group with a name
    std::vector<std::string> groups;   ///< labels and ids of all groups and layers around it, innermost first
    std::vector<std::string> classes;  ///< CSS classes
    std::string stroke_colour;         ///< "#rrggbb", or empty when not stroked
    std::string fill_colour;           ///< "#rrggbb", or empty when not filled
    Region stroked;                    ///< covered by the stroke
    Region filled;                     ///< covered by the fill
    /// The geometry itself: a stroke's centre lines, one for each subpath; dashes not applied. A single point
    /// is a dot.
    std::vector<Polyline> lines;
    std::vector<bool> closed;  ///< for each line
    double stroke_width =
        0.0;       ///< mm, after transforms (the mean if they stretch unevenly); 0 when not stroked
    int line = 0;  ///< in the file
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

/// Reads an SVG file as Inkscape, Illustrator and Rhino write it.
///
/// Understood: physical sizes, viewBox, nested transforms, groups and layers, use, symbol, nested svg,
/// switch; all shapes and path commands; colours, strokes (caps, joins, dashes, uneven scaling, non-scaling)
/// and fill rules by attribute, style and style sheet. The layout is what one sees: y points up here and down
/// in SVG, nothing is mirrored. Not printed, with a warning that has line and id: text, images, gradients and
/// patterns, markers, hidden elements; clips, masks and filters are ignored. Neither page nor nested
/// viewports clip.
///
/// Where a plain reading of SVG would surprise: an open line with a stroke is not filled unless somebody
/// asked for a fill (SVG's default is black); a gradient of one colour is that colour (Inkscape's swatches);
/// without physical units 96 px are an inch, with a warning. A clone (use) of one shape takes the clone's id,
/// a shape in a cloned group is "clone/shape"; what then has the id of another gets "-2", "-3", ...
///
/// Throws InputError for a file that is no SVG, for sizes and coordinates beyond 100 m, and for drawings that
/// nest or repeat themselves without end. Errors inside one element are warnings, and what can be read of it
/// is drawn, as SVG prescribes.
Drawing read_svg(const std::string& path, const DrawingOptions& options = {});

/// Picks the importer by the file's ending (.svg; DXF later). Throws InputError.
Drawing read_drawing(const std::string& path, const DrawingOptions& options = {});

}  // namespace ruche

#include "ruche/pattern/drawing.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "ruche/core/error.hpp"

namespace ruche {

Drawing read_drawing(const std::string& path, const DrawingOptions& options) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".svg") return read_svg(path, options);
    const Place place{path, 0, {}};
    if (ending == ".svgz") {
        throw InputError(place, "compressed SVG is not read",
                         "Save it as plain SVG, or unpack it with gunzip.");
    }
    if (ending == ".dxf") {
        throw InputError(place, "DXF drawings are not read yet",
                         "Export the drawing as SVG, or convert it with Inkscape.");
    }
    if (ending == ".ai" || ending == ".pdf" || ending == ".eps") {
        throw InputError(place, ending + " drawings are not read",
                         "Export the drawing as SVG (Illustrator: File > Export > SVG).");
    }
    throw InputError(place,
                     ending.empty() ? "has no ending that tells what it is" : "unknown ending " + ending,
                     "A drawing is expected as SVG, in a file that ends in .svg.");
}

}  // namespace ruche

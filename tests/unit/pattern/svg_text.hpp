#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "ruche/pattern/drawing.hpp"
#include "temporary_file.hpp"

/// Drawings written in the tests themselves.
namespace svg_text {

struct TemporaryFile : ruche::test::TemporaryFile {
    explicit TemporaryFile(std::string_view text, const std::string& name = "drawing.svg")
        : ruche::test::TemporaryFile(text, name) {}
};

inline ruche::Drawing read(std::string_view text, const ruche::DrawingOptions& options = {}) {
    const TemporaryFile file(text);
    return ruche::read_svg(file.path(), options);
}

/// The body on a page of 100 x 100 mm whose user units are mm.
inline std::string on_page(std::string_view body) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
           "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"100mm\" height=\"100mm\" "
           "viewBox=\"0 0 100 100\">\n" +
           std::string(body) + "\n</svg>\n";
}

inline ruche::Drawing draw(std::string_view body, const ruche::DrawingOptions& options = {}) {
    return read(on_page(body), options);
}

inline std::vector<std::string> ids(const ruche::Drawing& drawing) {
    std::vector<std::string> all;
    for (const ruche::Shape& shape : drawing.shapes) all.push_back(shape.id);
    return all;
}

inline bool warns(const ruche::Drawing& drawing, std::string_view text) {
    for (const std::string& warning : drawing.warnings) {
        if (warning.find(text) != std::string::npos) return true;
    }
    return false;
}

struct Extent {
    double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
};
inline Extent extent(const ruche::Region& region) {
    Extent e;
    for (const ruche::Polygon& polygon : region) {
        for (const ruche::Vec2& p : polygon.outer) {
            e.left = std::min(e.left, p.x());
            e.right = std::max(e.right, p.x());
            e.low = std::min(e.low, p.y());
            e.high = std::max(e.high, p.y());
        }
    }
    return e;
}

}  // namespace svg_text

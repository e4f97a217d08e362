#pragma once

#include <vector>

#include "ruche/pattern/drawing.hpp"
#include "ruche/pattern/svg_walk.hpp"

namespace ruche::svg {

/// Flattens, fills and strokes what is drawn. Warns about what covers nothing; throws InputError for
/// coordinates and amounts of detail that no drawing has.
std::vector<Shape> make_shapes(const SvgFile& file, const std::vector<DrawnItem>& items, const PageMap& page,
                               double tolerance_mm, Warnings& warnings);

/// The smallest box around everything that is covered; empty when nothing is.
struct Extent {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    bool empty() const { return !(low.x() <= high.x()); }
    void include(const Region& region);
};

}  // namespace ruche::svg

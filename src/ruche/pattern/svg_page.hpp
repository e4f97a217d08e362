#pragma once

#include <optional>

#include "ruche/geometry/vectors.hpp"
#include "ruche/pattern/svg_file.hpp"
#include "ruche/pattern/svg_walk.hpp"

namespace ruche::svg {

/// Coordinates beyond this (mm) are a mistake.
inline constexpr double largest_page = 1e5;

/// The page as the outermost svg element describes it.
struct Page {
    PageMap map;
    Vec2 size = Vec2::Zero();  ///< mm
};

/// From width, height, viewBox and preserveAspectRatio; `width_mm` > 0 sets the page's width whatever the
/// file says. Lengths without a physical unit count 96 to the inch, and a warning says what came of it. Empty
/// when the file does not say how large the page is. Throws InputError for sizes that are none.
std::optional<Page> page_of(const SvgFile& file, double width_mm, Warnings& warnings);

/// The page around the given drawing, for a file that knows none: `low` and `high` are the drawing's extent
/// at 96 px to the inch, y downwards negative (that is, under `PageMap` without shift).
Page page_around(const SvgFile& file, const Vec2& low, const Vec2& high, double width_mm, Warnings& warnings);

/// The map with which that extent is measured.
PageMap measuring_map();

}  // namespace ruche::svg

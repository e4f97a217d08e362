#pragma once

#include <string>

#include "ruche/pattern/generated_pattern.hpp"

namespace ruche {

struct SvgOptions {
    double page_margin = 5.0;  ///< mm of paper around everything drawn
    double thickness = 0.0;    ///< mm; if positive, noted in the description
    std::string generated_by = "ruche";
};

/// The pattern as an SVG that a person can go on drawing from: user units are mm, Inkscape layers "fabric",
/// "front" and "back", one stroked or filled path per strip with its id, the generator and its options as
/// <desc>. Seen from the printed side with y turned downwards as SVG wants, never mirrored. Coordinates have
/// six decimals (1 nm); the text depends on the pattern alone.
std::string to_svg(const GeneratedPattern& generated, const SvgOptions& options = {});

}  // namespace ruche

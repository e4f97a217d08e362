#pragma once

#include <span>
#include <string>
#include <vector>

#include "ruche/geometry/polygon.hpp"
#include "ruche/pattern/drawing.hpp"

namespace ruche {

enum class Side { front, back };

/// A piece of printed plastic.
struct Strip {
    std::string id;
    Region region;  ///< mm, in the layout seen from the printed (front) side
    std::vector<Polyline>
        centreline;          ///< of a stroked path: the path; of a region: midpoints of its cross-sections
    double thickness = 0.6;  ///< mm
    Side side = Side::front;
    double youngs_modulus = 0.0;  ///< MPa; 0 = the material card's plastic
};

/// What is printed on what: the fabric's outline on the frame (pre-stretched) and the strips, all inside it.
struct Pattern {
    Region fabric;
    std::vector<Strip> strips;
    std::vector<std::string> warnings;
};

/// Which drawn things mean what. `match` is compared with a shape's colours ("#ff0000", or a CSS name),
/// layer, class, id and label; the first rule that matches wins.
struct PrintRule {
    std::string match;
    enum class Role { strip, fabric_outline, ignore } role = Role::strip;
    double thickness = 0.6;
    Side side = Side::front;
    double youngs_modulus = 0.0;
};

struct PrintRules {
    std::vector<PrintRule> rules;
    double thickness = 0.6;  ///< of shapes that no rule matches, mm
    Side side = Side::front;
    bool fabric_from_outline = false;  ///< fabric_layer names shapes that bound the fabric; else a margin
    std::string fabric_layer;          ///< match text of the fabric outline's shapes
    double margin = 5.0;               ///< fabric beyond the print, mm; 0 = cut at the print's edge
};

/// Applies the rules, unites overlapping strips of one side (the thickest wins), cuts strips at the fabric's
/// edge, warns about each. Throws InputError when nothing is printed or a feature is narrower than 0.1 mm.
Pattern make_pattern(const Drawing& drawing, const PrintRules& rules);

/// The same checks, unions and cuts for strips that came from elsewhere (generators); `margin` as in
/// PrintRules when `pattern.fabric` is empty.
Pattern finish_pattern(Pattern pattern, double margin);

}  // namespace ruche

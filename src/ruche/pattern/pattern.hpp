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
    /// Of a stroked path: the path; of a region: midpoints of its cross-sections.
    std::vector<Polyline> centreline;
    bool centreline_found = false;  ///< it was made from the region, nobody drew it
    double thickness = 0.6;         ///< mm
    Side side = Side::front;
    double youngs_modulus = 0.0;  ///< MPa; 0 = the material card's plastic
};

/// What is printed on what: the fabric's outline on the frame (pre-stretched) and the strips, all inside it.
///
/// A finished pattern (from `make_pattern` or `finish_pattern`) is clean: strips of one side do not overlap,
/// borders that meet share their points exactly, points are at least `snap_mm` apart and from other borders.
struct Pattern {
    Region fabric;
    std::string outline_layer;  ///< the layer whose name alone made it the fabric's outline; else empty
    std::vector<Strip> strips;
    std::vector<std::string> warnings;
    double border_shift = 0.0;  ///< largest distance by which simplifying moved a printed border, mm
    double area_change = 0.0;   ///< printed area after simplifying over printed area before, minus 1
};

/// Points and borders closer than this become one: well below what a printer resolves, well above rounding.
inline constexpr double snap_mm = 0.005;
/// A printed feature narrower than this is an error.
inline constexpr double narrowest_feature_mm = 0.1;

/// Which drawn things mean what. `match` is compared with a shape's colours ("#ff0000", or a CSS name),
/// class, id and label, and with the names (labels, ids) of the layers and groups around it. The rule that
/// matches nearest wins: the shape itself before the innermost group, that before the next one outwards; of
/// several at one place the first.
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
    /// fabric_layer names shapes that bound the fabric; it goes before every rule. Else, unless a rule says
    /// what the outline is, a layer or group "fabric" (in any case of letters) whose shapes no rule matches
    /// bounds it; else a margin.
    bool fabric_from_outline = false;
    std::string fabric_layer;  ///< match text of the fabric outline's shapes
    double margin = 5.0;       ///< fabric beyond the print, mm; 0 = cut at the print's edge
    bool bare = false;         ///< nothing is printed, on purpose: shapes only say where the fabric is
};

/// Applies the rules and finishes the pattern. A fabric outline is made of closed curves, nested ones are
/// holes; without one the fabric is the print grown by the margin, holes filled (margin 0: exactly the
/// print). Throws InputError (with file, line and element) when nothing is printed, an outline is open or
/// crosses itself, a feature is narrower than `narrowest_feature_mm`, or a thickness is not a positive
/// number.
Pattern make_pattern(const Drawing& drawing, const PrintRules& rules);

/// The same checks, unions and cuts for strips that came from elsewhere (generators); `margin` as in
/// PrintRules when `pattern.fabric` is empty. In this order:
/// - strips of one side that overlap: the thicker keeps the place (the earlier of equals), a warning says so;
///   a remainder too narrow to print goes to it as well;
/// - what lies beyond the fabric is cut off, a warning says so;
/// - borders are snapped together (`snap_mm`) and simplified within 1 % of the strip's width, at most 0.02
/// mm;
///   `border_shift` and `area_change` report what that did;
/// - strips without centre lines get the midlines of their regions; centre lines are cut to the final region.
/// Throws InputError as make_pattern does; a pattern without strips needs `bare` and a fabric.
Pattern finish_pattern(Pattern pattern, double margin, bool bare = false);

}  // namespace ruche

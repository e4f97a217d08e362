#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ruche/geometry/border_graph.hpp"
#include "ruche/pattern/centreline.hpp"
#include "ruche/pattern/pattern.hpp"
#include "ruche/pattern/printability.hpp"

namespace ruche {

namespace {

constexpr double largest_shift = 0.02;        // mm, of a border by simplifying
constexpr double shift_per_width = 0.01;      // of a strip's width
constexpr double speck = snap_mm * snap_mm;   // mm^2: areas below are what snapping moves, not worth a word
constexpr double fabric_arc_tolerance = 0.1;  // mm: chords of about 2 mm around a margin of 5 mm

/// Collects what happened to many strips and says it in one sentence.
class Tally {
  public:
    void add(std::string what) { items_.push_back(std::move(what)); }

    void warn(std::vector<std::string>& warnings, const std::string& sentence) const {
        if (items_.empty()) return;
        constexpr std::size_t shown = 3;
        std::string list;
        for (std::size_t i = 0; i < std::min(shown, items_.size()); ++i) {
            list += (i ? ", " : "") + items_[i];
        }
        if (items_.size() > shown) list += fmt::format(" and {} more", items_.size() - shown);
        warnings.push_back(sentence + ": " + list);
    }

  private:
    std::vector<std::string> items_;
};

Region all_of(const std::vector<Strip>& strips) {
    std::vector<Region> regions;
    regions.reserve(strips.size());
    for (const Strip& strip : strips) regions.push_back(strip.region);
    return unite(regions);
}

Region fabric_around(const std::vector<Strip>& strips, double margin) {
    if (!(margin >= 0.0) || !std::isfinite(margin)) {
        throw InputError({.key = "margin"}, fmt::format("a fabric margin of {} mm", margin),
                         "Fabric beyond the print: 0 mm (cut at the print's edge) or more.");
    }
    const Region print = all_of(strips);
    if (margin == 0.0) return print;
    // A little farther and back: closes bays that narrow so much that their shores would touch.
    const double closing = 0.2 * margin;
    Region fabric = offset(simplify(print, largest_shift), margin + closing, fabric_arc_tolerance);
    for (Polygon& piece : fabric) piece.holes.clear();
    fabric = offset(unite({&fabric, 1}), -closing, fabric_arc_tolerance);
    for (Polygon& piece : fabric) piece.holes.clear();
    return fabric;
}

/// Makes the strips of one side disjoint: the thickest keep their place, then the earlier ones.
class Overlaps {
  public:
    Overlaps(std::vector<Strip>& strips, Side side) : strips_(strips) {
        for (int i = 0; i < static_cast<int>(strips.size()); ++i) {
            if (strips[i].side == side) order_.push_back(i);
        }
        std::stable_sort(order_.begin(), order_.end(),
                         [&](int a, int b) { return strips[a].thickness > strips[b].thickness; });
    }

    void resolve(Tally& united, Tally& covered) {
        std::vector<Box> boxes;
        for (std::size_t k = 0; k < order_.size(); ++k) {
            Strip& strip = strips_[order_[k]];
            boxes.push_back(bounding_box(strip.region));
            std::vector<int> over;  // strips that may lie over this one
            for (std::size_t j = 0; j < k; ++j) {
                if (boxes[j].overlaps(boxes[k])) over.push_back(order_[j]);
            }
            if (!over.empty()) yield_to(strip, over, united, covered);
        }
    }

  private:
    void yield_to(Strip& strip, const std::vector<int>& over, Tally& united, Tally& covered) {
        Region rest = strip.region;
        std::vector<int> winners;
        for (const int other : over) {
            Region without = subtract(rest, strips_[other].region);
            if (area(rest) - area(without) <= speck) continue;  // they only touch
            rest = std::move(without);
            winners.push_back(other);
        }
        if (winners.empty()) return;
        strip.region.clear();
        for (Polygon& piece : rest) {
            Region& owner = is_sliver(piece) ? strips_[neighbour(piece, winners)].region : strip.region;
            owner.push_back(std::move(piece));
        }
        std::string names;
        for (const int w : winners) names += (names.empty() ? "'" : ", '") + strips_[w].id + "'";
        (strip.region.empty() ? covered : united).add(fmt::format("'{}' by {}", strip.id, names));
    }

    // Which of the winners a remainder that is too narrow to print lies against.
    int neighbour(const Polygon& sliver, const std::vector<int>& winners) const {
        if (winners.size() == 1) return winners.front();
        const Region reach = offset({sliver}, snap_mm);
        int nearest = winners.front();
        double largest = 0.0;
        for (const int w : winners) {
            const double common = area(intersect(reach, strips_[w].region));
            if (common > largest) {
                largest = common;
                nearest = w;
            }
        }
        return nearest;
    }

    std::vector<Strip>& strips_;
    std::vector<int> order_;
};

void drop_empty(std::vector<Strip>& strips) {
    std::erase_if(strips, [](const Strip& strip) { return strip.region.empty(); });
}

void unite_overlaps(Pattern& pattern) {
    for (const Side side : {Side::front, Side::back}) {
        Tally united;
        Tally covered;
        Overlaps(pattern.strips, side).resolve(united, covered);
        const char* name = side == Side::front ? "front" : "back";
        united.warn(
            pattern.warnings,
            fmt::format("overlapping strips on the {} are united, the thickest (else the first) wins; "
                        "partly covered",
                        name));
        covered.warn(pattern.warnings,
                     fmt::format("strips on the {} are wholly covered by others and left out", name));
    }
    drop_empty(pattern.strips);
}

void cut_at_fabric(Pattern& pattern) {
    Tally cut;
    Tally lost;
    for (Strip& strip : pattern.strips) {
        const double before = area(strip.region);
        Region inside = intersect(strip.region, pattern.fabric);
        const double outside = before - area(inside);
        if (outside <= speck) continue;
        std::erase_if(inside, is_sliver);
        strip.region = std::move(inside);
        if (strip.region.empty()) {
            lost.add("'" + strip.id + "'");
        } else {
            cut.add(fmt::format("'{}' by {:.3g} mm^2", strip.id, outside));
        }
    }
    cut.warn(pattern.warnings, "strips are cut off at the edge of the fabric");
    lost.warn(pattern.warnings, "strips lie outside the fabric and are left out");
    drop_empty(pattern.strips);
}

double printed_area(const Pattern& pattern) {
    double sum = 0.0;
    for (const Strip& strip : pattern.strips) sum += area(strip.region);
    return sum;
}

void clean_borders(Pattern& pattern, double fabric_tolerance) {
    std::vector<Region> regions = {pattern.fabric};
    std::vector<double> tolerance = {fabric_tolerance};
    for (const Strip& strip : pattern.strips) {
        regions.push_back(strip.region);
        double width = largest_shift / shift_per_width;
        for (const Polygon& polygon : strip.region) width = std::min(width, strip_width(polygon));
        tolerance.push_back(shift_per_width * width);
    }
    const double before = printed_area(pattern);
    BorderGraph graph = border_graph(regions, snap_mm);
    const std::vector<double> shift = simplify_borders(graph, tolerance, snap_mm);
    pattern.border_shift = shift.size() > 1 ? *std::max_element(shift.begin() + 1, shift.end()) : 0.0;
    pattern.fabric = region_of(graph, 0);
    for (std::size_t i = 0; i < pattern.strips.size(); ++i) {
        pattern.strips[i].region = region_of(graph, static_cast<int>(i) + 1);
    }
    drop_empty(pattern.strips);
    pattern.area_change = before > 0.0 ? printed_area(pattern) / before - 1.0 : 0.0;
}

void add_missing_centrelines(std::vector<Strip>& strips) {
    for (Strip& strip : strips) {
        if (!strip.centreline.empty()) continue;
        strip.centreline_found = true;
        for (const Polygon& polygon : strip.region) strip.centreline.push_back(midline(polygon));
    }
}

void check_not_empty(const Pattern& pattern, const char* why) {
    if (!pattern.strips.empty()) return;
    throw InputError(
        {}, fmt::format("nothing is printed: {}", why),
        "Draw strips as strokes or filled shapes, check the rules that say what is printed, or set "
        "plastic = \"none\" for bare fabric.");
}

}  // namespace

Pattern finish_pattern(Pattern pattern, double margin, bool bare) {
    if (!bare) check_not_empty(pattern, "the pattern has no strips");
    for (const Strip& strip : pattern.strips) check_strip(strip, {.key = "strip '" + strip.id + "'"});
    add_missing_centrelines(pattern.strips);
    if (pattern.fabric.empty() && pattern.strips.empty()) {
        throw InputError({}, "there is neither a fabric outline nor a print to lay a margin around",
                         "Draw a closed curve and name it as the fabric's outline.");
    }
    const bool outline_given = !pattern.fabric.empty();
    if (!outline_given) pattern.fabric = fabric_around(pattern.strips, margin);
    unite_overlaps(pattern);
    if (outline_given) cut_at_fabric(pattern);
    if (!bare) check_not_empty(pattern, "all strips lie outside the fabric");
    // An outline that nobody drew needs not be followed closely.
    clean_borders(pattern, outline_given ? largest_shift
                                         : std::clamp(0.02 * margin, largest_shift, fabric_arc_tolerance));
    for (Strip& strip : pattern.strips) strip.centreline = cut_to_region(strip.centreline, strip.region);
    return pattern;
}

}  // namespace ruche

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "ruche/core/error.hpp"
#include "ruche/pattern/centreline.hpp"
#include "ruche/pattern/css_colour.hpp"
#include "ruche/pattern/fabric_outline.hpp"
#include "ruche/pattern/pattern.hpp"
#include "ruche/pattern/printability.hpp"
#include "ruche/pattern/svg_scanner.hpp"

namespace ruche {

namespace {

bool names(const std::string& match, const std::string& name) {
    if (name.empty()) return false;
    return match == name || (match.front() == '#' && match.compare(1, std::string::npos, name) == 0);
}

constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

// How far from the shape a rule takes hold: 0 is the shape's own colour (as CSS names it), class (".c"), id
// ("#i") or label, 1 the innermost name of what is around it, and so on outwards.
std::size_t distance_of_match(const Shape& shape, const std::string& match) {
    if (match.empty()) return nowhere;
    if (const std::optional<CssColour> colour = parse_css_colour(match)) {
        const std::string hex = hex_colour(*colour);
        if (shape.stroke_colour == hex || shape.fill_colour == hex) return 0;
    }
    if (names(match, shape.id) || names(match, shape.label)) return 0;
    const std::string name = match.front() == '.' ? match.substr(1) : match;
    if (std::ranges::find(shape.classes, name) != shape.classes.end()) return 0;
    const auto group =
        std::ranges::find_if(shape.groups, [&](const std::string& g) { return names(match, g); });
    if (group != shape.groups.end()) return 1 + static_cast<std::size_t>(group - shape.groups.begin());
    return names(match, shape.layer) ? 1 + shape.groups.size() : nowhere;
}

// Names are compared without regard to case, and what programs add to them is left out: the layers above in
// Rhino's "Kite::Fabric", the number in Illustrator's "Fabric_1_".
std::string plain_name(const std::string& name) {
    const std::size_t path = name.rfind("::");
    std::string plain = svg::lower_case(path == std::string::npos ? name : name.substr(path + 2));
    if (!plain.ends_with('_')) return plain;
    const std::size_t digits = plain.find_last_not_of("0123456789", plain.size() - 2);
    if (digits != std::string::npos && plain[digits] == '_' && digits + 2 < plain.size())
        plain.resize(digits);
    return plain;
}

// The layer (or group) "fabric" around a shape, as it is spelt there.
std::optional<std::string> fabric_layer_of(const Shape& shape) {
    const auto is_fabric = [](const std::string& name) { return plain_name(name) == "fabric"; };
    const auto group = std::ranges::find_if(shape.groups, is_fabric);
    if (group != shape.groups.end()) return *group;
    return is_fabric(shape.layer) ? std::optional<std::string>(shape.layer) : std::nullopt;
}

// The rule that takes hold nearest to the shape; of several at one place, the first.
const PrintRule* rule_for(const Shape& shape, const PrintRules& rules) {
    const PrintRule* nearest = nullptr;
    std::size_t smallest = nowhere;
    for (const PrintRule& rule : rules.rules) {
        const std::size_t distance = distance_of_match(shape, rule.match);
        if (distance >= smallest) continue;
        nearest = &rule;
        smallest = distance;
    }
    return nearest;
}

// Nobody said which shapes bound the fabric: a layer may do so by its name.
bool may_find_outline(const PrintRules& rules) {
    const auto bounds = [](const PrintRule& rule) { return rule.role == PrintRule::Role::fabric_outline; };
    return !rules.fabric_from_outline && std::ranges::none_of(rules.rules, bounds);
}

Region covered(const Shape& shape) {
    if (shape.filled.empty()) return shape.stroked;
    if (shape.stroked.empty()) return shape.filled;
    const std::vector<Region> both = {shape.filled, shape.stroked};
    return unite(both);
}

// Neither stroked nor filled: there is nothing to see, so nothing was meant to be printed.
bool invisible(const Shape& shape) {
    return shape.stroke_colour.empty() && shape.fill_colour.empty() && shape.stroked.empty() &&
           shape.filled.empty();
}

std::vector<Polyline> centre_of(const Shape& shape) {
    std::vector<Polyline> lines;
    if (!shape.filled.empty()) {
        for (const Polygon& polygon : shape.filled) lines.push_back(midline(polygon));
        return lines;
    }
    for (std::size_t i = 0; i < shape.lines.size(); ++i) {
        lines.push_back(shape.lines[i]);
        if (shape.closed[i] && !shape.lines[i].empty()) lines.back().push_back(shape.lines[i].front());
    }
    return lines;
}

/// Gives every strip a name of its own: "a", "a (2)", ...
class Names {
  public:
    std::string own(const std::string& id) {
        std::string name = id;
        for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{} ({})", id, i);
        return name;
    }

  private:
    std::set<std::string> taken_;
};

// What the drawing offers to match, a sentence for a message.
std::string offered(const Drawing& drawing) {
    std::set<std::string> names;
    for (const Shape& shape : drawing.shapes) {
        for (const std::string& name : {shape.layer, shape.stroke_colour, shape.fill_colour}) {
            if (!name.empty()) names.insert(name);
        }
    }
    std::string list;
    int count = 0;
    for (const std::string& name : names) {
        if (++count > 12) {
            list += ", ...";
            break;
        }
        list += (list.empty() ? "" : ", ") + name;
    }
    return list.empty() ? "The drawing has no layers and no colours."
                        : "The drawing has the layers and colours " + list + ".";
}

struct Sorted {
    std::vector<Strip> strips;
    std::vector<const Shape*> outline;
    std::string found_layer;         ///< that the outline was taken from for its name
    std::vector<Region> everything;  ///< that is visible and not ignored
};

Sorted sort_shapes(const Drawing& drawing, const PrintRules& rules) {
    Sorted sorted;
    Names names;
    const PrintRule others{.thickness = rules.thickness, .side = rules.side};
    const bool may_find = may_find_outline(rules);
    for (const Shape& shape : drawing.shapes) {
        const PrintRule* found = rule_for(shape, rules);
        const PrintRule& rule = found != nullptr ? *found : others;
        const bool named =
            rules.fabric_from_outline && distance_of_match(shape, rules.fabric_layer) != nowhere;
        if (named || rule.role == PrintRule::Role::fabric_outline) {
            sorted.outline.push_back(&shape);
            continue;
        }
        if (const auto layer = may_find && found == nullptr ? fabric_layer_of(shape) : std::nullopt) {
            sorted.outline.push_back(&shape);
            sorted.found_layer = *layer;
            continue;
        }
        if (rule.role == PrintRule::Role::ignore || invisible(shape)) continue;
        Strip strip{.id = names.own(shape.id),
                    .region = covered(shape),
                    .centreline = centre_of(shape),
                    .centreline_found = !shape.filled.empty(),
                    .thickness = rule.thickness,
                    .side = rule.side,
                    .youngs_modulus = rule.youngs_modulus};
        if (rules.bare) {
            sorted.everything.push_back(std::move(strip.region));
            continue;
        }
        check_strip(strip, {drawing.file, shape.line, "element '" + shape.id + "'"});
        sorted.strips.push_back(std::move(strip));
    }
    return sorted;
}

std::string why_outline(const Sorted& sorted) {
    if (sorted.found_layer.empty()) return {};
    return fmt::format(" Layer '{}' is taken as the fabric's outline for its name: rename it if it is not.",
                       sorted.found_layer);
}

Region outline_of(const Sorted& sorted, const std::string& file) {
    try {
        return fabric_outline(sorted.outline, file);
    } catch (const InputError& error) {
        throw InputError(error.place(), error.problem(), error.advice() + why_outline(sorted));
    }
}

void check_found(const Drawing& drawing, const PrintRules& rules, const Sorted& sorted) {
    if (rules.fabric_from_outline && sorted.outline.empty()) {
        throw InputError({.file = drawing.file},
                         fmt::format("no shape matches the fabric outline '{}'", rules.fabric_layer),
                         offered(drawing));
    }
    if (!rules.bare && sorted.strips.empty()) {
        throw InputError(
            {.file = drawing.file},
            drawing.shapes.empty() ? "nothing is printed: the drawing has no visible lines or shapes"
                                   : "nothing is printed: the rules leave no shape as a strip",
            fmt::format("Draw strips as strokes or filled shapes, or set plastic = \"none\" for bare "
                        "fabric. {}{}",
                        offered(drawing), why_outline(sorted)));
    }
}

}  // namespace

Pattern make_pattern(const Drawing& drawing, const PrintRules& rules) {
    Sorted sorted = sort_shapes(drawing, rules);
    check_found(drawing, rules, sorted);
    Pattern pattern{.fabric = outline_of(sorted, drawing.file),
                    .outline_layer = sorted.found_layer,
                    .strips = std::move(sorted.strips),
                    .warnings = drawing.warnings};
    if (rules.bare && pattern.fabric.empty()) {
        pattern.fabric = offset(unite(sorted.everything), rules.margin, 0.1);
    }
    try {
        return finish_pattern(std::move(pattern), rules.margin, rules.bare);
    } catch (const InputError& error) {
        if (!error.place().file.empty()) throw;
        throw InputError({drawing.file, error.place().line, error.place().key}, error.problem(),
                         error.advice());
    }
}

}  // namespace ruche

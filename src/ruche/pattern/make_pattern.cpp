#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "ruche/core/error.hpp"
#include "ruche/pattern/centreline.hpp"
#include "ruche/pattern/css_colour.hpp"
#include "ruche/pattern/fabric_outline.hpp"
#include "ruche/pattern/pattern.hpp"
#include "ruche/pattern/printability.hpp"

namespace ruche {

namespace {

// A rule names a colour as CSS does, or exactly a layer, class (".c"), id ("#i") or label.
bool matches(const Shape& shape, const std::string& match) {
    if (match.empty()) return false;
    if (const std::optional<Colour> colour = parse_css_colour(match)) {
        const std::string hex = hex_colour(*colour);
        if (shape.stroke_colour == hex || shape.fill_colour == hex) return true;
    }
    if (match == shape.layer || match == shape.id || match == shape.label) return true;
    if (match.front() == '#' && match.compare(1, std::string::npos, shape.id) == 0) return true;
    const std::string name = match.front() == '.' ? match.substr(1) : match;
    return std::find(shape.classes.begin(), shape.classes.end(), name) != shape.classes.end();
}

PrintRule rule_for(const Shape& shape, const PrintRules& rules) {
    if (rules.fabric_from_outline && matches(shape, rules.fabric_layer)) {
        return {.match = rules.fabric_layer, .role = PrintRule::Role::fabric_outline};
    }
    for (const PrintRule& rule : rules.rules) {
        if (matches(shape, rule.match)) return rule;
    }
    return {.match = {}, .thickness = rules.thickness, .side = rules.side};
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

// What the drawing offers to match, for a message.
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
        if (++count > 12) return list + ", ...";
        list += (list.empty() ? "" : ", ") + name;
    }
    return list.empty() ? "none" : list;
}

struct Sorted {
    std::vector<Strip> strips;
    std::vector<const Shape*> outline;
    std::vector<Region> everything;  ///< that is visible and not ignored
};

Sorted sort_shapes(const Drawing& drawing, const PrintRules& rules) {
    Sorted sorted;
    Names names;
    for (const Shape& shape : drawing.shapes) {
        const PrintRule rule = rule_for(shape, rules);
        if (rule.role == PrintRule::Role::ignore) continue;
        if (rule.role == PrintRule::Role::fabric_outline) {
            sorted.outline.push_back(&shape);
            continue;
        }
        if (invisible(shape)) continue;
        Strip strip{.id = names.own(shape.id),
                    .region = covered(shape),
                    .centreline = centre_of(shape),
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

void check_found(const Drawing& drawing, const PrintRules& rules, const Sorted& sorted) {
    if (rules.fabric_from_outline && sorted.outline.empty()) {
        throw InputError({.file = drawing.file},
                         fmt::format("no shape matches the fabric outline '{}'", rules.fabric_layer),
                         fmt::format("The drawing has the layers and colours {}.", offered(drawing)));
    }
    if (!rules.bare && sorted.strips.empty()) {
        throw InputError(
            {.file = drawing.file},
            drawing.shapes.empty() ? "nothing is printed: the drawing has no visible lines or shapes"
                                   : "nothing is printed: the rules leave no shape as a strip",
            fmt::format("Draw strips as strokes or filled shapes, or set plastic = \"none\" for bare "
                        "fabric. The drawing has the layers and colours {}.",
                        offered(drawing)));
    }
}

}  // namespace

Pattern make_pattern(const Drawing& drawing, const PrintRules& rules) {
    Sorted sorted = sort_shapes(drawing, rules);
    check_found(drawing, rules, sorted);
    Pattern pattern{.fabric = fabric_outline(sorted.outline, drawing.file),
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

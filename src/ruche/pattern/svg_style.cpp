#include "ruche/pattern/svg_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

/// "url(#id) fallback".
std::optional<Paint> parse_server(std::string_view text) {
    const std::size_t close = text.find(')');
    if (close == std::string_view::npos) return std::nullopt;
    std::string_view target = trimmed(text.substr(4, close - 4));
    if (target.size() >= 2 && (target.front() == '"' || target.front() == '\'')) {
        target = target.substr(1, target.size() - 2);
    }
    Paint paint;
    paint.kind = Paint::Kind::server;
    paint.server = target.starts_with('#') ? target.substr(1) : target;
    if (const std::optional<CssColour> colour = parse_css_colour(text.substr(close + 1))) {
        paint.colour = *colour;
        paint.fallback = true;
    }
    return paint;
}

std::optional<Paint> parse_paint(std::string_view text) {
    const std::string lower = lower_case(text);
    if (lower == "none" || lower == "context-fill" || lower == "context-stroke") return Paint{};
    if (lower == "currentcolor") return Paint{Paint::Kind::current_colour, {}, {}, false};
    if (lower.starts_with("url(")) return parse_server(text);
    const std::optional<CssColour> colour = parse_css_colour(text);
    if (!colour) return std::nullopt;
    return Paint{Paint::Kind::colour, *colour, {}, false};
}

template <class Value>
struct Keyword {
    std::string_view name;
    Value value;
};

template <class Value, std::size_t count>
std::optional<Value> parse_keyword(std::string_view text, const Keyword<Value> (&keywords)[count]) {
    const std::string lower = lower_case(text);
    for (const Keyword<Value>& keyword : keywords) {
        if (keyword.name == lower) return keyword.value;
    }
    return std::nullopt;
}

constexpr Keyword<FillRule> fill_rules[] = {{"nonzero", FillRule::nonzero}, {"evenodd", FillRule::evenodd}};
constexpr Keyword<LineCap> caps[] = {
    {"butt", LineCap::butt}, {"round", LineCap::round}, {"square", LineCap::square}};
constexpr Keyword<LineJoin> joins[] = {{"miter", LineJoin::miter},
                                       {"round", LineJoin::round},
                                       {"bevel", LineJoin::bevel},
                                       {"miter-clip", LineJoin::miter},
                                       {"arcs", LineJoin::miter}};
constexpr Keyword<bool> visibilities[] = {{"visible", true}, {"hidden", false}, {"collapse", false}};

std::optional<double> parse_not_negative(std::string_view text, double whole) {
    const std::optional<Length> length = parse_length(text);
    if (!length) return std::nullopt;
    const double px = length->px(whole);
    return px >= 0.0 ? std::optional<double>(px) : std::nullopt;
}

std::optional<double> parse_miter_limit(std::string_view text) {
    const std::optional<double> value = parse_number(text);
    return value && *value >= 1.0 ? value : std::nullopt;
}

std::optional<std::vector<double>> parse_dashes(std::string_view text, double whole) {
    std::vector<double> dashes;
    text = trimmed(text);
    if (lower_case(text) == "none") return dashes;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of(", \t\r\n"), text.size());
        const std::optional<double> dash = parse_not_negative(text.substr(0, end), whole);
        if (!dash) return std::nullopt;
        dashes.push_back(*dash);
        text = trimmed(text.substr(end));
        if (text.starts_with(',')) text = trimmed(text.substr(1));
    }
    if (std::accumulate(dashes.begin(), dashes.end(), 0.0) <= 0.0) return std::vector<double>();
    if (dashes.size() % 2 == 1) {
        const std::vector<double> once = dashes;
        dashes.insert(dashes.end(), once.begin(), once.end());
    }
    return dashes;
}

std::optional<double> parse_offset(std::string_view text, double whole) {
    const std::optional<Length> length = parse_length(text);
    return length ? std::optional<double>(length->px(whole)) : std::nullopt;
}

/// Sets the style's members from declared values, one property after the other.
class Setter {
  public:
    Setter(const Declared& own, const Complain& complain) : own_(own), complain_(complain) {}

    /// `name` and `what` are for the complaint; `parse` turns the text into an optional value.
    template <class Value, class Parse>
    bool set(Property property, std::string_view name, Value& member, const Value& initial,
             const Parse& parse) {
        const auto entry = own_.find(property);
        if (entry == own_.end()) return false;
        const std::string lower = entry->second.size() < 10 ? lower_case(entry->second) : std::string();
        if (lower == "inherit" || lower == "unset" || lower == "revert") return false;
        if (lower == "initial") {
            member = initial;
            return true;
        }
        std::optional<Value> value = parse(std::string_view(entry->second));
        if (!value) {
            const std::string_view start = std::string_view(entry->second).substr(0, 60);
            complain_(fmt::format("{}: '{}' cannot be read: ignored", name, start));
            return false;
        }
        member = std::move(*value);
        return true;
    }

  private:
    const Declared& own_;
    const Complain& complain_;
};

bool declares(const Declared& own, Property property, std::string_view value) {
    const auto entry = own.find(property);
    return entry != own.end() && lower_case(entry->second) == value;
}

void set_markers(Style& style, const Declared& own) {
    for (const Property property :
         {Property::marker, Property::marker_start, Property::marker_mid, Property::marker_end}) {
        const auto entry = own.find(property);
        if (entry == own.end() || entry->second == "inherit") continue;
        if (entry->second.starts_with("url(")) {
            style.markers = entry->second;
        } else if (property == Property::marker) {
            style.markers.clear();
        }
    }
}

}  // namespace

Style inherit(const Style& parent, const Declared& own, double diagonal, const Complain& complain) {
    const Style initial;
    Style style = parent;
    style.displayed = !declares(own, Property::display, "none");
    style.non_scaling_stroke = declares(own, Property::vector_effect, "non-scaling-stroke");
    if (own.empty()) return style;

    Setter setter(own, complain);
    const auto length = [&](std::string_view text) { return parse_not_negative(text, diagonal); };
    const auto fraction = [](std::string_view text) { return parse_fraction(text); };
    const auto keyword = [](const auto& keywords) {
        return [&keywords](std::string_view text) { return parse_keyword(text, keywords); };
    };
    double opacity = 1.0;
    setter.set(Property::opacity, "opacity", opacity, 1.0, fraction);
    if (opacity <= 0.0) style.displayed = false;
    if (setter.set(Property::fill, "fill", style.fill, initial.fill, parse_paint)) style.fill_given = true;
    setter.set(Property::fill_rule, "fill-rule", style.fill_rule, initial.fill_rule, keyword(fill_rules));
    setter.set(Property::fill_opacity, "fill-opacity", style.fill_opacity, 1.0, fraction);
    setter.set(Property::stroke, "stroke", style.stroke, initial.stroke, parse_paint);
    setter.set(Property::stroke_opacity, "stroke-opacity", style.stroke_opacity, 1.0, fraction);
    setter.set(Property::stroke_width, "stroke-width", style.stroke_width, initial.stroke_width, length);
    setter.set(Property::stroke_linecap, "stroke-linecap", style.cap, initial.cap, keyword(caps));
    setter.set(Property::stroke_linejoin, "stroke-linejoin", style.join, initial.join, keyword(joins));
    setter.set(Property::stroke_miterlimit, "stroke-miterlimit", style.miter_limit, initial.miter_limit,
               parse_miter_limit);
    setter.set(Property::stroke_dasharray, "stroke-dasharray", style.dashes, initial.dashes,
               [&](std::string_view text) { return parse_dashes(text, diagonal); });
    setter.set(Property::stroke_dashoffset, "stroke-dashoffset", style.dash_offset, 0.0,
               [&](std::string_view text) { return parse_offset(text, diagonal); });
    if (!declares(own, Property::color, "currentcolor")) {
        setter.set(Property::color, "color", style.colour, initial.colour, parse_css_colour);
    }
    setter.set(Property::visibility, "visibility", style.visible, true, keyword(visibilities));
    set_markers(style, own);
    return style;
}

std::optional<CssColour> painted(const Paint& paint, double opacity, const Style& style,
                                 const std::function<std::optional<CssColour>(const Paint&)>& server_colour) {
    if (opacity <= 0.0) return std::nullopt;
    std::optional<CssColour> colour;
    switch (paint.kind) {
        case Paint::Kind::none:
            break;
        case Paint::Kind::colour:
            colour = paint.colour;
            break;
        case Paint::Kind::current_colour:
            colour = style.colour;
            break;
        case Paint::Kind::server:
            colour = server_colour(paint);
            break;
    }
    if (colour && colour->alpha <= 0.0) return std::nullopt;
    return colour;
}

}  // namespace ruche::svg

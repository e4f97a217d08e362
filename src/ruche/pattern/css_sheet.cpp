#include "ruche/pattern/css_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

constexpr std::pair<std::string_view, Property> property_names[] = {
    {"clip-path", Property::clip_path},
    {"color", Property::color},
    {"display", Property::display},
    {"fill", Property::fill},
    {"fill-opacity", Property::fill_opacity},
    {"fill-rule", Property::fill_rule},
    {"filter", Property::filter},
    {"marker", Property::marker},
    {"marker-end", Property::marker_end},
    {"marker-mid", Property::marker_mid},
    {"marker-start", Property::marker_start},
    {"mask", Property::mask},
    {"opacity", Property::opacity},
    {"stop-color", Property::stop_color},
    {"stroke", Property::stroke},
    {"stroke-dasharray", Property::stroke_dasharray},
    {"stroke-dashoffset", Property::stroke_dashoffset},
    {"stroke-linecap", Property::stroke_linecap},
    {"stroke-linejoin", Property::stroke_linejoin},
    {"stroke-miterlimit", Property::stroke_miterlimit},
    {"stroke-opacity", Property::stroke_opacity},
    {"stroke-width", Property::stroke_width},
    {"transform", Property::transform},
    {"transform-origin", Property::transform_origin},
    {"vector-effect", Property::vector_effect},
    {"visibility", Property::visibility},
};

std::optional<Property> property_named(std::string_view name) {
    const auto* found =
        std::lower_bound(std::begin(property_names), std::end(property_names), name,
                         [](const auto& known, std::string_view n) { return known.first < n; });
    if (found == std::end(property_names) || found->first != name) return std::nullopt;
    return found->second;
}

/// Up to the first of `ends` that stands outside of quotes and brackets; npos when there is none.
std::size_t find_outside(std::string_view text, std::string_view ends, std::size_t from) {
    char quote = '\0';
    int depth = 0;
    for (std::size_t i = from; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\\') {
            ++i;
        } else if (quote != '\0') {
            if (c == quote) quote = '\0';
        } else if (depth == 0 && ends.find(c) != std::string_view::npos) {
            return i;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '(' || c == '[') {
            ++depth;
        } else if ((c == ')' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return std::string_view::npos;
}

std::string without_comments(std::string_view css) {
    std::string clean;
    clean.reserve(css.size());
    std::size_t i = 0;
    while (i < css.size()) {
        if (css.substr(i).starts_with("/*")) {
            const std::size_t end = css.find("*/", i + 2);
            i = end == std::string_view::npos ? css.size() : end + 2;
            clean += ' ';
        } else if (css.substr(i).starts_with("<!--") || css.substr(i).starts_with("-->")) {
            i += css[i] == '<' ? 4 : 3;
        } else {
            clean += css[i++];
        }
    }
    return clean;
}

/// Past the closing brace that belongs to the opening one at `open`.
std::size_t past_block(std::string_view css, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < css.size(); ++i) {
        if (css[i] == '{') ++depth;
        if (css[i] == '}' && --depth == 0) return i + 1;
    }
    return css.size();
}

constexpr std::size_t longest_class = 2048;  // a bound on the work that a hostile file can ask for

std::string_view class_text(const pugi::xml_node& element) {
    return std::string_view(element.attribute("class").value()).substr(0, longest_class);
}

bool has_class(const pugi::xml_node& element, std::string_view name) {
    std::string_view rest = class_text(element);
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find_first_of(" \t\r\n\f"), rest.size());
        if (rest.substr(0, end) == name) return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

std::string clipped(std::string_view text) {
    text = trimmed(text);
    constexpr std::size_t most = 60;
    return text.size() <= most ? std::string(text) : fmt::format("{}...", text.substr(0, most - 3));
}

}  // namespace

std::string_view local_name(const pugi::xml_node& element) {
    std::string_view name = element.name();
    const std::size_t colon = name.find(':');
    if (colon == std::string_view::npos) return name;
    // Only the usual prefix is taken off: every other namespace is somebody else's.
    return name.substr(0, colon) == "svg" ? name.substr(colon + 1) : name;
}

std::vector<std::string> class_names(const pugi::xml_node& element) {
    std::vector<std::string> names;
    std::string_view rest = trimmed(class_text(element));
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find_first_of(" \t\r\n\f"), rest.size());
        names.emplace_back(rest.substr(0, end));
        rest = trimmed(rest.substr(end));
    }
    return names;
}

std::vector<Declaration> parse_declarations(std::string_view text) {
    std::string clean;
    if (text.find("/*") != std::string_view::npos) {
        clean = without_comments(text);
        text = clean;
    }
    std::vector<Declaration> declarations;
    std::size_t first = 0;
    while (first < text.size()) {
        const std::size_t end = std::min(find_outside(text, ";", first), text.size());
        const std::string_view piece = text.substr(first, end - first);
        first = end + 1;
        const std::size_t colon = piece.find(':');
        if (colon == std::string_view::npos) continue;
        const auto property = property_named(lower_case(trimmed(piece.substr(0, colon))));
        if (!property) continue;
        std::string_view value = trimmed(piece.substr(colon + 1));
        const std::size_t bang = value.rfind('!');
        const bool important =
            bang != std::string_view::npos && lower_case(trimmed(value.substr(bang + 1))) == "important";
        if (important) value = trimmed(value.substr(0, bang));
        if (!value.empty()) declarations.push_back({*property, std::string(value), important});
    }
    return declarations;
}

/// Reads one selector, such as "g.layer > path#a".
class StyleSheet::SelectorReader {
  public:
    explicit SelectorReader(std::string_view text) : text_(trimmed(text)) {}

    std::optional<Rule> run() {
        Rule rule;
        bool child = false;
        while (i_ < text_.size()) {
            std::optional<Compound> compound = one_compound(rule.specificity);
            if (!compound) return std::nullopt;
            compound->child = child;
            rule.compounds.push_back(std::move(*compound));
            const std::size_t gap = i_;
            skip_space();
            child = i_ < text_.size() && text_[i_] == '>';
            if (child) ++i_;
            skip_space();
            if (i_ == gap && i_ < text_.size()) return std::nullopt;
        }
        if (rule.compounds.empty() || child || rule.compounds.size() > 64) return std::nullopt;
        return rule;
    }

  private:
    std::optional<Compound> one_compound(std::uint32_t& specificity) {
        Compound compound;
        const std::size_t first = i_;
        if (text_[i_] == '*') {
            ++i_;
        } else {
            compound.type = name();
            if (!compound.type.empty()) specificity += 1;
        }
        while (i_ < text_.size() && std::string_view("#.[").find(text_[i_]) != std::string_view::npos) {
            const char kind = text_[i_++];
            if (kind == '[') {
                if (!attribute(compound)) return std::nullopt;
                specificity += 1U << 10U;
                continue;
            }
            const std::string value = name();
            if (value.empty()) return std::nullopt;
            (kind == '#' ? compound.ids : compound.classes).push_back(value);
            specificity += kind == '#' ? 1U << 20U : 1U << 10U;
        }
        if (i_ == first) return std::nullopt;
        return compound;
    }

    bool attribute(Compound& compound) {
        const std::string key = name();
        if (key.empty()) return false;
        if (i_ < text_.size() && text_[i_] == ']') {
            ++i_;
            compound.present.push_back(key);
            return true;
        }
        if (i_ >= text_.size() || text_[i_] != '=') return false;
        const std::size_t end = find_outside(text_, "]", i_ + 1);
        if (end == std::string_view::npos) return false;
        std::string_view value = trimmed(text_.substr(i_ + 1, end - i_ - 1));
        const bool quoted = value.size() >= 2 && (value.front() == '"' || value.front() == '\'');
        if (quoted) value = value.substr(1, value.size() - 2);
        compound.attributes.emplace_back(key, value);
        i_ = end + 1;
        return true;
    }

    std::string name() {
        std::string result;
        while (i_ < text_.size()) {
            const char c = text_[i_];
            const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                               c == '-' || c == '_' || static_cast<unsigned char>(c) >= 0x80U;
            if (c == '\\' && i_ + 1 < text_.size()) {
                ++i_;  // a character escaped as such; hexadecimal escapes do not occur in practice
            } else if (!plain) {
                break;
            }
            result += text_[i_++];
        }
        return result;
    }
    void skip_space() {
        while (i_ < text_.size() && is_space(text_[i_])) ++i_;
    }

    std::string_view text_;
    std::size_t i_ = 0;
};

std::vector<std::string> StyleSheet::add(std::string_view css) {
    std::vector<std::string> problems;
    const std::string clean = without_comments(css);
    const std::string_view text = clean;
    std::size_t i = 0;
    while (i < text.size()) {
        const std::size_t stop = find_outside(text, "{};", i);
        if (stop == std::string_view::npos) {
            if (!trimmed(text.substr(i)).empty()) problems.push_back("'" + clipped(text.substr(i)) + "'");
            break;
        }
        const std::string_view head = trimmed(text.substr(i, stop - i));
        if (text[stop] != '{') {
            // "@import ...;" or a stray brace or semicolon.
            if (!head.empty() && !head.starts_with("@charset") && !head.starts_with("@namespace")) {
                problems.push_back("'" + clipped(head) + "'");
            }
            i = stop + 1;
            continue;
        }
        const std::size_t end = past_block(text, stop);
        const std::size_t body_end = text[end - 1] == '}' ? end - 1 : end;
        if (!head.starts_with("@")) {
            add_block(head, text.substr(stop + 1, body_end - stop - 1), problems);
        } else if (!head.starts_with("@font-face")) {
            problems.push_back("'" + clipped(head) + "'");
        }
        i = end;
    }
    return problems;
}

void StyleSheet::add_block(std::string_view selectors, std::string_view body,
                           std::vector<std::string>& problems) {
    blocks_.push_back(parse_declarations(body));
    std::size_t first = 0;
    while (first <= selectors.size()) {
        const std::size_t end = std::min(find_outside(selectors, ",", first), selectors.size());
        const std::string_view text = trimmed(selectors.substr(first, end - first));
        first = end + 1;
        std::optional<Rule> rule = SelectorReader(text).run();
        if (!rule) {
            // Rules that could not matter here (":hover" on text, say) are no news.
            if (!blocks_.back().empty()) problems.push_back("selector '" + clipped(text) + "'");
            continue;
        }
        rule->declarations = blocks_.size() - 1;
        const Compound& last = rule->compounds.back();
        std::string key = last.type.empty() ? "*" : last.type;
        if (!last.classes.empty()) key = "." + last.classes.front();
        if (!last.ids.empty()) key = "#" + last.ids.front();
        by_key_[key].push_back(rules_.size());
        rules_.push_back(std::move(*rule));
    }
}

bool StyleSheet::matches(const Compound& compound, const pugi::xml_node& element) {
    if (!compound.type.empty() && compound.type != local_name(element)) return false;
    const auto is_id = [&](const std::string& id) { return id == element.attribute("id").value(); };
    const auto is_class = [&](const std::string& name) { return has_class(element, name); };
    const auto is_equal = [&](const auto& pair) {
        return element.attribute(pair.first.c_str()).value() == pair.second;
    };
    const auto is_present = [&](const std::string& name) { return bool(element.attribute(name.c_str())); };
    return std::all_of(compound.ids.begin(), compound.ids.end(), is_id) &&
           std::all_of(compound.classes.begin(), compound.classes.end(), is_class) &&
           std::all_of(compound.attributes.begin(), compound.attributes.end(), is_equal) &&
           std::all_of(compound.present.begin(), compound.present.end(), is_present);
}

bool StyleSheet::matches(const Rule& rule, const pugi::xml_node& element) const {
    ++effort_;
    if (!matches(rule.compounds.back(), element)) return false;
    const std::size_t count = rule.compounds.size();
    if (count == 1) return true;
    std::vector<pugi::xml_node> chain;  // from the element up
    for (pugi::xml_node node = element; node.type() == pugi::node_element; node = node.parent()) {
        chain.push_back(node);
    }
    // Bit k: compounds 0..k match with k at this element (or at any above it). Forward along the chain, so
    // that the work is bounded by its length times the number of compounds.
    std::uint64_t above = 0, at_parent = 0;
    for (auto node = chain.rbegin(); node != chain.rend(); ++node) {
        std::uint64_t here = 0;
        effort_ += count;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint64_t before = std::uint64_t{1} << (k - (k > 0 ? 1 : 0));
            const bool reached = k == 0 || ((rule.compounds[k].child ? at_parent : above) & before) != 0;
            if (reached && matches(rule.compounds[k], *node)) here |= std::uint64_t{1} << k;
        }
        at_parent = here;
        above |= here;
    }
    return (at_parent >> (count - 1) & 1U) != 0;
}

std::vector<std::size_t> StyleSheet::candidates(const pugi::xml_node& element) const {
    std::vector<std::size_t> found;
    const auto look_up = [&](const std::string& key) {
        const auto entry = by_key_.find(key);
        if (entry != by_key_.end()) found.insert(found.end(), entry->second.begin(), entry->second.end());
    };
    look_up("*");
    look_up(std::string(local_name(element)));
    look_up("#" + std::string(element.attribute("id").value()));
    std::vector<std::string> classes = class_names(element);
    std::sort(classes.begin(), classes.end());
    classes.erase(std::unique(classes.begin(), classes.end()), classes.end());
    for (const std::string& name : classes) look_up("." + name);
    return found;
}

Declared StyleSheet::declared(const pugi::xml_node& element, std::string_view style_attribute) const {
    enum Origin { presentation_attribute, sheet, style, important = 4 };
    struct Candidate {
        unsigned origin;
        std::uint32_t specificity;
        std::size_t order;
        Declaration declaration;
    };
    std::vector<Candidate> all;
    const auto put = [&](unsigned origin, std::uint32_t specificity, const Declaration& declaration) {
        const unsigned raised = origin + (declaration.important ? unsigned{important} : 0U);
        all.push_back({raised, specificity, all.size(), declaration});
    };
    for (const pugi::xml_attribute& attribute : element.attributes()) {
        const auto property = property_named(attribute.name());
        const std::string_view value = trimmed(attribute.value());
        if (property && !value.empty()) put(presentation_attribute, 0, {*property, std::string(value)});
    }
    if (!rules_.empty()) {
        std::vector<std::size_t> found = candidates(element);
        std::sort(found.begin(), found.end());
        for (const std::size_t index : found) {
            const Rule& rule = rules_[index];
            if (!matches(rule, element)) continue;
            for (const Declaration& d : blocks_[rule.declarations]) put(sheet, rule.specificity, d);
        }
    }
    for (const Declaration& d : parse_declarations(style_attribute)) put(style, 0, d);
    std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.origin, a.specificity, a.order) < std::tie(b.origin, b.specificity, b.order);
    });
    Declared result;
    for (Candidate& candidate : all) {
        result[candidate.declaration.property] = std::move(candidate.declaration.value);
    }
    return result;
}

}  // namespace ruche::svg

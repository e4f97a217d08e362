#include "ruche/pattern/svg_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "ruche/pattern/svg_elements.hpp"
#include "ruche/pattern/svg_geometry.hpp"
#include "ruche/pattern/svg_scanner.hpp"

namespace ruche::svg {

namespace {

constexpr std::size_t most_items = 50000;
constexpr std::size_t most_use_visits = 100000;

/// What holds for the children of an element.
struct Context {
    Affine to_mm;
    Style style;
    Vec2 viewport = Vec2::Zero();
    std::string layer;
    bool in_layer = false;  ///< an Inkscape layer, which mere groups do not hide
    std::vector<std::string> groups;
    std::string use_id, use_label;  ///< of the use elements on the way
    pugi::xml_node use_target;
    int depth = 0;
};

/// An element with its own style and transform applied.
struct Entered {
    Affine to_mm;
    Style style;
};

class Walker {
  public:
    Walker(const SvgFile& file, const PageMap& page, Warnings& warnings)
        : file_(file), page_(page), warnings_(warnings) {}

    std::vector<DrawnItem> run() {
        Context context;
        context.to_mm = page_.to_mm;
        context.viewport = page_.user_size;
        const pugi::xml_node root = file_.root();
        const Entered entered = enter(root, context);
        if (entered.style.displayed) {
            children(root, inside(root, context, entered));
        } else {
            warn(root, "is hidden: nothing is printed");
        }
        return std::move(items_);
    }

  private:
    /// What stays the same however often an element is used.
    struct Known {
        Declared declared;
        Affine transform;
        std::shared_ptr<const Outline> path;  ///< of elements whose geometry knows no percentages
    };

    void warn(const pugi::xml_node& node, const std::string& text) { warnings_.add(file_.place(node), text); }
    Remark remark_on(const pugi::xml_node& node) {
        return [this, node](const std::string& text) { warn(node, text); };
    }

    void element(const pugi::xml_node& node, const Context& context);
    void children(const pugi::xml_node& node, const Context& context) {
        for (const pugi::xml_node& child : node.children()) element(child, context);
    }
    void use(const pugi::xml_node& node, Context context);
    /// A nested svg or a symbol: it has a viewport of its own. `instance` is the use element, if any.
    void viewport(const pugi::xml_node& node, Context context, const pugi::xml_node& instance);
    void shape(const pugi::xml_node& node, const Context& context, const Entered& entered);

    Known& known(const pugi::xml_node& node);
    Affine own_transform(const pugi::xml_node& node, const Declared& declared);
    Entered enter(const pugi::xml_node& node, const Context& context);
    Context inside(const pugi::xml_node& node, const Context& context, const Entered& entered);
    bool conditions_hold(const pugi::xml_node& node) const;
    bool refers_to_itself(const pugi::xml_node& node, const pugi::xml_node& target) const;
    std::optional<CssColour> server_colour(const pugi::xml_node& node, const char* what, const Paint& paint);
    void remark_on_effects(const pugi::xml_node& node, const Declared& declared);
    void remark_on_units(const pugi::xml_node& node, const char* name, const std::string& text,
                         const Affine& to_mm);
    void identify(DrawnItem& item, const Context& context) const;

    const SvgFile& file_;
    const PageMap& page_;
    Warnings& warnings_;
    std::vector<DrawnItem> items_;
    std::unordered_map<const pugi::xml_node_struct*, Known> known_;
    std::unordered_map<const pugi::xml_node_struct*, std::optional<CssColour>> gradients_;
    std::vector<pugi::xml_node> used_;  ///< targets that are being drawn
    std::size_t use_visits_ = 0;
    bool said_units_ = false;
};

void Walker::element(const pugi::xml_node& node, const Context& context) {
    if (node.type() != pugi::node_element) return;
    if (context.depth > deepest_nesting) {
        throw InputError(file_.place(node),
                         fmt::format("elements and uses are nested more than {} deep", deepest_nesting),
                         "Ungroup the drawing, or export it again.");
    }
    if (!used_.empty() && ++use_visits_ > most_use_visits) {
        throw InputError(file_.place(node),
                         fmt::format("use elements repeat more than {} elements", most_use_visits),
                         "A drawing repeats itself that often only by mistake; expand or remove its clones.");
    }
    const Kind kind = kind_of(local_name(node));
    if (kind == Kind::silent || !conditions_hold(node)) return;
    if (kind == Kind::unknown) {
        warn(node, "is no element that can be printed: ignored");
        return;
    }
    const Entered entered = enter(node, context);
    if (!entered.style.displayed) {
        warn(node, "is hidden: not printed");
        return;
    }
    switch (kind) {
        case Kind::shape:
            shape(node, context, entered);
            break;
        case Kind::use:
            use(node, inside(node, context, entered));
            break;
        case Kind::svg:
            viewport(node, inside(node, context, entered), {});
            break;
        case Kind::switch_:
            for (const pugi::xml_node& child : node.children()) {
                if (child.type() != pugi::node_element || !conditions_hold(child)) continue;
                element(child, inside(node, context, entered));
                break;
            }
            break;
        case Kind::not_printed:
            if (entered.style.visible) {
                const std::string_view name = local_name(node);
                const bool text = name == "text" || name == "flowRoot";
                warn(node, text ? "text is not printed; convert it to paths" : "is not printed");
            }
            break;
        default:
            children(node, inside(node, context, entered));
    }
}

bool Walker::conditions_hold(const pugi::xml_node& node) const {
    // No extension is known here; of languages, English.
    if (!trimmed(node.attribute("requiredExtensions").value()).empty()) return false;
    const std::string language = lower_case(node.attribute("systemLanguage").value());
    return trimmed(language).empty() || language.find("en") != std::string::npos;
}

Walker::Known& Walker::known(const pugi::xml_node& node) {
    const auto [entry, fresh] = known_.try_emplace(node.internal_object());
    Known& data = entry->second;
    if (!fresh) return data;
    data.declared = file_.declared(node);
    data.transform = own_transform(node, data.declared);
    remark_on_effects(node, data.declared);
    const std::string_view name = local_name(node);
    if (name == "path" || name == "polyline" || name == "polygon") {
        data.path = std::make_shared<Outline>(shape_outline(node, Vec2::Zero(), remark_on(node)));
    }
    return data;
}

Affine Walker::own_transform(const pugi::xml_node& node, const Declared& declared) {
    const auto text = declared.find(Property::transform);
    if (text == declared.end()) return {};
    const std::optional<Affine> transform = parse_transform(text->second);
    if (!transform) {
        warn(node, fmt::format("transform: '{}' cannot be read: ignored", text->second.substr(0, 60)));
        return {};
    }
    const auto origin = declared.find(Property::transform_origin);
    if (origin == declared.end()) return *transform;
    Scanner scanner(origin->second);
    const std::optional<double> x = scanner.number();
    if (scanner.word() == "px" || x) scanner.skip_separator();
    const std::optional<double> y = x ? scanner.number() : std::nullopt;
    const std::string_view unit = scanner.word();
    if (!y || (!unit.empty() && unit != "px") || !scanner.at_end()) {
        warn(node, fmt::format("transform-origin: '{}' is not two lengths in px: ignored",
                               origin->second.substr(0, 60)));
        return *transform;
    }
    const Vec2 centre(*x, *y);
    return translation(centre) * *transform * translation(-centre);
}

void Walker::remark_on_effects(const pugi::xml_node& node, const Declared& declared) {
    static constexpr std::pair<Property, const char*> effects[] = {
        {Property::clip_path, "clip-path"}, {Property::mask, "mask"}, {Property::filter, "filter"}};
    for (const auto& [property, name] : effects) {
        const auto value = declared.find(property);
        if (value == declared.end() || !value->second.starts_with("url(")) continue;
        warn(node, fmt::format("{} {} is ignored: what it would hide is printed", name,
                               value->second.substr(0, 60)));
    }
}

void Walker::remark_on_units(const pugi::xml_node& node, const char* name, const std::string& text,
                             const Affine& to_mm) {
    if (said_units_) return;
    const std::optional<Length> length = parse_length(text);
    if (!length || !length->physical()) return;
    const double factor = stretches(to_mm.linear).largest / mm_per_px;
    if (std::abs(factor - 1.0) < 1e-3) return;
    said_units_ = true;
    warn(node, fmt::format("{}: '{}' is {:.4g} mm on paper: it is scaled with the drawing around it, as SVG "
                           "prescribes. A number without unit is in the drawing's own units",
                           name, text, length->px(0.0) * factor * mm_per_px));
}

Entered Walker::enter(const pugi::xml_node& node, const Context& context) {
    const Known& data = known(node);
    const Affine to_mm = context.to_mm * data.transform;
    const auto width = data.declared.find(Property::stroke_width);
    if (width != data.declared.end()) remark_on_units(node, "stroke-width", width->second, to_mm);
    return {to_mm,
            inherit(context.style, data.declared, viewport_diagonal(context.viewport), remark_on(node))};
}

Context Walker::inside(const pugi::xml_node& node, const Context& context, const Entered& entered) {
    Context inner = context;
    inner.to_mm = entered.to_mm;
    inner.style = entered.style;
    inner.depth += 1;
    if (local_name(node) == "use") return inner;
    const std::string label = label_of(node), id = node.attribute("id").value();
    const bool layer = std::string_view(node.attribute("inkscape:groupmode").value()) == "layer";
    const std::string& name = label.empty() ? id : label;
    // Groups inside a clone's original name a motif, not where the clone lies.
    const bool by_group = !inner.in_layer && (!inner.use_target || inner.layer.empty());
    if (!name.empty() && (layer || by_group)) inner.layer = name;
    inner.in_layer = inner.in_layer || layer;
    if (!id.empty() && id != label) inner.groups.insert(inner.groups.begin(), id);
    if (!label.empty()) inner.groups.insert(inner.groups.begin(), label);
    return inner;
}

bool Walker::refers_to_itself(const pugi::xml_node& node, const pugi::xml_node& target) const {
    for (pugi::xml_node at = node; at; at = at.parent()) {
        if (at == target) return true;
    }
    return std::find(used_.begin(), used_.end(), target) != used_.end();
}

void Walker::use(const pugi::xml_node& node, Context context) {
    const pugi::xml_node target = file_.referenced(node);
    if (!target) {
        warn(node,
             fmt::format("there is no element '{}' in this file: not printed", href(node).substr(0, 60)));
        return;
    }
    if (refers_to_itself(node, target)) {
        warn(node, fmt::format("refers to itself by '{}': not printed", href(node).substr(0, 60)));
        return;
    }
    const Remark remark = remark_on(node);
    const Vec2 shift(length_attribute(node, "x", context.viewport.x(), 0.0, remark),
                     length_attribute(node, "y", context.viewport.y(), 0.0, remark));
    context.to_mm = context.to_mm * translation(shift);
    const std::string id = node.attribute("id").value(), label = label_of(node);
    if (!id.empty()) context.use_id += (context.use_id.empty() ? "" : "/") + id;
    if (!label.empty()) context.use_label = label;
    context.use_target = target;
    used_.push_back(target);
    const std::string_view name = local_name(target);
    if (name == "symbol" || name == "svg") {
        const Entered entered = enter(target, context);
        if (entered.style.displayed) viewport(target, inside(target, context, entered), node);
    } else {
        element(target, context);
    }
    used_.pop_back();
}

void Walker::viewport(const pugi::xml_node& node, Context context, const pugi::xml_node& instance) {
    const Remark remark = remark_on(node);
    const Vec2 outer = context.viewport;
    const Vec2 corner(length_attribute(node, "x", outer.x(), 0.0, remark),
                      length_attribute(node, "y", outer.y(), 0.0, remark));
    const auto extent = [&](const char* name, double whole) {
        const double own = length_attribute(node, name, whole, whole, remark);
        return instance ? length_attribute(instance, name, whole, own, remark) : own;
    };
    Vec2 size(extent("width", outer.x()), extent("height", outer.y()));
    context.to_mm = context.to_mm * translation(corner);
    if (const pugi::xml_attribute text = node.attribute("viewBox")) {
        const std::optional<Box> box = parse_view_box(text.value());
        if (!box || !(box->size.minCoeff() > 0.0)) {
            warn(node, fmt::format("viewBox: '{}' is not four numbers with a size: not printed",
                                   std::string_view(text.value()).substr(0, 60)));
            return;
        }
        const std::string_view aspect = node.attribute("preserveAspectRatio").value();
        std::optional<Affine> fit = fit_view_box(*box, size, aspect);
        if (!fit) {
            warn(node,
                 fmt::format("preserveAspectRatio: '{}' cannot be read: ignored", aspect.substr(0, 60)));
            fit = fit_view_box(*box, size, "");
        }
        context.to_mm = context.to_mm * *fit;
        size = box->size;
    }
    if (!(size.minCoeff() > 0.0)) {
        warn(node, "a width or height that is not positive: not printed");
        return;
    }
    context.viewport = size;
    children(node, context);
}

std::optional<CssColour> Walker::server_colour(const pugi::xml_node& node, const char* what,
                                               const Paint& paint) {
    const pugi::xml_node server = file_.by_id(paint.server);
    if (!server && paint.fallback) return paint.colour;
    const auto [entry, fresh] = gradients_.try_emplace(server.internal_object());
    if (fresh) entry->second = plain_gradient(file_, server);
    if (entry->second) return entry->second;
    warn(node, fmt::format("the {0} is no plain colour (url(#{1})): the {0} is not printed", what,
                           paint.server.substr(0, 60)));
    return std::nullopt;
}

void Walker::shape(const pugi::xml_node& node, const Context& context, const Entered& entered) {
    if (!entered.style.visible) {
        warn(node, "is hidden: not printed");
        return;
    }
    if (items_.size() >= most_items) {
        throw InputError(file_.place(node), fmt::format("the drawing has more than {} shapes", most_items),
                         "Leave out what is not to be printed, or combine shapes into paths.");
    }
    DrawnItem item;
    item.node = node;
    item.outline = known(node).path;
    if (!item.outline) {
        item.outline = std::make_shared<Outline>(shape_outline(node, context.viewport, remark_on(node)));
        for (const pugi::xml_attribute& attribute : node.attributes()) {
            static constexpr std::string_view lengths[] = {"width", "height", "r", "rx", "x2", "y2"};
            const bool is_length =
                std::find(std::begin(lengths), std::end(lengths), attribute.name()) != std::end(lengths);
            if (is_length) remark_on_units(node, attribute.name(), attribute.value(), entered.to_mm);
        }
    }
    if (item.outline->empty()) return;
    item.to_mm = entered.to_mm;
    item.style = entered.style;
    item.fill = painted(item.style.fill, item.style.fill_opacity, item.style,
                        [&](const Paint& paint) { return server_colour(node, "fill", paint); });
    if (item.style.stroke_width > 0.0) {
        item.stroke = painted(item.style.stroke, item.style.stroke_opacity, item.style,
                              [&](const Paint& paint) { return server_colour(node, "stroke", paint); });
    }
    if (!item.style.markers.empty()) warn(node, "its markers are not printed");
    identify(item, context);
    items_.push_back(std::move(item));
}

void Walker::identify(DrawnItem& item, const Context& context) const {
    const std::string id = item.node.attribute("id").value();
    item.label = label_of(item.node);
    item.layer = context.layer;
    item.groups = context.groups;
    item.id = id.empty() ? item.label : id;
    if (context.use_target != item.node) {
        if (context.use_id.empty()) return;
        if (item.id.empty()) item.id = fmt::format("{}-{}", local_name(item.node), items_.size() + 1);
        item.id = context.use_id + "/" + item.id;
        return;
    }
    // A clone of one shape goes by its own names.
    if (!context.use_id.empty()) item.id = context.use_id;
    if (!context.use_label.empty()) item.label = context.use_label;
}

}  // namespace

std::vector<DrawnItem> drawn_items(const SvgFile& file, const PageMap& page, Warnings& warnings) {
    return Walker(file, page, warnings).run();
}

}  // namespace ruche::svg

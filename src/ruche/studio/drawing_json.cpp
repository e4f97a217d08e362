#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "ruche/core/document.hpp"
#include "ruche/material/cards.hpp"
#include "ruche/output/palette.hpp"
#include "ruche/pattern/generator_registry.hpp"
#include "ruche/pattern/svg_export.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/studio/scene_request.hpp"

namespace ruche {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

void append_loop(std::string& path, const Polyline& loop) {
    char step = 'M';
    for (const Vec2& p : loop) {
        fmt::format_to(std::back_inserter(path), "{}{:.3f} {:.3f}", step, p.x(), p.y());
        step = 'L';
    }
    path += 'Z';
}

std::string path_of(const Region& region) {
    std::string path;
    for (const Polygon& polygon : region) {
        append_loop(path, polygon.outer);
        for (const Polyline& hole : polygon.holes) append_loop(path, hole);
    }
    return path;
}

Json to_json(const FieldValue& value) {
    return std::visit([](const auto& v) { return Json(v); }, value);
}

Json values_of(const Scene& scene) {
    Json values = Json::object();
    for_each_section(scene, [&]<class Section>(const std::string& name, const Section& section) {
        for (const Field<Section>& field : fields<Section>())
            values[name + "." + std::string(field.key)] = to_json(get(section, field));
    });
    return values;
}

/// Colours and layers by which a rule could tell shapes apart, in the order of the drawing.
Json marks_of(const Drawing& drawing) {
    std::vector<std::pair<std::string, const char*>> order;
    std::map<std::string, int> count;
    const auto add = [&](const std::string& mark, const char* kind) {
        if (!mark.empty() && count[mark]++ == 0) order.emplace_back(mark, kind);
    };
    for (const Shape& shape : drawing.shapes) {
        add(shape.stroke_colour.empty() ? shape.fill_colour : shape.stroke_colour, "colour");
        add(shape.layer, "layer");
    }
    Json marks = Json::array();
    for (const auto& [mark, kind] : order)
        marks.push_back({{"match", mark}, {"kind", kind}, {"count", count[mark]}});
    return marks;
}

Json rules_of(const Scene& scene) {
    Json rules = Json::array();
    for (const PrintRule& rule : scene.plastic.rules) {
        Json entry = Json::object();
        for (const Field<PrintRule>& field : fields<PrintRule>())
            entry[std::string(field.key)] = to_json(get(rule, field));
        rules.push_back(std::move(entry));
    }
    return rules;
}

GeneratedPattern generated(const Scene& scene) {
    return generate(scene.pattern.generator, resolved_generator_options(scene), {.key = "pattern.options"});
}

/// A field's range and kind, for an input.
Json described(const FieldInfo& field) {
    static constexpr std::array kinds = {"number",      "integer",       "boolean", "text",
                                         "two_numbers", "three_numbers", "choice"};
    Json json = {{"key", field.key},
                 {"unit", field.unit},
                 {"kind", kinds[static_cast<std::size_t>(field.kind)]},
                 {"meaning", field.meaning}};
    if (std::isfinite(field.low)) json["low"] = field.low;
    if (std::isfinite(field.high)) json["high"] = field.high;
    if (!field.names.empty())
        json["names"] = std::vector<std::string>(field.names.begin(), field.names.end());
    return json;
}

Json described_sections() {
    Json sections = Json::array();
    const Scene defaults;
    for_each_section(defaults, [&]<class Section>(const std::string& name, const Section& section) {
        Json list = Json::array();
        for (const Field<Section>& field : fields<Section>()) {
            list.push_back(described(info(field)));
            list.back()["value"] = to_json(get(section, field));
        }
        sections.push_back({{"name", name}, {"fields", std::move(list)}});
    });
    return sections;
}

Json described_generators() {
    Json list = Json::array();
    for (const GeneratorInfo& generator : generators()) {
        Json options = Json::array();
        for (const GeneratorOption& option : generator.options) {
            options.push_back(described(option.field));
            options.back()["value"] = option.initial;
        }
        list.push_back(
            {{"name", generator.name}, {"summary", generator.summary}, {"options", std::move(options)}});
    }
    return list;
}

Json described_cards(const Workspace& workspace) {
    Json list = Json::array();
    for (const std::string& name : preset_names())
        list.push_back({{"name", name}, {"description", load_card(name).description}});
    for (const std::string& name : workspace.cards())
        list.push_back({{"name", name}, {"description", "in this folder"}});
    return list;
}

}  // namespace

std::string drawing_json(const Scene& scene) {
    Json json;
    json["name"] = scene_name(scene);
    json["values"] = values_of(scene);
    json["rules"] = rules_of(scene);
    json["warnings"] = scene.warnings;
    if (!scene.pattern.mesh.empty()) return dumped(json);  // a mesh has no outlines to draw
    const Pattern pattern = scene_pattern(scene);
    const Box box = bounding_box(pattern.fabric);
    json["box"] = {box.low.x(), box.low.y(), box.high.x(), box.high.y()};
    json["fabric"] = path_of(pattern.fabric);
    Json strips = Json::array();
    for (const Strip& strip : pattern.strips)
        strips.push_back({{"id", strip.id},
                          {"side", strip.side == Side::front ? "front" : "back"},
                          {"thickness_mm", strip.thickness},
                          {"path", path_of(strip.region)}});
    json["strips"] = std::move(strips);
    for (const std::string& warning : pattern.warnings) json["warnings"].push_back(warning);
    json["marks"] =
        marks_of(scene.pattern.svg.empty() ? to_drawing(generated(scene))
                                           : read_drawing(resolved_path(scene, scene.pattern.svg)));
    return dumped(json);
}

std::string drawing_svg(const Scene& scene) {
    constexpr std::size_t longest = 256U << 20U;
    if (!scene.pattern.svg.empty())
        return read_file(resolved_path(scene, scene.pattern.svg), "drawing", longest);
    if (scene.pattern.generator.empty())
        throw InputError({.key = "pattern.mesh"}, "this scene has a mesh, and no drawing");
    return to_svg(generated(scene));
}

std::string form_json(const Workspace& workspace) {
    return dumped({{"version", RUCHE_VERSION},
                   {"folder", workspace.root().string()},
                   {"colours",
                    {{"fabric", css(palette::fabric)},
                     {"plasticFront", css(palette::plastic_front)},
                     {"plasticBack", css(palette::plastic_back)},
                     {"alarm", css(palette::alarm)}}},
                   {"sections", described_sections()},
                   {"generators", described_generators()},
                   {"cards", described_cards(workspace)},
                   {"drawings", workspace.drawings()},
                   {"scenes", workspace.scenes()},
                   {"scans", workspace.scans()}});
}

}  // namespace ruche

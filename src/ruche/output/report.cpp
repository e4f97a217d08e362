#include "ruche/output/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ruche/output/metrics.hpp"

namespace ruche {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order in which a person wants to read it

Json to_json(const FieldValue& value) {
    return std::visit([](const auto& v) { return Json(v); }, value);
}

Json to_json(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Where a value was set: "kite.toml:14", else what the card or the program says.
std::string source_of(const Scene& scene, const std::string& section, const FieldInfo& field) {
    const std::string path = section + "." + std::string(field.key);
    if (const auto set = scene.sources.find(path); set != scene.sources.end()) {
        const Place& place = set->second;
        return to_string(Place{place.file, place.line, place.file.empty() ? place.key : ""});
    }
    if (section == "material") {
        const auto known = scene.material_sources.find(std::string(bare_name(field)));
        if (known != scene.material_sources.end()) return known->second;
    }
    return "default";
}

/// {"thickness_mm": {"value": 0.6, "unit": "mm", "source": "kite.toml:9"}, ...}
template <class Struct>
Json parameters_of(const Scene& scene, const std::string& section, const Struct& s) {
    Json json = Json::object();
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        json[std::string(about.key)] = {{"value", to_json(get(s, field))},
                                        {"unit", std::string(about.unit)},
                                        {"source", source_of(scene, section, about)}};
    }
    return json;
}

/// Values alone: what stands in a list of the scene was given there.
template <class Struct>
Json values_of(const std::vector<Struct>& list) {
    Json json = Json::array();
    for (const Struct& s : list) {
        Json entry = Json::object();
        for (const Field<Struct>& field : fields<Struct>())
            entry[std::string(field.key)] = to_json(get(s, field));
        json.push_back(std::move(entry));
    }
    return json;
}

/// A support or a force: its own fields and those of what it takes hold of.
template <class Struct>
Json values_with_selection(const std::vector<Struct>& list) {
    Json json = values_of(list);
    for (std::size_t i = 0; i < list.size(); ++i)
        json[i].update(values_of(std::vector<Selection>{list[i]})[0]);
    return json;
}

Json all_parameters(const Scene& scene) {
    Json json = Json::object();
    for_each_section(
        scene, [&](const char* section, const auto& s) { json[section] = parameters_of(scene, section, s); });
    json["pattern"]["options"] = scene.pattern.generator_options;
    json["plastic"]["none"] = scene.plastic.none;
    json["plastic"]["rule"] = values_of(scene.plastic.rules);
    json["support"] = values_with_selection(scene.supports);
    json["force"] = values_with_selection(scene.forces);
    return json;
}

Json state_of(const Equilibrium& equilibrium) {
    const EnergyTerms& energy = equilibrium.energy;
    Json json;
    json["status"] = name_of(equilibrium.status);
    json["stable"] = equilibrium.stable;
    json["message"] = equilibrium.message;
    json["energy_mJ"] = {{"total", energy.total()},
                         {"fabric_membrane", energy.fabric_membrane},
                         {"fabric_bending", energy.fabric_bending},
                         {"plastic", energy.plastic},
                         {"gravity", energy.gravity},
                         {"contact", energy.contact}};
    json["residual_N"] = equilibrium.residual;
    json["typical_force_N"] = equilibrium.typical_force;
    return json;
}

/// Where the sheet passes through itself: at most `most` places, spread over all pairs of triangles.
Json places_of(const Result& result) {
    constexpr std::size_t most = 20;
    const std::vector<Intersection>& all = result.self_intersections;
    const std::size_t count = std::min(all.size(), most);
    Json json = Json::array();
    for (std::size_t i = 0; i < count; ++i) {
        const Intersection& at = all[i * all.size() / count];
        Json layout = Json::array();
        Json strips = Json::array();
        for (const int t : at.triangles) {
            const Triangle& tri = result.layout.mesh.triangles[static_cast<std::size_t>(t)];
            Vec2 centre = Vec2::Zero();
            for (const int v : tri) centre += result.layout.mesh.vertices[static_cast<std::size_t>(v)] / 3.0;
            layout.push_back({centre.x(), centre.y()});
            const int strip = main_strip(result.layout, t);
            strips.push_back(strip < 0 ? Json()
                                       : Json(result.layout.strips[static_cast<std::size_t>(strip)].id));
        }
        json.push_back({{"place_mm", to_json(at.place)},
                        {"triangles", at.triangles},
                        {"layout_mm", layout},
                        {"strips", strips}});
    }
    return json;
}

Json health_of(const Result& result) {
    const Health& health = result.equilibrium.health;
    return {{"max_strain_margin", health.max_strain_margin},
            {"min_area_ratio", health.min_area_ratio},
            {"max_dihedral_deg", health.max_dihedral_deg},
            {"max_edge_rotation_deg", health.max_edge_rotation_deg},
            {"elements_beyond_law", health.beyond_law},
            {"tangled", health.tangled},
            {"self_intersections", health.self_intersections},
            {"contact_pairs", health.contact_pairs},
            {"smallest_gap_mm", health.smallest_gap},  // infinite when nothing touches: becomes null
            {"self_intersection_places", places_of(result)}};
}

Json strips_of(const Result& result) {
    Json json = Json::array();
    for (const StripMetrics& m : measure_strips(result.layout, result.shape)) {
        json.push_back({{"id", m.id},
                        {"curvature_per_mm", m.curvature},
                        {"radius_mm", m.radius},  // infinite when flat: becomes null
                        {"fit_rms_mm", m.fit_rms},
                        {"stretch", m.stretch},
                        {"printed_length_mm", m.printed_length}});
    }
    return json;
}

Json shape_of(const Result& result) {
    const ShapeMetrics m = measure_shape(result.layout, result.shape);
    return {{"box_min_mm", to_json(m.box_min)},
            {"box_max_mm", to_json(m.box_max)},
            {"box_size_mm", to_json(m.box_max - m.box_min)},
            {"area_mm2", m.area},
            {"layout_area_mm2", m.layout_area},
            {"printed_area_mm2", m.printed_area}};
}

Json alternatives_of(const ShapeList& list) {
    Json shapes = Json::array();
    for (const ShapeEntry& shape : list.shapes) {
        const double lowest = list.shapes.front().energy;
        shapes.push_back({{"folder", alternative_folder(shape.number)},
                          {"energy_mJ", shape.energy},
                          {"above_lowest", lowest == 0.0 ? 0.0 : (shape.energy - lowest) / std::abs(lowest)},
                          {"ordinary", shape.ordinary},
                          {"found_from", shape.found_from}});
    }
    return {{"shapes", shapes},
            {"symmetries", list.symmetries},
            {"starts", list.starts},
            {"starts_without_result", list.without_result},
            {"interrupted", list.interrupted}};
}

Json levels_of(const Equilibrium& equilibrium) {
    Json levels = Json::array();
    for (const LevelEffort& level : equilibrium.levels) {
        levels.push_back({{"triangles", level.triangles},
                          {"iterations", level.iterations},
                          {"factorizations", level.factorizations},
                          {"residuals_N", level.residuals}});
    }
    return levels;
}

}  // namespace

std::string alternative_folder(int number) { return fmt::format("alternatives/{}", number); }

std::string report_json(const Result& result) {
    const Equilibrium& equilibrium = result.equilibrium;
    Json json = state_of(equilibrium);
    json["mesh"] = {{"vertices", result.layout.mesh.vertex_count()},
                    {"triangles", result.layout.mesh.triangle_count()},
                    {"unknowns", equilibrium.x.size()}};
    json["solver"] = {{"iterations", equilibrium.iterations},
                      {"factorizations", equilibrium.factorizations},
                      {"seconds", equilibrium.seconds},
                      {"levels", levels_of(equilibrium)}};
    json["health"] = health_of(result);
    json["shape"] = shape_of(result);
    json["strips"] = strips_of(result);
    if (result.alternatives) json["alternatives"] = alternatives_of(*result.alternatives);
    json["assumptions"] = result.assumptions;
    json["warnings"] = result.warnings;
    json["parameters"] = all_parameters(result.scene);
    json["seconds"] = result.seconds;
    json["scene"] = result.scene.file;
    json["version"] = RUCHE_VERSION;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ruche

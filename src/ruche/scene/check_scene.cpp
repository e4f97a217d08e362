#include "ruche/scene/check_scene.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ruche/material/cards.hpp"

namespace ruche {

Place place_in(const Scene& scene, const std::string& key) {
    const auto found = scene.sources.find(key);
    return found != scene.sources.end() ? found->second : Place{.file = scene.file, .key = key};
}

static void check_pattern(const Scene& scene) {
    const PatternSource& pattern = scene.pattern;
    std::vector<std::string> given;
    if (!pattern.svg.empty()) given.emplace_back("svg");
    if (!pattern.mesh.empty()) given.emplace_back("mesh");
    if (!pattern.generator.empty()) given.emplace_back("generator");
    if (given.empty())
        throw InputError(
            place_in(scene, "pattern"), "there is nothing to simulate",
            "[pattern] has one of svg = \"drawing.svg\", mesh = \"mesh.ply\" and generator = \"radial\".");
    if (given.size() > 1)
        throw InputError(place_in(scene, "pattern." + given[1]), "contradicts pattern." + given[0],
                         "Give one of svg, mesh and generator.");
    const auto only_for = [&](bool used, const std::string& key, const std::string& source) {
        if (used && given[0] != source)
            throw InputError(
                place_in(scene, key),
                fmt::format("means nothing with pattern.{}, only with pattern.{}", given[0], source));
    };
    only_for(!pattern.thickness_table.empty(), "pattern.thickness_table", "mesh");
    only_for(pattern.width_mm > 0, "pattern.width_mm", "svg");
    if (!pattern.generator_options.empty())
        only_for(true, "pattern.options." + pattern.generator_options.begin()->first, "generator");
    if (given[0] != "mesh") return;
    if (scene.plastic.back_thickness_factor != 1.0)
        throw InputError(place_in(scene, "plastic.back_thickness_factor"),
                         "means nothing with pattern.mesh, which says for each triangle what is printed");
    if (!scene.plastic.rules.empty())
        throw InputError(place_in(scene, "plastic.rule.1.match"),
                         "means nothing with pattern.mesh, which says for each triangle what is printed");
    if (!scene.fabric.outline.empty())
        throw InputError(place_in(scene, "fabric.outline"), "means nothing with pattern.mesh");
}

static void check_selection(const Scene& scene, const Selection& selection, const std::string& path) {
    if (selection.where == Selection::Where::point) return;
    for (std::size_t i = 0; i < 2; ++i)
        if (selection.min_mm[i] > selection.max_mm[i])
            throw InputError(place_in(scene, path + ".min_mm"),
                             fmt::format("the box is inside out: min_mm {} is larger than max_mm {}",
                                         selection.min_mm[i], selection.max_mm[i]));
}

static void check_support(const Scene& scene, const SupportOptions& support, const std::string& path) {
    check_selection(scene, support, path);
    const std::string directions = "xyz";
    const bool known = support.fix.find_first_not_of(directions) == std::string::npos;
    if (!known || support.fix.empty())
        throw InputError(place_in(scene, path + ".fix"),
                         fmt::format("\"{}\" is not made of the directions x, y and z", support.fix));
    for (std::size_t i = 0; i < 3; ++i)
        if (support.move_mm[i] != 0 && support.fix.find(directions[i]) == std::string::npos)
            throw InputError(place_in(scene, path + ".move_mm"),
                             fmt::format("moves along {0}, but fix = \"{1}\" does not hold {0}",
                                         directions[i], support.fix));
}

static void check_gravity(const Scene& scene) {
    const GravityOptions& gravity = scene.gravity;
    const auto& g = gravity.acceleration_mm_per_s2;
    const bool pulls = g[0] != 0 || g[1] != 0 || g[2] != 0;
    if (gravity.table && !pulls)
        throw InputError(place_in(scene, "gravity.table"), "a table holds nothing without gravity",
                         "On earth, with the front up: acceleration_mm_per_s2 = [0, 0, -9810].");
    if (!gravity.table && gravity.table_height_mm != 0)
        throw InputError(place_in(scene, "gravity.table_height_mm"),
                         "there is no table; set gravity.table = true");
    if (pulls && !gravity.table && scene.supports.empty())
        throw InputError(place_in(scene, "gravity.acceleration_mm_per_s2"),
                         "gravity without a support or a table: the sheet would fall for ever",
                         "Add a [[support]], or gravity.table = true.");
    double push = 0.0;
    for (const ForceOptions& force : scene.forces)
        for (const double component : force.force_n) push += std::abs(component);
    if (push > 0 && scene.supports.empty())
        throw InputError(place_in(scene, "force.1.force_n"),
                         "a force without a support: the sheet would fly away", "Add a [[support]].");
}

static void check_material(const Scene& scene) {
    const Material& m = scene.material;
    check_prestretch(m, scene.fabric.prestretch, place_in(scene, "fabric.prestretch"));
    const bool limp = m.alpha_1 + m.beta_1 == 0 || m.alpha_2 + m.beta_2 == 0;
    if (limp && (m.neo_hookean_share == 0 || m.fabric_youngs_modulus == 0))
        throw InputError(place_in(scene, "material.alpha_1_mpa"), "the fabric has no stiffness at all",
                         "Give alpha or beta for both axes, or a neo_hookean_share above 0.");
}

template <class Section>
static void check_ranges(const Scene& scene, const Section& section, const std::string& path) {
    for (const Field<Section>& field : fields<Section>())
        check(info(field), get(section, field), place_in(scene, path + "." + std::string(field.key)));
}

void check_scene(const Scene& scene) {
    for_each_section(scene, [&]<class Section>(const std::string& name, const Section& section) {
        check_ranges(scene, section, name);
    });
    for (std::size_t i = 0; i < scene.plastic.rules.size(); ++i)
        check_ranges(scene, scene.plastic.rules[i], fmt::format("plastic.rule.{}", i + 1));
    check_pattern(scene);
    check_material(scene);
    for (std::size_t i = 0; i < scene.supports.size(); ++i) {
        const std::string path = fmt::format("support.{}", i + 1);
        check_ranges<Selection>(scene, scene.supports[i], path);
        check_ranges(scene, scene.supports[i], path);
        check_support(scene, scene.supports[i], path);
    }
    for (std::size_t i = 0; i < scene.forces.size(); ++i) {
        const std::string path = fmt::format("force.{}", i + 1);
        check_ranges<Selection>(scene, scene.forces[i], path);
        check_ranges(scene, scene.forces[i], path);
        check_selection(scene, scene.forces[i], path);
    }
    check_gravity(scene);
}

}  // namespace ruche

#include "ruche/scene/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ruche/pattern/generator_registry.hpp"
#include "ruche/scene/check_scene.hpp"

namespace ruche {

static PrintRules print_rules(const Scene& scene) {
    return {.rules = scene.plastic.rules,
            .thickness = scene.plastic.thickness_mm,
            .side = scene.plastic.side,
            .fabric_from_outline = !scene.fabric.outline.empty(),
            .fabric_layer = scene.fabric.outline,
            .margin = scene.fabric.margin_mm,
            .bare = scene.plastic.none};
}

/// The place of the option that a generator complains about, as far as the message says which.
static Place option_place(const Scene& scene, const std::string& key) {
    const std::string option = "pattern.options." + key.substr(key.rfind('.') + 1);
    return place_in(scene, scene.sources.contains(option) ? option : "pattern.generator");
}

static GeneratedPattern generated_pattern(const Scene& scene) {
    const Place place{.file = scene.file, .key = "pattern.options"};
    try {
        return generate(scene.pattern.generator, resolved_generator_options(scene), place);
    } catch (const InputError& error) {
        if (error.place().file != scene.file) throw;  // about a file that the generator reads
        throw InputError(option_place(scene, error.place().key), error.problem(), error.advice());
    }
}

/// The pattern as it is drawn, with the thicknesses that are asked for.
static Pattern drawn_pattern(const Scene& scene) {
    if (!scene.pattern.generator.empty()) return to_pattern(generated_pattern(scene), print_rules(scene));
    const Drawing drawing = read_drawing(
        resolved_path(scene, scene.pattern.svg),
        {.flatten_tolerance_mm = scene.pattern.flatten_tolerance_mm, .width_mm = scene.pattern.width_mm});
    try {
        return make_pattern(drawing, print_rules(scene));
    } catch (const InputError& error) {
        // What the importer left out may be why nothing is left to print.
        std::string advice = error.advice();
        constexpr std::size_t most = 2;
        for (std::size_t i = 0; i < std::min(most, drawing.warnings.size()); ++i)
            advice += "\n  warning: " + drawing.warnings[i];
        throw InputError(error.place(), error.problem(), advice);
    }
}

Pattern scene_pattern(const Scene& scene) {
    Pattern pattern = drawn_pattern(scene);
    for (Strip& strip : pattern.strips)
        if (strip.side == Side::back) strip.thickness *= scene.plastic.back_thickness_factor;
    return pattern;
}

/// Refuses a mesh that no machine could solve before trying to make it.
static void check_element_count(const Scene& scene, const Pattern& pattern) {
    constexpr double most = 4e6;
    const auto count = [](double region_area, double size) { return region_area / (0.433 * size * size); };
    double printed = 0.0;
    for (const Strip& strip : pattern.strips) printed += area(strip.region);
    const double total =
        count(printed, scene.mesh.size_mm) + count(area(pattern.fabric), scene.mesh.fabric_size_mm);
    if (total > most)
        throw InputError(
            place_in(scene, "mesh.size_mm"),
            fmt::format("{} mm, with {} mm in bare fabric, would make about {:.2g} triangles, at "
                        "most {:.0g} are possible",
                        scene.mesh.size_mm, scene.mesh.fabric_size_mm, total, most),
            "Choose larger elements, or check the size of the drawing.");
}

MeshOptions mesh_options(const Scene& scene) {
    MeshOptions options = scene.mesh;
    options.centre_lines = scene.model.strips == StripModel::rods;
    return options;
}

PrintMesh scene_mesh(const Scene& scene) {
    if (!scene.pattern.mesh.empty()) {
        if (scene.model.strips == StripModel::rods)
            throw InputError(place_in(scene, "model.strips"),
                             "is \"rods\", and the pattern is a mesh whose edges do not follow the strips",
                             "Give the pattern as a drawing or a generator, or choose \"shell\".");
        const std::string& table = scene.pattern.thickness_table;
        return read_print_mesh(resolved_path(scene, scene.pattern.mesh),
                               table.empty() ? table : resolved_path(scene, table));
    }
    const Pattern pattern = scene_pattern(scene);
    check_element_count(scene, pattern);
    return mesh_pattern(pattern, mesh_options(scene));
}

static std::vector<int> vertices_in_box(const Selection& box, const TriangleMesh& mesh) {
    constexpr double slack = 1e-6;  // mm, well above the 1 nm grid that vertices lie on
    std::vector<int> found;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2& p = mesh.vertices[static_cast<std::size_t>(v)];
        if (p.x() >= box.min_mm[0] - slack && p.x() <= box.max_mm[0] + slack &&
            p.y() >= box.min_mm[1] - slack && p.y() <= box.max_mm[1] + slack)
            found.push_back(v);
    }
    return found;
}

static int nearest_vertex(const std::array<double, 2>& point, const TriangleMesh& mesh) {
    const Vec2 target(point[0], point[1]);
    const auto nearer = [&](const Vec2& a, const Vec2& b) {
        return (a - target).squaredNorm() < (b - target).squaredNorm();
    };
    return static_cast<int>(std::min_element(mesh.vertices.begin(), mesh.vertices.end(), nearer) -
                            mesh.vertices.begin());
}

static std::vector<int> selected(const Scene& scene, const Selection& selection, const TriangleMesh& mesh,
                                 const std::string& path) {
    if (selection.where == Selection::Where::point) return {nearest_vertex(selection.point_mm, mesh)};
    std::vector<int> found = vertices_in_box(selection, mesh);
    if (!found.empty()) return found;
    Vec2 low = mesh.vertices.front();
    Vec2 high = low;
    for (const Vec2& p : mesh.vertices) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    throw InputError(
        place_in(scene, path), "there is no vertex of the mesh in this box",
        fmt::format("The layout reaches from [{:.4g}, {:.4g}] to [{:.4g}, {:.4g}] mm. A box that is "
                    "narrower than an element may miss every vertex.",
                    low.x(), low.y(), high.x(), high.y()));
}

/// One entry per vertex, in the order of the vertices.
static std::vector<Support> model_supports(const Scene& scene, const TriangleMesh& mesh) {
    std::map<int, Support> held;
    for (std::size_t i = 0; i < scene.supports.size(); ++i) {
        const SupportOptions& support = scene.supports[i];
        const std::string path = fmt::format("support.{}", i + 1);
        for (const int vertex : selected(scene, support, mesh, path)) {
            const Vec2& p = mesh.vertices[static_cast<std::size_t>(vertex)];
            const Vec3 at =
                Vec3(p.x(), p.y(), 0.0) + Vec3(support.move_mm[0], support.move_mm[1], support.move_mm[2]);
            Support& entry =
                held.try_emplace(vertex, Support{.vertex = vertex, .fixed = {}, .at = at}).first->second;
            for (int k = 0; k < 3; ++k) {
                const auto axis = static_cast<std::size_t>(k);
                if (support.fix.find("xyz"[axis]) == std::string::npos) continue;
                if (entry.fixed[axis] && entry.at[k] != at[k])
                    throw InputError(
                        place_in(scene, path),
                        fmt::format("takes the vertex at [{:.4g}, {:.4g}] mm somewhere else than an "
                                    "earlier support does",
                                    p.x(), p.y()));
                entry.fixed[axis] = true;
                entry.at[k] = at[k];
            }
        }
    }
    std::vector<Support> all;
    all.reserve(held.size());
    for (const auto& [vertex, support] : held) all.push_back(support);
    return all;
}

static std::vector<NodalForce> model_forces(const Scene& scene, const TriangleMesh& mesh) {
    std::vector<NodalForce> all;
    for (std::size_t i = 0; i < scene.forces.size(); ++i) {
        const ForceOptions& force = scene.forces[i];
        const std::vector<int> vertices = selected(scene, force, mesh, fmt::format("force.{}", i + 1));
        const Vec3 share =
            Vec3(force.force_n[0], force.force_n[1], force.force_n[2]) / static_cast<double>(vertices.size());
        for (const int vertex : vertices) all.push_back({.vertex = vertex, .force = share});
    }
    return all;
}

/// Every connected piece must be held against every direction in which something pulls it.
static void check_held(const Scene& scene, const ModelInput& model) {
    if (model.table.present) return;
    const MeshPieces pieces = find_pieces(model.mesh);
    const auto count = static_cast<std::size_t>(pieces.count);
    std::vector<std::array<bool, 3>> held(count, {false, false, false});
    // What pulls a piece as a whole, and how hard it is pulled in all: balanced forces need no support.
    std::vector<Vec3> net(count, Vec3(model.gravity[0], model.gravity[1], model.gravity[2]));
    std::vector<double> gross(count, 0.0);
    const auto piece_of = [&](int vertex) { return pieces.of_vertex[static_cast<std::size_t>(vertex)]; };
    for (const Support& support : model.supports)
        if (const int piece = piece_of(support.vertex); piece >= 0)
            for (std::size_t k = 0; k < 3; ++k) held[static_cast<std::size_t>(piece)][k] |= support.fixed[k];
    for (const NodalForce& force : model.forces)
        if (const int piece = piece_of(force.vertex); piece >= 0) {
            net[static_cast<std::size_t>(piece)] += force.force;
            gross[static_cast<std::size_t>(piece)] += force.force.norm();
        }
    for (std::size_t piece = 0; piece < count; ++piece)
        for (std::size_t k = 0; k < 3; ++k)
            if (std::abs(net[piece][static_cast<int>(k)]) > 1e-12 * gross[piece] && !held[piece][k])
                throw InputError(
                    place_in(scene, scene.supports.empty() ? "gravity.acceleration_mm_per_s2" : "support.1"),
                    fmt::format("piece {} of {} of the sheet is pulled along {} and held nowhere against it",
                                piece + 1, count, "xyz"[k]),
                    "Support every connected piece of the fabric.");
}

/// A table holds by weight alone: every connected piece must have some.
static void check_weight(const Scene& scene, const ModelInput& model) {
    if (!model.table.present || scene.material.fabric_areal_density > 0.0) return;
    const MeshPieces pieces = find_pieces(model.mesh);
    std::vector<bool> heavy(static_cast<std::size_t>(pieces.count), false);
    for (const Rod& rod : model.rods)
        if (const int piece = pieces.of_vertex[static_cast<std::size_t>(rod.vertices.front())];
            piece >= 0 && scene.material.plastic_density > 0.0)
            heavy[static_cast<std::size_t>(piece)] = true;
    for (std::size_t t = 0; t < model.print.size(); ++t)
        if (const int piece = pieces.of_vertex[static_cast<std::size_t>(model.mesh.triangles[t][0])];
            piece >= 0 && !model.print[t].bare() && scene.material.plastic_density > 0.0)
            heavy[static_cast<std::size_t>(piece)] = true;
    const auto light = std::ranges::find(heavy, false);
    if (light == heavy.end()) return;
    throw InputError(
        place_in(scene, "gravity.table"),
        fmt::format("piece {} of {} of the sheet has no weight: the table does not hold it",
                    light - heavy.begin() + 1, pieces.count),
        "Give material.fabric_areal_density_kg_per_m2, or hold the sheet by a [[support]] instead.");
}

std::vector<Print> laminated_print(const Scene& scene, const PrintMesh& layout) {
    if (scene.model.strips == StripModel::shell) return layout.print;
    return std::vector<Print>(layout.mesh.triangles.size());
}

static std::vector<Rod> model_rods(const Scene& scene, const PrintMesh& layout) {
    std::vector<Rod> rods;
    if (scene.model.strips == StripModel::shell) return rods;
    for (const MeshedStrip& strip : layout.strips) {
        for (const MeshedStrip::EdgeLine& line : strip.edge_lines)
            rods.push_back({.vertices = line.vertices,
                            .width = line.width,
                            .thickness = strip.thickness,
                            .side = strip.side,
                            .youngs_modulus = strip.youngs_modulus});
    }
    return rods;
}

ModelInput scene_model(const Scene& scene, const PrintMesh& layout) {
    constexpr double table_stiffness = 1.0;  // N/mm^3: a printed sheet sinks in by micrometres
    ModelInput model{.mesh = layout.mesh,
                     .print = laminated_print(scene, layout),
                     .rods = model_rods(scene, layout),
                     .material = scene.material,
                     .prestretch = scene.fabric.prestretch,
                     .fabric_axis_deg = scene.fabric.axis_deg,
                     .gravity = scene.gravity.acceleration_mm_per_s2,
                     .supports = model_supports(scene, layout.mesh),
                     .forces = model_forces(scene, layout.mesh),
                     .table = {.present = scene.gravity.table,
                               .height = scene.gravity.table_height_mm,
                               .stiffness_per_area = table_stiffness},
                     .options = scene.model};
    check_held(scene, model);
    check_weight(scene, model);
    return model;
}

}  // namespace ruche

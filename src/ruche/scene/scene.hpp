#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/core/error.hpp"
#include "ruche/energy/model.hpp"
#include "ruche/material/material.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/pattern/pattern.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {

/// [pattern]: exactly one of svg, mesh and generator.
struct PatternSource {
    std::string svg;
    std::string mesh;
    std::string thickness_table;  ///< for an OBJ mesh
    std::string generator;
    std::map<std::string, std::string> generator_options;  ///< [pattern.options], as written
    double width_mm = 0.0;
    double flatten_tolerance_mm = 0.01;
};

/// [fabric]
struct FabricOptions {
    std::string card = "spandex-tpu95a";
    std::array<double, 2> prestretch = {1.7, 1.7};
    double axis_deg = 0.0;
    double margin_mm = 5.0;
    std::string outline;  ///< layer, colour, class or id of the shapes that bound the fabric; see PrintRules
};

/// [plastic], or plastic = "none"
struct PlasticOptions {
    double thickness_mm = 0.6;
    Side side = Side::front;
    double back_thickness_factor = 1.0;  ///< of strips that end up on the back, over what is asked for
    std::vector<PrintRule> rules;        ///< [[plastic.rule]]
    bool none = false;                   ///< nothing is printed: the drawing shows the fabric alone
};

/// Which vertices of the layout a support or a force takes hold of.
struct Selection {
    enum class Where { box, point };
    Where where = Where::box;
    std::array<double, 2> min_mm = {0, 0};  ///< of the box
    std::array<double, 2> max_mm = {0, 0};
    std::array<double, 2> point_mm = {0, 0};  ///< the nearest vertex to it
};

/// [[support]]: the selected vertices are held.
struct SupportOptions : Selection {
    std::string fix = "xyz";
    std::array<double, 3> move_mm = {0, 0, 0};  ///< where they are taken from their place in the flat layout
};

/// [[force]]: a dead force, shared equally by the selected vertices.
struct ForceOptions : Selection {
    std::array<double, 3> force_n = {0, 0, 0};
};

/// [gravity]
struct GravityOptions {
    std::array<double, 3> acceleration_mm_per_s2 = {0, 0, 0};
    bool table = false;
    double table_height_mm = 0.0;  ///< along -gravity, from the flat layout's plane
};

/// [output]
struct OutputOptions {
    bool obj = true;
    bool ply = true;
    bool vtu = true;
    bool glb = true;
    bool stl = false;
    bool picture = true;
    bool page = true;
    int film_frames = 0;
    int picture_width_px = 1600;
    int picture_height_px = 1200;
};

template <>
std::span<const Field<PatternSource>> fields<PatternSource>();
template <>
std::span<const Field<FabricOptions>> fields<FabricOptions>();
template <>
std::span<const Field<PlasticOptions>> fields<PlasticOptions>();
template <>
std::span<const Field<PrintRule>> fields<PrintRule>();
template <>
std::span<const Field<Selection>> fields<Selection>();
template <>
std::span<const Field<SupportOptions>> fields<SupportOptions>();
template <>
std::span<const Field<ForceOptions>> fields<ForceOptions>();
template <>
std::span<const Field<GravityOptions>> fields<GravityOptions>();
template <>
std::span<const Field<OutputOptions>> fields<OutputOptions>();

/// Everything a run needs; a plain value. Read from a TOML file, a drawing with options, or built in code.
struct Scene {
    std::string file;  ///< where it came from; relative paths inside are relative to its folder
    PatternSource pattern;
    FabricOptions fabric;
    Material material;
    std::map<std::string, std::string>
        material_sources;  ///< by bare field name: "paper Table 1", "assumed: ...", "kite.toml:9", ...
    PlasticOptions plastic;
    MeshOptions mesh;
    ModelOptions model;
    SolveOptions solver;
    std::vector<SupportOptions> supports;
    std::vector<ForceOptions> forces;
    GravityOptions gravity;
    OutputOptions output;

    std::map<std::string, Place> sources;  ///< where each value was set ("fabric.prestretch"); else default
    std::vector<std::string> warnings;     ///< found while reading
};

/// Calls `visit(section, struct)` for every section that is there once: "pattern", "fabric", "material", ...
/// The one list that reading, writing, checking and documentation go through.
template <class SceneType, class Visit>
void for_each_section(SceneType& scene, Visit&& visit) {
    visit("pattern", scene.pattern);
    visit("fabric", scene.fabric);
    visit("material", scene.material);
    visit("plastic", scene.plastic);
    visit("mesh", scene.mesh);
    visit("model", scene.model);
    visit("solver", scene.solver);
    visit("gravity", scene.gravity);
    visit("output", scene.output);
}

/// A path inside the scene, seen from the program's working folder.
std::string resolved_path(const Scene& scene, const std::string& path);

/// The options of the scene's generator, a file among them seen from the program's working folder.
std::map<std::string, std::string> resolved_generator_options(const Scene& scene);

/// The files that the scene's pattern is read from, as the scene names them.
std::vector<std::string> pattern_files(const Scene& scene);

/// Name of the scene: its file's (or drawing's or generator's) without folder and ending; "scene" without.
std::string scene_name(const Scene& scene);

/// What a reader of the result must know was not given: values whose source is assumed, and those that
/// matter most and were left at their default or found in the drawing. A sentence each, with units.
std::vector<std::string> assumptions(const Scene& scene, const PrintMesh& layout);

}  // namespace ruche

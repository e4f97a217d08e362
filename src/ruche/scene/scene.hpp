#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
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
    std::map<std::string, std::string> generator_options;
    double width_mm = 0.0;
    double flatten_tolerance_mm = 0.01;
};

/// [fabric]
struct FabricOptions {
    std::string card = "spandex-tpu95a";
    std::array<double, 2> prestretch = {1.7, 1.7};
    double axis_deg = 0.0;
    double margin_mm = 5.0;
    std::string outline;  ///< layer, colour, class or id of the shapes that bound the fabric
};

/// [plastic]
struct PlasticOptions {
    double thickness_mm = 0.6;
    Side side = Side::front;
    std::vector<PrintRule> rules;
};

/// [[support]]: the vertices of the layout inside a box (or nearest to a point) are held.
struct SupportOptions {
    std::array<double, 2> min_mm = {0, 0};
    std::array<double, 2> max_mm = {0, 0};
    std::array<double, 3> move_mm = {0, 0, 0};  ///< where they are taken from their place in the flat layout
    std::string fix = "xyz";
};

/// [gravity]
struct GravityOptions {
    std::array<double, 3> acceleration_mm_per_s2 = {0, 0, 0};
    bool table = false;
};

/// [output]
struct OutputOptions {
    bool obj = true;
    bool ply = true;
    bool vtu = true;
    bool glb = true;
    bool picture = true;
    int picture_width_px = 1600;
    int picture_height_px = 1200;
};

/// Everything a run needs; a plain value. Read from a TOML file, a drawing with options, or built in code.
struct Scene {
    std::string file;  ///< where it came from; relative paths inside are relative to its folder
    PatternSource pattern;
    FabricOptions fabric;
    Material material;
    std::map<std::string, std::string>
        material_sources;  ///< by field: "paper Table 1", "assumed: ...", "scene", ...
    PlasticOptions plastic;
    MeshOptions mesh;
    ModelOptions model;
    SolveOptions solver;
    std::vector<SupportOptions> supports;
    GravityOptions gravity;
    OutputOptions output;
};

}  // namespace ruche

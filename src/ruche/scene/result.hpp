#pragma once

#include <map>
#include <string>
#include <vector>

#include "ruche/geometry/self_intersection.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/scene/scene.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {

/// A finished (or interrupted) run: the complete resolved scene, the mesh, the shape and how it was reached.
struct Result {
    Scene scene;                         ///< every default written out
    PrintMesh layout;                    ///< flat, mm
    std::vector<Vec3> shape;             ///< one position per vertex, mm
    std::vector<double> energy_density;  ///< elastic energy per triangle, mJ/mm^2 of layout
    Equilibrium equilibrium;
    std::vector<Intersection> self_intersections;  ///< all pairs of triangles that pass through each other
    std::vector<std::string>
        assumptions;  ///< "fabric_thickness = 0.46 mm: not in the paper, implied by k_B", ...
    std::vector<std::string> warnings;
    std::map<std::string, double> seconds;  ///< by phase: read, mesh, release, ...
};

/// Per triangle: 1 where the sheet passes through itself.
std::vector<char> passes_through_itself(const Result& result);

}  // namespace ruche

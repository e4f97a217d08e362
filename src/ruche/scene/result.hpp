#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ruche/geometry/self_intersection.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/scene/release_film.hpp"
#include "ruche/scene/scene.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {

/// An entry of the list of a scene's stable shapes.
struct ShapeEntry {
    int number = 0;  ///< 1 has the lowest energy
    double energy = 0.0;
    bool ordinary = false;                ///< the one that the scene's release leads to
    std::vector<std::string> found_from;  ///< the starts that led there
};

/// What a search for further stable shapes has found.
struct ShapeList {
    std::vector<ShapeEntry> shapes;       ///< lowest energy first
    std::vector<std::string> symmetries;  ///< of the sheet; images under them are not listed
    int starts = 0;
    int without_result = 0;  ///< starts that ended in no certified minimum
    bool interrupted = false;
};

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
    std::optional<ShapeList> alternatives;  ///< when they were looked for
    std::optional<ReleaseFilm> film;        ///< when it was made, see film_release
    std::map<std::string, double> seconds;  ///< by phase: read, mesh, release, ...
};

/// What a vector of all unknowns holds for the vertices: positions, or their changes.
std::vector<Vec3> vertex_vectors(const Eigen::VectorXd& unknowns, int vertex_count);

/// Per triangle: 1 where the sheet passes through itself.
std::vector<char> passes_through_itself(const Result& result);

}  // namespace ruche

#pragma once

#include "ruche/energy/model.hpp"
#include "ruche/meshing/print_mesh.hpp"
#include "ruche/pattern/pattern.hpp"
#include "ruche/scene/scene.hpp"

namespace ruche {

/// From the scene to what the solver needs, step by step; each step is data in, data out, and throws
/// InputError.

/// The printed pattern of a drawing or a generator (not of a mesh file), as thick as it comes out: strips on
/// the back by plastic.back_thickness_factor thicker than asked for.
Pattern scene_pattern(const Scene& scene);

/// How the scene's pattern is to be meshed: rods need edges along the strips.
MeshOptions mesh_options(const Scene& scene);

/// The layout mesh: made from the pattern, or read from the mesh file. Carries the pattern's warnings.
PrintMesh scene_mesh(const Scene& scene);

/// What of the layout's print the energy has as laminates: all of it, or nothing when strips are rods.
std::vector<Print> laminated_print(const Scene& scene, const PrintMesh& layout);

/// Mesh, material, loads and supports. Throws when a support or force takes hold of no vertex, two supports
/// take a vertex to different places, or a piece of the sheet would fall.
ModelInput scene_model(const Scene& scene, const PrintMesh& layout);

}  // namespace ruche

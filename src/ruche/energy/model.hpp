#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "ruche/core/fields.hpp"
#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/material/material.hpp"
#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

enum class EdgeNormals { free, averaged };
enum class BendingNormalisation { plate, as_printed };
enum class LaminateThickness { true_thickness, as_printed };
enum class ShearStrain { engineering, tensor };

/// Choices of the model that model.md names; the defaults are the ones that converge under refinement.
struct ModelOptions {
    EdgeNormals edge_normals = EdgeNormals::free;
    BendingNormalisation bending_normalisation = BendingNormalisation::plate;
    LaminateThickness laminate_thickness = LaminateThickness::true_thickness;
    ShearStrain shear_strain = ShearStrain::engineering;
    double log_extension = 1e-3;  ///< delta: the stress goes on linearly beyond E_ii = gamma_i - delta
};

template <>
std::span<const Field<ModelOptions>> fields<ModelOptions>();

/// A vertex held in space: where `fixed` is set, the coordinate keeps the value `at`.
struct Support {
    int vertex = 0;
    std::array<bool, 3> fixed = {true, true, true};
    Vec3 at = Vec3::Zero();
};

/// A force that does not change with the shape, N.
struct NodalForce {
    int vertex = 0;
    Vec3 force = Vec3::Zero();
};

/// A frictionless horizontal plane below the sheet, perpendicular to gravity.
struct Table {
    bool present = false;
    double height = 0.0;               ///< mm, along -gravity
    double stiffness_per_area = 1e-3;  ///< N/mm per mm^2 of layout and mm of penetration
};

/// Everything that defines the energy of one printed sheet.
struct ModelInput {
    TriangleMesh mesh;
    std::vector<Print> print;  ///< per triangle; empty = bare fabric
    Material material;
    std::array<double, 2> prestretch = {1.7, 1.7};
    double fabric_axis_deg = 0.0;
    std::array<double, 3> gravity = {0, 0, 0};  ///< mm/s^2
    std::vector<Support> supports;
    std::vector<NodalForce> forces;
    Table table;
    ModelOptions options;
};

}  // namespace ruche

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ruche/geometry/triangle_mesh.hpp"

/// The independent references in tests/data (see its README for their origin and conventions).
namespace ruche::test {

/// The rows of a CSV file without its header.
std::vector<std::vector<double>> read_csv(const std::string& name);

/// A function on one of the reference meshes: energy in mJ, gradient in N, Hessian times w in N/mm.
struct ReferenceValues {
    double energy = 0.0;
    Eigen::VectorXd gradient;
    Eigen::VectorXd hessian_times_w;
};

/// tests/data/vectors in the units of the program.
struct ReferenceMesh {
    TriangleMesh mesh;
    Eigen::VectorXd x;  ///< deformed positions, mm
    Eigen::VectorXd w;
    std::vector<int> plastic_faces;
    double prestretch = 1.0;
    double fabric_thickness = 0.0, plastic_thickness = 0.0;  ///< mm
    double plastic_modulus = 0.0, fabric_modulus = 0.0;      ///< MPa
    double laminate_poissons_ratio = 0.0, fabric_poissons_ratio = 0.0;
    double alpha_1 = 0.0, alpha_2 = 0.0, alpha_3 = 0.0;  ///< MPa
    double bending_stiffness = 0.0;                      ///< N mm
    std::vector<Vec3> a;                                 ///< per face (a11, a12, a22), mm^2
    std::vector<Vec3> libshell_b;                        ///< per face, mm

    ReferenceValues values(const std::string& term) const;
    std::string name;
};
ReferenceMesh read_reference_mesh(const std::string& name);

}  // namespace ruche::test

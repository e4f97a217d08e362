#pragma once

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// A rectangle of plastic, width along the fabric, thickness away from it (mm), of an isotropic material
/// (MPa).
struct RodSection {
    double width = 0.0;
    double thickness = 0.0;
    double youngs_modulus = 0.0;
    double poissons_ratio = 0.0;
};

/// E A, N.
double stretching_stiffness(const RodSection& section);

/// N mm^2, about the axes of the section: (twisting about the line G J, bending out of the fabric's plane E w
/// h^3/12, bending in it E h w^3/12). J is that of Saint-Venant's torsion of a rectangle.
Vec3 turning_stiffness(const RodSection& section);

/// J of a rectangle, mm^4 (Timoshenko and Goodier, Theory of Elasticity, sec. 109):
///
///     J = a b^3 / 3 [1 - 192 b / (pi^5 a) sum_{n odd} tanh(n pi a / (2 b)) / n^5],   a >= b
double torsion_constant(double width, double thickness);

}  // namespace ruche

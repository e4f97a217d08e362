#pragma once

#include <Eigen/Core>
#include <span>

#include "ruche/energy/model.hpp"
#include "ruche/statics/retraction.hpp"

namespace ruche {

/// The shape of a sheet on some mesh of its layout.
struct LayoutShape {
    const TriangleMesh& layout;
    std::span<const Print> print;  ///< per triangle; empty = not known
    const Eigen::VectorXd& x;      ///< positions row by row; edge unknowns after them are not used
};

/// The same shape on another mesh of the layout, as a start there. Rotations and strains are carried over,
/// not positions: per triangle of the old mesh F = R U; R is averaged to the vertices (plastic counts 100
/// times fabric), blended between them, U is kept, and positions follow from the retraction's Poisson
/// problem. Bare triangles look at bare ones and printed at printed ones as far as there are any nearby. Edge
/// unknowns are zero. Fabric that is squeezed to less than 0.85 of its length at rest is opened to that: at
/// corners of strips a shape at rest squeezes elements to a hundredth, and other elements with such stretches
/// would turn over; from there they close on their own. Where the old layout does not reach, the nearest
/// triangle's deformation goes on.
Eigen::VectorXd transfer(const LayoutShape& from, const Model& to, Retraction& retraction);

}  // namespace ruche

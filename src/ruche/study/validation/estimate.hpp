#pragma once

#include <span>
#include <string>
#include <vector>

namespace ruche {

/// A number from meshes that get finer, and how far off it may be.
struct Estimate {
    double value = 0.0;          ///< on the finest mesh
    double uncertainty = 0.0;    ///< of discretisation: the limit lies within +- this with a wide margin
    double order = 0.0;          ///< observed with three meshes and more; NaN where there is none
    double extrapolated = 0.0;   ///< Richardson's estimate of the limit, with the order used
    bool certain = true;         ///< all of its runs are certified equilibria
    std::vector<double> values;  ///< on each mesh, the coarsest first
    double refinement = 0.0;     ///< of the elements from mesh to mesh
};

/// From values on meshes whose elements get smaller by the factor `refinement` each, the coarsest first; at
/// least two. Roache's grid convergence index (Perspective: a method for uniform reporting of grid refinement
/// studies, 1994):
///
///     U = F |f_fine - f_coarse| / (r^p - 1)
///
/// with two meshes p = 1, half of what smooth errors of these elements have, and F = 1.25; with three the
/// observed order of the last three and F = 1.25, as long as it lies in [0.5, 3]. Beyond, or where the
/// differences change their sign, they are the meshes' noise (irregular meshes differ by more than their
/// size): then U is F times the largest difference between two of the last three values.
Estimate estimate(std::span<const double> values, double refinement);

/// Of a over b, both on the same meshes: estimated from the quotients on each of them, so that errors that
/// both share drop out.
Estimate quotient(const Estimate& a, const Estimate& b);

/// Of the magnitude.
Estimate magnitude(const Estimate& e);

/// "0.1201 ± 0.0013".
std::string to_text(const Estimate& e);

/// The same for a table's cell: with (!) when it is not certain, and below it the observed order and
/// Richardson's limit where meshes approach one in order.
std::string to_html(const Estimate& e);

}  // namespace ruche

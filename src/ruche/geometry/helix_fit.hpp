#pragma once

#include <span>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// A circular helix, by its constant curvature and torsion: a circle has no torsion.
struct HelixFit {
    double curvature = 0.0;  ///< 1/mm, not negative
    double torsion = 0.0;    ///< 1/mm; positive for a right-handed helix
    double rms = 0.0;        ///< root mean square distance of the line, moved along itself, to itself, mm
    bool valid = false;      ///< false for fewer than four points, and for a straight line
};

/// The helix through points that are evenly spaced along it. It is the one curve that a screw motion moves
/// along itself: that motion, about an axis with the turn per pitch, is the rigid one that takes the points
/// to those some places on, in the sense of least squares. With the radius rho, the turn w and the advance d
/// per place, curvature rho w^2/(rho^2 w^2 + d^2), torsion w d/(rho^2 w^2 + d^2). Neighbours must turn by
/// less than a radian.
HelixFit fit_helix(std::span<const Vec3> points);

}  // namespace ruche

#pragma once

#include <span>

#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// The motion x -> rotation x + translation that takes one list of points nearest to another.
struct RigidAlignment {
    Mat3 rotation = Mat3::Identity();  ///< determinant -1 where a reflection was asked for
    Vec3 translation = Vec3::Zero();
    double rms = 0.0;  ///< root mean square distance of corresponding points after it, mm
};

enum class Handedness { kept, mirrored };

/// Least squares over all rigid motions (Kabsch 1976, by singular values), or over all of them after a
/// reflection. Both lists have the same length; an empty one gives the identity. Where several motions are
/// equally good (points on a line) it is one of them.
RigidAlignment align(std::span<const Vec3> from, std::span<const Vec3> to,
                     Handedness handedness = Handedness::kept);

}  // namespace ruche

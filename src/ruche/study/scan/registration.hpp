#pragma once

#include <span>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/geometry/surface_search.hpp"
#include "ruche/geometry/vectors.hpp"

namespace ruche {

/// x -> scale rotation x + translation.
struct Placing {
    double scale = 1.0;
    Mat3 rotation = Mat3::Identity();
    Vec3 translation = Vec3::Zero();

    Vec3 operator()(const Vec3& x) const { return scale * (rotation * x) + translation; }
};

struct RegistrationOptions {
    bool free_scale = false;
    double kept = 0.9;  ///< share of the points that have to lie on the surface: the rest may be anything
    std::size_t most_points = 10000;  ///< that the last step looks at
};

struct Registration {
    Placing placing;
    double rms = 0.0;  ///< of the kept points, mm
    /// Root mean square of the next best placing that is another one, over `rms`: near 1 where the shape fits
    /// itself in several ways.
    double runner_up = 0.0;
};

/// Puts a scan's points on a surface: trimmed iterative closest points (Chetverikov, Stepanov, Krsek 2005)
/// with the distance to the surface's tangent planes (Chen, Medioni 1992), from many starts: the axes of both
/// turned onto each other in every right-handed way, the scan's middle on the surface's and, as a scan may be
/// a part, on places all over it. Few points first, many for the last step, in which all count by a robust
/// weight instead of some being left out. The same result on every machine with any number of threads. At
/// least ten points.
Registration register_scan(std::span<const Vec3> scan, const SurfaceSearch& surface,
                           const RegistrationOptions& options, const Control& control = {});

/// The last step alone: goes on from a registration near by, with more points or on another surface.
Registration refine_registration(std::span<const Vec3> scan, const SurfaceSearch& surface,
                                 const RegistrationOptions& options, const Registration& start);

}  // namespace ruche

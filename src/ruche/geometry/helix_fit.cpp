#include "ruche/geometry/helix_fit.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "ruche/geometry/rigid_alignment.hpp"

namespace ruche {
namespace {

struct Screw {
    Vec3 axis = Vec3::UnitZ();
    double turn = 0.0;     ///< rad, in [0, pi]
    double advance = 0.0;  ///< mm, along the axis
    RigidAlignment motion;
};

/// The screw motion that takes each point to the one `lag` places on.
Screw screw_of(std::span<const Vec3> points, std::size_t lag) {
    Screw screw{.motion = align(points.first(points.size() - lag), points.last(points.size() - lag))};
    const Eigen::AngleAxisd rotation(screw.motion.rotation);
    screw.axis = rotation.axis();
    screw.turn = rotation.angle();
    screw.advance = screw.axis.dot(screw.motion.translation);
    return screw;
}

}  // namespace

HelixFit fit_helix(std::span<const Vec3> points) {
    if (points.size() < 4) return {};
    // The farther the motion goes the less it suffers from errors of the points; beyond half a turn its
    // direction would be lost, so that it goes on from a motion of less than a quarter.
    std::size_t lag = 1;
    Screw screw = screw_of(points, lag);
    while (screw.turn < 1.0 && 4 * lag <= points.size()) screw = screw_of(points, lag *= 2);
    constexpr double straight = 1e-9;  // rad
    if (!(screw.turn > straight)) return {};
    // A point of the axis, from what the motion does across it.
    const Vec3 across = screw.motion.translation - screw.advance * screw.axis;
    const Vec3 centre = 0.5 * (across + screw.axis.cross(across) / std::tan(0.5 * screw.turn));
    double radius = 0.0;
    for (const Vec3& p : points)
        radius += (p - centre).cross(screw.axis).norm() / static_cast<double>(points.size());
    const double around = radius * screw.turn;
    const double squared = around * around + screw.advance * screw.advance;
    return {.curvature = around * screw.turn / squared,
            .torsion = screw.turn * screw.advance / squared,
            .rms = screw.motion.rms,
            .valid = true};
}

}  // namespace ruche

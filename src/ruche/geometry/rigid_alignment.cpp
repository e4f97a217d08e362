#include "ruche/geometry/rigid_alignment.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cassert>
#include <cmath>

namespace ruche {
namespace {

Vec3 centroid(std::span<const Vec3> points) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points) sum += p;
    return sum / static_cast<double>(points.size());
}

}  // namespace

RigidAlignment align(std::span<const Vec3> from, std::span<const Vec3> to, Handedness handedness) {
    assert(from.size() == to.size());
    RigidAlignment best;
    if (from.empty()) return best;
    const Vec3 a = centroid(from);
    const Vec3 b = centroid(to);
    Mat3 covariance = Mat3::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) covariance += (to[i] - b) * (from[i] - a).transpose();
    const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double wanted = handedness == Handedness::kept ? 1.0 : -1.0;
    const double found = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    // Where the unconstrained optimum has the other handedness, the direction that matters least is turned
    // round.
    best.rotation = svd.matrixU() * Vec3(1.0, 1.0, wanted * found).asDiagonal() * svd.matrixV().transpose();
    best.translation = b - best.rotation * a;
    // From the points themselves: from the singular values it would drown in rounding.
    double squares = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i)
        squares += (best.rotation * from[i] + best.translation - to[i]).squaredNorm();
    best.rms = std::sqrt(squares / static_cast<double>(from.size()));
    return best;
}

}  // namespace ruche

#include "ruche/geometry/circle_fit.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace ruche {
namespace {

using Points2 = Eigen::Matrix<double, 2, Eigen::Dynamic>;

/// A circle as seen from the origin of the plane: `curvature` k, signed distance e of the origin to the
/// circle, and the direction u = (cos, sin)(angle) in which the distance d grows there. With
///
///     P(x) = k/2 |x|^2 + (1 + k e) u.x + e (1 + k e / 2),   P = k/2 d^2 + d
///
/// the distance d is regular for k -> 0 (Chernov and Lesort 2005). The centre lies at -(1/k + e) u.
struct PlaneCircle {
    double curvature = 0.0;
    double offset = 0.0;
    double angle = 0.0;

    double distance(const Vec2& x, Vec3* gradient = nullptr) const {
        const Vec2 u(std::cos(angle), std::sin(angle));
        const double ux = u.dot(x);
        const double stretch = 1.0 + curvature * offset;
        const double p =
            0.5 * curvature * x.squaredNorm() + stretch * ux + offset * (1.0 + 0.5 * curvature * offset);
        const double root = std::sqrt(std::max(0.0, 1.0 + 2.0 * curvature * p));  // = |1 + k d|
        const double d = 2.0 * p / (1.0 + root);
        if (gradient != nullptr) {
            const double slope = 1.0 / std::max(root, 1e-12);
            const double p_curvature = 0.5 * x.squaredNorm() + offset * ux + 0.5 * offset * offset;
            *gradient = Vec3(slope * (p_curvature - 0.5 * d * d), slope * (stretch + curvature * ux),
                             slope * stretch * (u.x() * x.y() - u.y() * x.x()));
        }
        return d;
    }
};

double sum_of_squares(const PlaneCircle& circle, const Points2& points) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const double d = circle.distance(points.col(i));
        sum += d * d;
    }
    return sum;
}

/// Taubin's algebraic fit a |x|^2 + b.x + c = 0 by singular values (after Chernov); regular for lines.
PlaneCircle algebraic_fit(const Points2& points) {
    const Vec2 mean = points.rowwise().mean();
    const Points2 x = points.colwise() - mean;
    const Eigen::VectorXd z = x.colwise().squaredNorm();
    const double z_mean = z.mean();
    Eigen::MatrixXd design(points.cols(), 3);
    design.col(0) = (z.array() - z_mean) / (2.0 * std::sqrt(z_mean));
    design.rightCols(2) = x.transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(design, Eigen::ComputeThinV);
    const Vec3 v = svd.matrixV().col(2);
    double a = v[0] / (2.0 * std::sqrt(z_mean));
    Vec2 b = v.tail<2>();
    double c = -z_mean * a;
    c += a * mean.squaredNorm() - b.dot(mean);  // back from the mean to the plane's origin
    b -= 2.0 * a * mean;
    const double scale = 1.0 / std::sqrt(std::max(b.squaredNorm() - 4.0 * a * c, 1e-300));
    const double p = c * scale;  // P at the origin, in the normalisation of PlaneCircle
    PlaneCircle circle;
    circle.curvature = 2.0 * a * scale;
    circle.offset = 2.0 * p / (1.0 + std::sqrt(std::max(0.0, 1.0 + 2.0 * circle.curvature * p)));
    circle.angle = std::atan2(b.y(), b.x());
    return circle;
}

/// Gauss-Newton with Levenberg's damping; ends at rounding.
PlaneCircle geometric_fit(const Points2& points, PlaneCircle circle) {
    double now = sum_of_squares(circle, points);
    double damping = 0.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
        Mat3 normal = Mat3::Zero();
        Vec3 right = Vec3::Zero();
        for (Eigen::Index i = 0; i < points.cols(); ++i) {
            Vec3 gradient;
            const double d = circle.distance(points.col(i), &gradient);
            normal += gradient * gradient.transpose();
            right -= gradient * d;
        }
        normal += damping * Mat3(normal.diagonal().asDiagonal());
        const Vec3 step = normal.ldlt().solve(right);
        const PlaneCircle next{circle.curvature + step[0], circle.offset + step[1], circle.angle + step[2]};
        const double then = sum_of_squares(next, points);
        if (std::isfinite(then) && then <= now) {
            const bool settled = step.norm() < 1e-15 || then == 0.0;
            circle = next;
            now = then;
            damping *= 0.1;
            if (settled) break;
        } else {
            if (step.norm() < 1e-13 || damping > 1e6) break;  // below rounding, or no way down
            damping = std::max(10.0 * damping, 1e-6);
        }
    }
    return circle;
}

/// Mean of the points and scatter about it, with their rates.
struct Scatter {
    Vec3 mean = Vec3::Zero();
    Vec3 mean_rate = Vec3::Zero();
    Mat3 moments = Mat3::Zero();
    Mat3 moments_rate = Mat3::Zero();

    Scatter(std::span<const Vec3> points, std::span<const Vec3> velocities) {
        const auto count = static_cast<double>(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            mean += points[i] / count;
            mean_rate += velocities[i] / count;
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 x = points[i] - mean;
            const Vec3 rate = velocities[i] - mean_rate;
            moments += x * x.transpose();
            moments_rate += x * rate.transpose() + rate * x.transpose();
        }
    }

    /// Rate of the eigenvector `normal` of the smallest moment.
    Vec3 normal_rate(const Vec3& normal) const {
        const Eigen::SelfAdjointEigenSolver<Mat3> eigen(moments);  // ascending
        Vec3 rate = Vec3::Zero();
        for (int j = 1; j < 3; ++j) {
            const Vec3 axis = eigen.eigenvectors().col(j);
            rate +=
                axis * (axis.dot(moments_rate * normal) / (eigen.eigenvalues()[0] - eigen.eigenvalues()[j]));
        }
        return rate;
    }
};

/// Rates of (curvature, offset, angle) at offset = angle = 0, where the sum of squares is smallest: sum d d_a
/// = 0 for each parameter a. The distance and its derivatives follow from k/2 d^2 + d = P.
Vec3 plane_rate(double k, const Points2& points, const Points2& velocities) {
    Mat3 jacobian = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    const PlaneCircle circle{.curvature = k};
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Vec2 x = points.col(i);
        const Vec2 rate = velocities.col(i);
        Vec3 slope;
        const double d = circle.distance(x, &slope);
        const double root = std::max(1.0 + k * d, 1e-12);
        Mat3 p_second;
        p_second << 0.0, x.x(), 0.0, x.x(), k, k * x.y(), 0.0, k * x.y(), -x.x();
        const Vec3 p_mixed(x.dot(rate), k * rate.x(), rate.y());
        const double d_rate = ((k * x.x() + 1.0) * rate.x() + k * x.y() * rate.y()) / root;
        const Vec3 curvature_part = d * Vec3::UnitX();
        const Mat3 second = (p_second - curvature_part * slope.transpose() -
                             slope * curvature_part.transpose() - k * slope * slope.transpose()) /
                            root;
        const Vec3 mixed = (p_mixed - d_rate * curvature_part - k * d_rate * slope) / root;
        jacobian += slope * slope.transpose() + d * second;
        right -= slope * d_rate + d * mixed;
    }
    return jacobian.ldlt().solve(right);
}

}  // namespace

double CircleFit::radius() const { return 1.0 / curvature; }

Vec3 CircleFit::centre() const { return point + inward / curvature; }

CircleFit fit_circle(std::span<const Vec3> points) {
    CircleFit fit;
    if (points.size() < 3) return fit;
    // Coordinates around the middle point, in units of the points' spread: the circle passes near the origin,
    // where its parameters are regular, also for full turns.
    const auto count = static_cast<Eigen::Index>(points.size());
    Eigen::Matrix3Xd x(3, count);
    for (Eigen::Index i = 0; i < count; ++i) x.col(i) = points[i];
    if (!x.allFinite()) return fit;
    const Vec3 mean = x.rowwise().mean();
    x.colwise() -= mean;
    const double size = std::sqrt(x.squaredNorm() / static_cast<double>(count));
    if (!(size > 0.0)) return fit;
    x /= size;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(x.transpose(), Eigen::ComputeThinV);
    const Mat3 axes = svd.matrixV();
    const Vec3 origin = x.col(count / 2);
    Points2 flat(2, count);
    for (Eigen::Index i = 0; i < count; ++i)
        flat.col(i) = axes.leftCols<2>().transpose() * (x.col(i) - origin);

    PlaneCircle circle = geometric_fit(flat, algebraic_fit(flat));
    if (circle.curvature < 0.0) {
        circle.curvature = -circle.curvature;
        circle.offset = -circle.offset;
        circle.angle += M_PI;
    }
    const Vec2 outward(std::cos(circle.angle), std::sin(circle.angle));
    const double out_of_plane = axes.col(2).dot(origin);  // the plane passes through the mean
    fit.valid = std::isfinite(circle.curvature) && std::isfinite(circle.angle);
    fit.curvature = circle.curvature / size;
    fit.inward = -(axes.leftCols<2>() * outward);
    fit.normal = axes.col(2);
    fit.point = mean + size * (origin - axes.col(2) * out_of_plane + circle.offset * fit.inward);
    const double beside = (axes.col(2).transpose() * x).squaredNorm();
    fit.rms = size * std::sqrt((sum_of_squares(circle, flat) + beside) / static_cast<double>(count));
    return fit;
}

CircleRate circle_rate(const CircleFit& fit, std::span<const Vec3> points, std::span<const Vec3> velocities) {
    const Scatter scatter(points, velocities);
    const Vec3& normal = fit.normal;
    const Vec3 normal_rate = scatter.normal_rate(normal);
    // The plane's axes, which turn with the normal only: each by -normal (axis . normal_rate).
    Eigen::Matrix<double, 3, 2> axes;
    axes << -fit.inward, -normal.cross(fit.inward);
    const Vec2 axes_rate = -axes.transpose() * normal_rate;
    const auto count = static_cast<Eigen::Index>(points.size());
    Points2 flat(2, count);
    Points2 flat_rate(2, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Vec3 x = points[i] - fit.point;
        flat.col(i) = axes.transpose() * x;
        flat_rate.col(i) = axes.transpose() * velocities[i] + axes_rate * normal.dot(x);
    }
    const double k = fit.curvature;
    const Vec3 rate = plane_rate(k, flat, flat_rate);
    // The centre lies at -(1/k + offset)(cos, sin)(angle) in the plane through the mean.
    const Vec2 centre_rate(rate[0] / (k * k) - rate[1], -rate[2] / k);
    const double lift_rate = normal.dot(scatter.mean_rate) + normal_rate.dot(scatter.mean - fit.centre());
    return {.curvature = rate[0], .centre = axes * centre_rate + lift_rate * normal, .normal = normal_rate};
}

}  // namespace ruche

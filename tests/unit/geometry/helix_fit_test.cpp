#include "ruche/geometry/helix_fit.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

using namespace ruche;

namespace {

/// Evenly spaced points of a helix with the given radius, advance per radian and angle from end to end,
/// somewhere in space.
std::vector<Vec3> helix_points(double radius, double advance, double angle, int count) {
    const Mat3 turned = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double at = angle * i / (count - 1);
        const Vec3 p(radius * std::cos(at), radius * std::sin(at), advance * at);
        points.emplace_back(turned * p + Vec3(5.0, -7.0, 2.0));
    }
    return points;
}

}  // namespace

TEST_CASE(
    "helix fit: curvature and torsion of a helix, right-handed and left-handed, short and of many turns") {
    for (const double advance : {3.0, -3.0, 0.2}) {
        for (const double angle : {0.3, 2.0, 40.0}) {
            const HelixFit fit = fit_helix(helix_points(5.0, advance, angle, 101));
            const double squared = 25.0 + advance * advance;
            CAPTURE(advance);
            CAPTURE(angle);
            REQUIRE(fit.valid);
            // What rounding of 1e-15 does to positions of 10 mm, over the sagitta of the short arc.
            CHECK(fit.curvature == doctest::Approx(5.0 / squared).epsilon(1e-10));
            CHECK(fit.torsion == doctest::Approx(advance / squared).epsilon(1e-10));
            CHECK(fit.rms < 1e-12);
        }
    }
}

TEST_CASE("helix fit: a circle has no torsion, and a straight line no helix") {
    const HelixFit circle = fit_helix(helix_points(4.0, 0.0, 3.0, 40));
    CHECK(circle.curvature == doctest::Approx(0.25).epsilon(1e-10));
    CHECK(std::abs(circle.torsion) < 1e-10);
    std::vector<Vec3> line;
    line.reserve(20);
    for (int i = 0; i < 20; ++i) line.emplace_back(0.5 * i, 0.0, 0.0);
    CHECK_FALSE(fit_helix(line).valid);
    CHECK(fit_helix(line).curvature == 0.0);
    CHECK_FALSE(fit_helix(std::vector<Vec3>(3, Vec3::Zero())).valid);
}

TEST_CASE("helix fit: errors of single points hardly count") {
    std::vector<Vec3> points = helix_points(5.0, 3.0, 2.0, 101);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].x() += i % 2 == 0 ? 1e-3 : -1e-3;
    const HelixFit fit = fit_helix(points);
    CHECK(fit.curvature == doctest::Approx(5.0 / 34.0).epsilon(1e-3));
    CHECK(fit.torsion == doctest::Approx(3.0 / 34.0).epsilon(1e-3));
    CHECK(fit.rms < 3e-3);
}

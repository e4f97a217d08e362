#include "ruche/geometry/strain_measures.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <random>

#include "energy/oracle.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Corners a, b, c, d of two triangles at the edge a-b, the second one rising by theta, in a random position.
std::array<Vec3, 4> hinge(double theta, std::mt19937& random) {
    std::uniform_real_distribution<double> size(0.3, 2.0);
    std::uniform_real_distribution<double> shift(-0.5, 1.5);
    std::normal_distribution<double> normal;
    const double length = size(random);
    const double depth = size(random);
    const double foot = shift(random);
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
    const Vec3 c(shift(random) * length, size(random), 0.0);
    const Vec3 d(foot * length, -depth * std::cos(theta), depth * std::sin(theta));
    return {turn * Vec3::Zero(), turn * Vec3(length, 0.0, 0.0), turn * c, turn * d};
}

double angle(const std::array<Vec3, 4>& v) {
    return dihedral_angle(dihedral_frame(v[0], v[1], v[2]), dihedral_frame(v[1], v[0], v[3]));
}

}  // namespace

TEST_CASE("dihedral angle: positive for a valley seen from the front, whatever the shapes and position") {
    CHECK(rc::check("angle", [](unsigned seed) {
        std::mt19937 random(seed);
        const double theta = std::uniform_real_distribution<double>(-3.14, 3.14)(random);
        const auto v = hinge(theta, random);
        RC_ASSERT(std::abs(angle(v) - theta) <= 1e-12);
        // Seen from the other triangle it is the same angle.
        RC_ASSERT(std::abs(angle({v[1], v[0], v[3], v[2]}) - theta) <= 1e-12);
    }));
}

TEST_CASE("dihedral angle: tiny angles keep their relative accuracy") {
    std::mt19937 random(3);
    for (const double theta : {1e-3, 1e-8, 1e-12}) {
        // Turned in space, positions are rounded to 1e-16: an absolute error of that size is left.
        CHECK(std::abs(angle(hinge(theta, random)) - theta) <= 1e-15 + 1e-14 * theta);
    }
}

TEST_CASE("dihedral angle: gradient and second derivative agree with automatic differentiation") {
    CHECK(rc::check("derivatives", [](unsigned seed) {
        std::mt19937 random(seed);
        const auto v = hinge(std::uniform_real_distribution<double>(-3.0, 3.0)(random), random);
        std::array<Point<Jet<12>>, 4> p;
        for (int i = 0; i < 12; ++i) p[i / 3][i % 3] = Jet<12>::unknown(i, v[i / 3][i % 3]);
        const Jet<12> exact = dihedral(p[0], p[1], p[2], p[3]);
        Jet<12> found;
        const std::array<int, 3> corners[2] = {{0, 1, 2}, {1, 0, 3}};
        for (const auto& k : corners) {
            const DihedralFrame frame = dihedral_frame(v[k[0]], v[k[1]], v[k[2]]);
            for (int i = 0; i < 3; ++i) found.gradient.segment<3>(3 * k[i]) += frame.gradient(i);
            frame.add_second_derivative(1.0, k, found.hessian);
        }
        RC_ASSERT((found.gradient - exact.gradient).norm() <= 1e-12 * exact.gradient.norm());
        const Eigen::Matrix<double, 12, 12> full = found.hessian.selfadjointView<Eigen::Lower>();
        RC_ASSERT((full - exact.hessian).norm() <= 1e-11 * exact.hessian.norm());
    }));
}

TEST_CASE("squared edge lengths: edge i lies opposite corner i") {
    const Corners v = {Vec3(0.0, 0.0, 0.0), Vec3(3.0, 0.0, 0.0), Vec3(0.0, 0.0, 4.0)};
    CHECK(squared_edge_lengths(v) == Vec3(25.0, 16.0, 9.0));
}

#include "ruche/geometry/rigid_alignment.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>

using namespace ruche;

namespace {

/// A handed cloud: no motion takes it to its mirror image.
std::vector<Vec3> helix() {
    std::vector<Vec3> points;
    for (int i = 0; i < 60; ++i) {
        const double t = 0.1 * i;
        points.emplace_back(3.0 * std::cos(t), 2.0 * std::sin(t), 0.7 * t + 0.1 * t * t);
    }
    return points;
}

std::vector<Vec3> moved(const std::vector<Vec3>& points, const Mat3& rotation, const Vec3& translation) {
    std::vector<Vec3> result;
    for (const Vec3& p : points) result.emplace_back(rotation * p + translation);
    return result;
}

const Mat3 turn = Eigen::AngleAxisd(2.3, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
const Mat3 mirror = Vec3(1.0, 1.0, -1.0).asDiagonal();
const Vec3 shift(40.0, -3.0, 7.0);

}  // namespace

TEST_CASE("alignment: a rigid motion is found again") {
    const RigidAlignment found = align(helix(), moved(helix(), turn, shift));
    CHECK(found.rms < 1e-12 * 50.0);
    CHECK((found.rotation - turn).norm() < 1e-12);
    CHECK((found.translation - shift).norm() < 1e-11);
}

TEST_CASE("alignment: a mirror image is only reached when a reflection is asked for") {
    const std::vector<Vec3> image = moved(helix(), turn * mirror, shift);
    CHECK(align(helix(), image).rms > 0.1);
    const RigidAlignment found = align(helix(), image, Handedness::mirrored);
    CHECK(found.rms < 1e-12 * 50.0);
    CHECK(found.rotation.determinant() == doctest::Approx(-1.0).epsilon(1e-12));
    CHECK(align(helix(), moved(helix(), turn, shift), Handedness::mirrored).rms > 0.1);
}

TEST_CASE("alignment: a flat shape is its own mirror image") {
    std::vector<Vec3> flat = helix();
    for (Vec3& p : flat) p.z() = 0.0;
    CHECK(align(flat, moved(flat, turn, shift)).rms < 1e-12 * 50.0);
    CHECK(align(flat, moved(flat, turn, shift), Handedness::mirrored).rms < 1e-12 * 50.0);
}

TEST_CASE("alignment: what is left is the distance that no motion removes") {
    // Two crosses in the plane; the arms of one are longer by d. By symmetry the best motion is none.
    const double d = 0.25;
    const std::vector<Vec3> cross = {{1, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, -2, 0}};
    const std::vector<Vec3> longer = {{1 + d, 0, 0}, {-1 - d, 0, 0}, {0, 2 + d, 0}, {0, -2 - d, 0}};
    CHECK(align(cross, moved(longer, turn, shift)).rms == doctest::Approx(d).epsilon(1e-12));
}

TEST_CASE("alignment: it is the best of all motions") {
    std::vector<Vec3> other = helix();
    for (std::size_t i = 0; i < other.size(); ++i)
        other[i].x() += 0.3 * std::sin(5.0 * static_cast<double>(i));
    const RigidAlignment best = align(helix(), other);
    const auto rms = [&](const Mat3& rotation, const Vec3& translation) {
        double squares = 0.0;
        const std::vector<Vec3> there = moved(helix(), rotation, translation);
        for (std::size_t i = 0; i < other.size(); ++i) squares += (there[i] - other[i]).squaredNorm();
        return std::sqrt(squares / static_cast<double>(other.size()));
    };
    CHECK(rms(best.rotation, best.translation) == doctest::Approx(best.rms).epsilon(1e-12));
    for (int axis = 0; axis < 3; ++axis) {
        for (const double size : {-1e-3, 1e-3}) {
            const Mat3 nudged = Eigen::AngleAxisd(size, Vec3::Unit(axis)).toRotationMatrix() * best.rotation;
            CHECK(rms(nudged, best.translation) > best.rms);
            CHECK(rms(best.rotation, best.translation + size * Vec3::Unit(axis)) > best.rms);
        }
    }
}

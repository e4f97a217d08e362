#include "ruche/output/relief.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <map>

#include "output/sample_results.hpp"

using namespace ruche;

namespace {

struct Sheet {
    TriangleMesh mesh = sample::grid({.width = 6, .height = 4, .nx = 6, .ny = 4});
    std::vector<Vec3> shape;
    std::vector<double> height;

    /// Flat, with a print of 0.5 mm on [1, 5] x [1, 3] and 0.8 mm on the part beyond x = 3.
    Sheet() {
        for (const Vec2& v : mesh.vertices) shape.emplace_back(v.x(), v.y(), 0.0);
        for (const Triangle& t : mesh.triangles) {
            const Vec2 c = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
            const bool inside = c.x() > 1 && c.x() < 5 && c.y() > 1 && c.y() < 3;
            height.push_back(!inside ? 0.0 : c.x() < 3 ? 0.5 : 0.8);
        }
    }
};

/// Volume between the relief and the plane z = 0, if it is closed by that plane (divergence theorem).
double volume(const Relief& relief) {
    double sum = 0.0;
    for (const Triangle& t : relief.triangles)
        sum += relief.positions[t[0]].dot(relief.positions[t[1]].cross(relief.positions[t[2]])) / 6.0;
    return sum;
}

}  // namespace

TEST_CASE("relief: sharp-edged prints of two heights enclose area times height, outwards") {
    const Sheet sheet;
    const Relief relief = raise(sheet.mesh, sheet.shape, sheet.height, {.segments = 0});
    CHECK(volume(relief) == doctest::Approx(2 * 2 * 0.5 + 2 * 2 * 0.8).epsilon(1e-12));
    CHECK(relief.source.size() == relief.triangles.size());
    for (std::size_t t = 0; t < relief.triangles.size(); ++t) CHECK(sheet.height[relief.source[t]] > 0.0);
}

TEST_CASE("relief: on the back it is the mirror image") {
    const Sheet sheet;
    const Relief front = raise(sheet.mesh, sheet.shape, sheet.height, {.side = Side::front, .rounding = 0.1});
    const Relief back = raise(sheet.mesh, sheet.shape, sheet.height, {.side = Side::back, .rounding = 0.1});
    CHECK(volume(back) == doctest::Approx(volume(front)).epsilon(1e-12));
    double lowest = 0.0, highest = 0.0;
    for (const Vec3& p : back.positions) {
        lowest = std::min(lowest, p.z());
        highest = std::max(highest, p.z());
    }
    CHECK(lowest == doctest::Approx(-0.8));
    CHECK(highest == doctest::Approx(0.0));
}

TEST_CASE("relief: a rounded rim takes away a little and its normals point outwards") {
    const Sheet sheet;
    const Relief sharp = raise(sheet.mesh, sheet.shape, sheet.height, {.segments = 0});
    const Relief round = raise(sheet.mesh, sheet.shape, sheet.height, {.rounding = 0.1, .segments = 4});
    // Each border loses (1 - pi/4) r^2 per length: perimeters 2 x 8 mm; a polygon for the arc, corners aside.
    const double lost = volume(sharp) - volume(round);
    CHECK(lost == doctest::Approx(16.0 * 0.01 * (1 - 0.7854)).epsilon(0.15));
    for (const Triangle& t : round.triangles) {
        const Vec3 facing = (round.positions[t[1]] - round.positions[t[0]])
                                .cross(round.positions[t[2]] - round.positions[t[0]]);
        for (const int v : t) CHECK(facing.dot(round.normals[v]) >= -1e-12);
    }
}

TEST_CASE("relief: two patches that touch in one point do not share it") {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 3, 4}, {0, 6, 1}};
    std::vector<Vec3> shape;
    for (const Vec2& v : mesh.vertices) shape.emplace_back(v.x(), v.y(), 0.0);
    const Relief relief = raise(mesh, shape, std::vector<double>{1, 1, 1, 1, 0, 0}, {.segments = 0});
    int tops = 0;
    for (std::size_t v = 0; v < relief.positions.size(); ++v)
        if (relief.layout[v].norm() < 1e-12 && relief.positions[v].z() == 1.0 && relief.normals[v].z() == 1.0)
            ++tops;
    CHECK(tops == 2);
    CHECK(volume(relief) == doctest::Approx(2.0));
}

TEST_CASE("relief: triangles that are not finite or have no area are left out") {
    Sheet sheet;
    sheet.shape[3].x() = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> everywhere(sheet.mesh.triangles.size(), 0.5);
    const Relief relief = raise(sheet.mesh, sheet.shape, everywhere, {.rounding = 0.1});
    CHECK(!relief.triangles.empty());
    for (const Triangle& t : relief.triangles)
        for (const int v : t) {
            CHECK(relief.positions[v].allFinite());
            CHECK(relief.normals[v].allFinite());
        }
}

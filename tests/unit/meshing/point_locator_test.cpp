#include "ruche/meshing/point_locator.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "ruche/meshing/structured.hpp"

using namespace ruche;

TEST_CASE("point locator: every point of the mesh is found where it is") {
    const TriangleMesh mesh = rectangle_mesh(MeshKind::jittered, {.length = 17, .width = 5, .across = 6});
    const PointLocator locator(mesh);
    CHECK(rc::check([&] {
        const Vec2 p(*rc::gen::inRange(0, 17001) / 1000.0, *rc::gen::inRange(0, 5001) / 1000.0);
        const auto found = locator.find(p, 1e-12);
        RC_ASSERT(found.has_value());
        RC_ASSERT((position(mesh, *found) - p).norm() < 1e-12);
        const double sum = found->weights[0] + found->weights[1] + found->weights[2];
        RC_ASSERT(std::abs(sum - 1.0) < 1e-12);
        for (const double w : found->weights) RC_ASSERT(w >= 0.0);
    }));
}

TEST_CASE("point locator: a point off the mesh goes to the nearest point within reach") {
    const TriangleMesh mesh = rectangle_mesh(MeshKind::alternating, {.length = 4, .width = 2, .across = 2});
    const PointLocator locator(mesh);
    CHECK_FALSE(locator.find(Vec2(2.2, 2.5), 0.4).has_value());
    const auto found = locator.find(Vec2(2.2, 2.5), 0.6);
    REQUIRE(found.has_value());
    CHECK((position(mesh, *found) - Vec2(2.2, 2.0)).norm() < 1e-12);
}

TEST_CASE("point locator: only admitted triangles are found") {
    const TriangleMesh mesh = rectangle_mesh(MeshKind::alternating, {.length = 4, .width = 1, .across = 1});
    const PointLocator locator(mesh);
    const auto right_half = [&](int t) {
        const Triangle& tri = mesh.triangles[t];
        return mesh.vertices[tri[0]].x() + mesh.vertices[tri[1]].x() + mesh.vertices[tri[2]].x() > 6.0;
    };
    const auto found = locator.find(Vec2(1.9, 0.5), 0.5, right_half);
    REQUIRE(found.has_value());
    CHECK(position(mesh, *found).x() == doctest::Approx(2.0));
    CHECK_FALSE(locator.find(Vec2(0.5, 0.5), 0.5, right_half).has_value());
}

TEST_CASE("point locator: an empty mesh has no points") {
    const TriangleMesh mesh;
    CHECK_FALSE(PointLocator(mesh).find(Vec2(0, 0), 1.0).has_value());
}

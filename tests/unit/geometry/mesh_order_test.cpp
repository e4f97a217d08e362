#include "ruche/geometry/mesh_order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ruche/meshing/structured.hpp"

using namespace ruche;

TEST_CASE("spatial order: triangles with near numbers lie near each other, whatever the order before") {
    TriangleMesh mesh = rectangle_mesh(MeshKind::alternating, {.length = 32, .width = 32, .across = 32});
    std::mt19937 random(7);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    const std::vector<int> order = spatial_order(mesh);
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < mesh.triangle_count(); ++i) REQUIRE(sorted[i] == i);

    const TriangleMesh ordered = reordered(mesh, order);
    const auto centre = [&](int t) -> Vec2 {
        const Triangle& tri = ordered.triangles[t];
        return (ordered.vertices[tri[0]] + ordered.vertices[tri[1]] + ordered.vertices[tri[2]]) / 3.0;
    };
    // Along a Hilbert curve each step goes to a neighbouring cell, of size 1 here.
    double mean = 0.0;
    for (int t = 1; t < ordered.triangle_count(); ++t) mean += (centre(t) - centre(t - 1)).norm();
    CHECK(mean / ordered.triangle_count() < 1.0);
}

TEST_CASE("reordered: triangles keep their shape and unused vertices go") {
    TriangleMesh mesh;
    mesh.vertices = {Vec2(9, 9), Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)};
    mesh.triangles = {{1, 2, 3}, {2, 4, 3}};
    const TriangleMesh result = reordered(mesh, {1, 0});
    CHECK(result.vertex_count() == 4);
    CHECK(result.triangles[0] == Triangle{0, 1, 2});
    CHECK(result.vertices[1] == Vec2(1, 1));
    CHECK(layout_area(result, 0) == doctest::Approx(0.5));
    CHECK(layout_area(result, 1) == doctest::Approx(0.5));
}

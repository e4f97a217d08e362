#include "ruche/meshing/structured.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/meshing/point_locator.hpp"

using namespace ruche;

static const MeshKind all_kinds[] = {MeshKind::lattice, MeshKind::alternating, MeshKind::criss_cross,
                                     MeshKind::jittered};

TEST_CASE("rectangle mesh: every kind covers the rectangle with counter-clockwise triangles") {
    for (const MeshKind kind : all_kinds) {
        for (const int across : {1, 2, 3, 4}) {
            const TriangleMesh mesh = rectangle_mesh(kind, {.length = 30, .width = 1, .across = across});
            double sum = 0.0;
            for (int t = 0; t < mesh.triangle_count(); ++t) {
                REQUIRE(layout_area(mesh, t) > 0.0);
                sum += layout_area(mesh, t);
            }
            CHECK(sum == doctest::Approx(30.0).epsilon(1e-12));
            // One edge loop around it: the border is as long as the rectangle's, and Euler's formula holds.
            const MeshEdges edges = find_edges(mesh);
            double border = 0.0;
            for (const Edge& edge : edges.edges) {
                if (edge.on_boundary()) {
                    border += (mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm();
                }
            }
            CHECK(border == doctest::Approx(62.0).epsilon(1e-12));
            CHECK(mesh.vertex_count() - static_cast<int>(edges.edges.size()) + mesh.triangle_count() == 1);
        }
    }
}

TEST_CASE("rectangle mesh: the lattice's triangles are nearly equilateral") {
    const TriangleMesh mesh = rectangle_mesh(MeshKind::lattice, {.length = 20, .width = 2, .across = 4});
    int nearly = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec2 a = mesh.vertices[t[1]] - mesh.vertices[t[0]];
        const Vec2 b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
        if (std::abs(a.norm() / b.norm() - 1.0) < 0.05 &&
            std::abs(a.dot(b) / (a.norm() * b.norm()) - 0.5) < 0.05) {
            ++nearly;
        }
    }
    CHECK(nearly > 0.9 * mesh.triangle_count());
}

TEST_CASE("rectangle mesh: jitter moves inner vertices, the same way every time") {
    const RectangleOptions options{.length = 10, .width = 4, .across = 4};
    const TriangleMesh plain = rectangle_mesh(MeshKind::alternating, options);
    const TriangleMesh one = rectangle_mesh(MeshKind::jittered, options);
    const TriangleMesh two = rectangle_mesh(MeshKind::jittered, options);
    CHECK(one.vertices == two.vertices);
    CHECK(one.triangles == plain.triangles);
    double largest = 0.0;
    for (int v = 0; v < one.vertex_count(); ++v) {
        largest = std::max(largest, (one.vertices[v] - plain.vertices[v]).norm());
    }
    CHECK(largest <= 0.3);
    CHECK(largest > 0.25);
    CHECK(rectangle_mesh(MeshKind::jittered, {.length = 10, .width = 4, .across = 4, .seed = 2}).vertices !=
          one.vertices);
}

TEST_CASE("rectangle mesh: the centre line runs from end to end on every kind") {
    for (const MeshKind kind : all_kinds) {
        const TriangleMesh mesh = rectangle_mesh(kind, {.length = 30, .width = 1, .across = 1});
        const std::vector<MeshPoint> line = points_on_mesh(mesh, {Vec2(0, 0.5), Vec2(30, 0.5)}, 61);
        REQUIRE(line.size() == 61);
        for (int i = 0; i < 61; ++i) {
            CHECK((position(mesh, line[i]) - Vec2(0.5 * i, 0.5)).norm() < 1e-9);
        }
    }
}

TEST_CASE("rectangle mesh: sizes that are not positive are an input error") {
    CHECK_THROWS_AS(rectangle_mesh(MeshKind::lattice, {.length = 0.0}), InputError);
    CHECK_THROWS_AS(rectangle_mesh(MeshKind::lattice, {.across = 0}), InputError);
    CHECK_THROWS_AS(rectangle_mesh(MeshKind::lattice, {.length = std::nan("")}), InputError);
    CHECK_THROWS_AS(rectangle_mesh(MeshKind::jittered, {.jitter = 0.5}), InputError);
}

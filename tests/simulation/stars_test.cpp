// The tiling of 3-pointed stars: a crumpling pattern that has to end in one and the same dome.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;

namespace {

/// Integral of the Gauss curvature over the part of the sheet printed within `radius` of the layout's centre:
/// the angles that are missing to 2 pi at its vertices.
double total_gauss_curvature(const Result& result, double radius) {
    const TriangleMesh& mesh = result.layout.mesh;
    Vec2 centre = Vec2::Zero();
    double largest = 0.0;
    for (const Vec2& p : mesh.vertices) centre += p / mesh.vertex_count();
    for (const Vec2& p : mesh.vertices) largest = std::max(largest, (p - centre).norm());
    REQUIRE(radius < largest - 2.0);  // vertices on the border do not count
    double sum = 0.0;
    for (const Vec2& p : mesh.vertices) sum += (p - centre).norm() < radius ? 2.0 * std::numbers::pi : 0.0;
    for (const Triangle& tri : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            if ((mesh.vertices[tri[i]] - centre).norm() >= radius) continue;
            const Vec3 a = result.shape[tri[(i + 1) % 3]] - result.shape[tri[i]];
            const Vec3 b = result.shape[tri[(i + 2) % 3]] - result.shape[tri[i]];
            sum -= std::atan2(a.cross(b).norm(), a.dot(b));
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("stars: the disc closes into a dome, the same from five seeds") {
    const std::string scene = RUCHE_TEST_DATA "/../../examples/stars/scene.toml";
    double energy = 0.0;
    for (int seed = 1; seed <= 5; ++seed) {
        CAPTURE(seed);
        const Result result =
            simulate(read_scene(scene, {parse_override("solver.seed=" + std::to_string(seed), "test")}));
        REQUIRE(result.equilibrium.status == SolveStatus::converged);
        CHECK(result.equilibrium.stable);
        CHECK(result.equilibrium.health.self_intersections == 0);
        // A hemisphere has 2 pi, a flat or rolled sheet 0 whatever its radius. The outer stars end at 15.7
        // mm.
        for (const double radius : {8.0, 11.0, 14.0, 16.0})
            CHECK(total_gauss_curvature(result, radius) > 0.25 * std::numbers::pi);
        CHECK(total_gauss_curvature(result, 16.0) > 0.75 * std::numbers::pi);
        if (seed == 1) energy = result.equilibrium.energy.total();
        CHECK(result.equilibrium.energy.total() == doctest::Approx(energy).epsilon(1e-9));
    }
}

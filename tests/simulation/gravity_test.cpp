// Weight: a released sheet laid on a table, from the scene to the shape.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "release.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

Scene small_sheet(double thickness, const std::string& gravity) {
    return parse_scene(fmt::format("pattern.generator = \"staggered\"\n"
                                   "pattern.options = {{ rows = 7, strips_per_row = 2 }}\n"
                                   "fabric.margin_mm = 1\nplastic.thickness_mm = {}\n{}",
                                   thickness, gravity),
                       "test.toml");
}

/// Layout area that each vertex stands for, mm^2.
std::vector<double> vertex_areas(const TriangleMesh& mesh) {
    std::vector<double> areas(mesh.vertices.size(), 0.0);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        for (const int v : mesh.triangles[t]) areas[v] += layout_area(mesh, t) / 3.0;
    }
    return areas;
}

/// N, from the card's densities and what is printed.
double weight(const Result& result) {
    const Material& m = result.scene.material;
    const auto& s = result.scene.fabric.prestretch;
    double tonnes = 0.0;
    for (int t = 0; t < result.layout.mesh.triangle_count(); ++t) {
        const Print& print = result.layout.print[t];
        tonnes +=
            layout_area(result.layout.mesh, t) * (1e-9 * m.fabric_areal_density / (s[0] * s[1]) +
                                                  1e-12 * m.plastic_density * (print.front + print.back));
    }
    return 9810.0 * tonnes;
}

}  // namespace

TEST_CASE("table: a released sheet rests on it, and it carries the weight") {
    const double height = -5.0;
    for (const double thickness : {0.6, 1.0}) {
        CAPTURE(thickness);
        const Result result = simulate(small_sheet(
            thickness, fmt::format("gravity = {{ acceleration_mm_per_s2 = [0, 0, -9810], table = true, "
                                   "table_height_mm = {} }}\n",
                                   height)));
        REQUIRE(certain(result.equilibrium));
        CHECK(result.equilibrium.residual < 1e-8);
        const double stiffness = scene_model(result.scene, result.layout).table.stiffness_per_area;
        const std::vector<double> areas = vertex_areas(result.layout.mesh);
        double lowest = infinity;
        double reaction = 0.0;
        double deepest_allowed = 0.0;  // no vertex carries more than the whole weight
        int touching = 0;
        for (std::size_t v = 0; v < areas.size(); ++v) {
            const double depth = height - result.shape[v].z();
            lowest = std::min(lowest, result.shape[v].z());
            if (depth <= 0.0) continue;
            reaction += stiffness * areas[v] * depth;
            deepest_allowed = std::max(deepest_allowed, weight(result) / (stiffness * areas[v]));
            ++touching;
        }
        CHECK(lowest < height);
        CHECK(lowest > height - deepest_allowed);
        CHECK(lowest > height - 0.01);
        CHECK(touching >= 3);
        // The balance is as good as the residual of all vertices together.
        const double balance = result.equilibrium.residual * static_cast<double>(areas.size());
        CHECK(std::abs(reaction - weight(result)) < balance + 1e-12 * weight(result));
        CHECK(weight(result) > 1e3 * balance);
        // Curled up: it is no pancake pressed on the table.
        const ShapeMetrics shape = measure_shape(result.layout, result.shape);
        CHECK(shape.box_max.z() - shape.box_min.z() > 2.0);
    }
}

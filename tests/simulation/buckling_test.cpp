// Sheets under compression: the straight state is stationary, and not where they stay.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;

TEST_CASE("buckling: a strip in a clamp that is four orders of magnitude stiffer leaves the straight state") {
    // 1.1 and 1.6 times Euler's load; heights by the elastica (validation/pushed-strip/height.csv).
    for (const auto& [force, height] : {std::pair("-0.028", 48.7639), std::pair("-0.04", 79.6677)}) {
        CAPTURE(force);
        const Scene scene =
            read_scene(RUCHE_TEST_DATA "/../../validation/pushed-strip/scene.toml",
                       {parse_override(std::string("force.1.force_n.1=") + force),
                        parse_override("mesh.size_mm=1"), parse_override("mesh.fabric_size_mm=1"),
                        parse_override("mesh.elements_across=2"), parse_override("output.picture=false")});
        const Result result = simulate(scene);
        CHECK(result.equilibrium.status == SolveStatus::converged);
        CHECK(result.equilibrium.stable);
        CHECK(result.equilibrium.iterations < 100);
        double highest = 0.0;
        for (const Vec3& p : result.shape) highest = std::max(highest, std::abs(p.z()));
        CHECK(highest == doctest::Approx(height).epsilon(0.02));
    }
}

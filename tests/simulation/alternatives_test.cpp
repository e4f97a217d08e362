// A wide thin strip rolls along its length or across its width; both are stable, and both have to be found.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>

#include "ruche/geometry/rigid_alignment.hpp"
#include "ruche/output/metrics.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;

namespace {

Scene wide_strip() {
    return parse_scene(
        "pattern.generator = \"strip\"\npattern.options = { length_mm = 60, width_mm = 5 }\n"
        "fabric.margin_mm = 0\nplastic.thickness_mm = 0.25\n",
        "test.toml");
}

bool certain(const Result& result) {
    return result.equilibrium.status == SolveStatus::converged && result.equilibrium.stable;
}

}  // namespace

TEST_CASE("alternatives: a wide thin strip also rolls across its width, 5.6 % higher") {
    const ResultWithAlternatives found = simulate_alternatives(wide_strip(), 2);
    REQUIRE(found.ordinary.alternatives.has_value());
    const ShapeList& list = *found.ordinary.alternatives;
    REQUIRE(found.shapes.size() == 2);
    REQUIRE(list.shapes.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        CAPTURE(i);
        CHECK(certain(found.shapes[i]));
        CHECK_FALSE(found.shapes[i].equilibrium.health.tangled);
        CHECK(list.shapes[i].number == static_cast<int>(i) + 1);
        CHECK(list.shapes[i].energy == found.shapes[i].equilibrium.energy.total());
        CHECK_FALSE(list.shapes[i].found_from.empty());
    }
    const double ratio = list.shapes[1].energy / list.shapes[0].energy;
    CHECK(ratio > 1.05);
    CHECK(ratio < 1.06);
    CHECK(list.shapes[0].ordinary);
    CHECK(found.shapes[0].shape == found.ordinary.shape);
    CHECK(align(found.shapes[0].shape, found.shapes[1].shape).rms > 1.0);
    // Rolled along its length the centre line is a spiral, across the width it is almost straight.
    const auto curvature = [](const Result& r) { return measure_strips(r.layout, r.shape).at(0).curvature; };
    CHECK(curvature(found.shapes[0]) > 0.3);
    CHECK(std::abs(curvature(found.shapes[1])) < 0.05);
    CHECK(list.symmetries.size() == 3);
}

TEST_CASE("alternatives: a stop keeps the ordinary shape and what was found before it") {
    std::atomic<bool> stop = false;
    Control control;
    control.stop = &stop;
    control.report = [&](const Progress& progress) {
        if (progress.phase == "search") stop = true;
    };
    const ResultWithAlternatives found = simulate_alternatives(wide_strip(), 2, control);
    CHECK(certain(found.ordinary));
    REQUIRE(found.ordinary.alternatives.has_value());
    CHECK(found.ordinary.alternatives->interrupted);
    REQUIRE(found.shapes.size() == 1);
    CHECK(found.shapes[0].shape == found.ordinary.shape);
}

// Contact: sheets that roll more than once around lie on themselves instead of passing through.
#include <doctest/doctest.h>

#include <map>
#include <string>

#include "release.hpp"
#include "ruche/core/parallel.hpp"
#include "ruche/geometry/self_intersection.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr double contact_distance = 0.5;  // mm

Result generated(const std::string& generator, const std::map<std::string, std::string>& options,
                 double thickness, double margin, bool contact) {
    Scene scene;
    scene.pattern.generator = generator;
    scene.pattern.generator_options = options;
    scene.plastic.thickness_mm = thickness;
    scene.fabric.margin_mm = margin;
    scene.model.contact = contact;
    scene.model.contact_distance = contact_distance;
    return simulate(scene);
}

/// Without contact the sheet passes through itself; with it, it is a certified minimum that does not.
void check_lies_on_itself(const Result& without, const Result& with) {
    CHECK(certain(without.equilibrium));
    CHECK(without.equilibrium.health.self_intersections > 100);
    CHECK(certain(with.equilibrium));
    CHECK(with.equilibrium.health.self_intersections == 0);
    CHECK(with.equilibrium.health.contact_pairs > 50);
    CHECK(with.equilibrium.health.smallest_gap > 0.1 * contact_distance);
    CHECK(with.equilibrium.health.smallest_gap < contact_distance);
    // Lying on itself costs a few percent of what the sheet stores anyway, the barrier's own energy much
    // less.
    CHECK(with.equilibrium.energy.contact > 0.0);
    CHECK(with.equilibrium.energy.contact < 1e-3 * with.equilibrium.energy.total());
    CHECK(with.equilibrium.energy.total() ==
          doctest::Approx(without.equilibrium.energy.total()).epsilon(0.03));
}

PrintMesh strip(double length, double thickness) {
    return printed(rectangle_mesh(MeshKind::jittered, {.length = length, .width = 1.0, .across = 2}),
                   [=](const Vec2&) { return thickness; });
}

Equilibrium released(const PrintMesh& layout, bool contact) {
    ModelInput input;
    input.options.contact = contact;
    input.options.contact_distance = contact_distance;
    return release(layout, input);
}

}  // namespace

TEST_CASE("contact: a thin strip that rolls three times around lies beside itself") {
    const std::map<std::string, std::string> options = {{"length_mm", "60"}};
    check_lies_on_itself(generated("strip", options, 0.4, 0.0, false),
                         generated("strip", options, 0.4, 0.0, true));
}

TEST_CASE("contact: a thin strip with fabric around it lies on itself") {
    const std::map<std::string, std::string> options = {{"length_mm", "60"}};
    check_lies_on_itself(generated("strip", options, 0.4, 2.0, false),
                         generated("strip", options, 0.4, 2.0, true));
}

TEST_CASE("contact: a staggered sheet that rolls more than once around lies on itself") {
    const std::map<std::string, std::string> options = {
        {"rows", "5"}, {"strips_per_row", "4"}, {"pitch_mm", "2"}};
    check_lies_on_itself(generated("staggered", options, 0.5, 1.0, false),
                         generated("staggered", options, 0.5, 1.0, true));
}

TEST_CASE("contact: where nothing touches it changes nothing") {
    const std::map<std::string, std::string> options = {{"length_mm", "12"}};
    const Result without = generated("strip", options, 0.6, 3.0, false);
    const Result with = generated("strip", options, 0.6, 3.0, true);
    REQUIRE(certain(with.equilibrium));
    CHECK(with.equilibrium.energy.total() == without.equilibrium.energy.total());
    CHECK(with.equilibrium.health.contact_pairs == 0);
    // Solved with contact from the beginning: the guard is on its way, too.
    const Equilibrium free = released(strip(12.0, 0.6), false);
    const Equilibrium guarded = released(strip(12.0, 0.6), true);
    REQUIRE(certain(guarded));
    CHECK(guarded.energy.contact == 0.0);
    CHECK(std::abs(guarded.energy.total() - free.energy.total()) <= 1e-12 * free.energy.total());
}

TEST_CASE("contact: the same bits at any number of threads") {
    const PrintMesh layout = strip(30.0, 0.4);
    const int before = thread_count();
    set_thread_count(1);
    const Equilibrium serial = released(layout, true);
    set_thread_count(3);
    const Equilibrium parallel = released(layout, true);
    set_thread_count(before);
    REQUIRE(certain(serial));
    CHECK(serial.health.contact_pairs > 0);
    CHECK(parallel.x == serial.x);
}

TEST_CASE("contact: a start that passes through itself is refused") {
    const PrintMesh layout = strip(60.0, 0.4);
    const Equilibrium crossing = released(layout, false);
    ModelInput input{.mesh = layout.mesh, .print = layout.print};
    input.options.contact = true;
    const Equilibrium refused = solve(Model(std::move(input)), {}, {}, &crossing.x);
    CHECK(refused.status == SolveStatus::not_converged);
    CHECK(refused.message == "the start passes through itself: contact cannot undo that");
}

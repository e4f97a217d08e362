// States that are made tangled on purpose: the solve has to see it and find a way around.
#include <doctest/doctest.h>

#include <cmath>

#include "release.hpp"
#include "ruche/statics/starts.hpp"
#include "ruche/statics/tangle.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// A strip of 24 x 2 mm in the middle of fabric, elements of 1 mm.
ModelInput strip_in_fabric() {
    ModelInput input;
    input.mesh = rectangle_mesh(MeshKind::alternating, {.length = 30.0, .width = 12.0, .across = 12});
    input.print = printed(input.mesh, [](const Vec2& p) {
                      return std::abs(p.x() - 15.0) < 12.0 && std::abs(p.y() - 6.0) < 1.0 ? 0.6 : 0.0;
                  }).print;
    return input;
}

/// The flat sheet with noise as large as its elements: many of them lie folded on each other.
Eigen::VectorXd crumpled(const Model& model, int seed) {
    constexpr double size_mm = 1.2;
    Eigen::VectorXd x = model.initial();
    for (int i = 0; i < 3 * model.vertex_count(); ++i) x[i] += size_mm * noise(seed, i);
    return x;
}

}  // namespace

TEST_CASE("tangle: a start that is a knot ends in the sheet's shape all the same, and the message says how") {
    const Model model(strip_in_fabric());
    const Equilibrium shape = solve(model);
    REQUIRE(certain(shape));
    REQUIRE_FALSE(shape.health.tangled);
    CHECK(shape.message == "strict local minimum");
    for (int seed = 1; seed <= 4; ++seed) {
        CAPTURE(seed);
        const Eigen::VectorXd knot = crumpled(model, seed);
        REQUIRE_FALSE(tangle(model.health(knot)).empty());
        const Equilibrium end = solve(model, {}, {}, &knot);
        CAPTURE(end.message);
        CHECK(certain(end));
        CHECK_FALSE(end.health.tangled);
        CHECK(end.energy.total() == doctest::Approx(shape.energy.total()).epsilon(1e-9));
        CHECK(end.message.find("tangled") != std::string::npos);
    }
}

#include "ruche/statics/contact_guard.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ruche/meshing/structured.hpp"

using namespace ruche;

namespace {

Model ribbon() {
    ModelInput input;
    input.mesh = rectangle_mesh(MeshKind::alternating, {.length = 20.0, .width = 1.0, .across = 1});
    input.options.contact = true;
    return Model(std::move(input));
}

/// Rolled into a circle by the angle t * 4 pi: twice around, in its own plane.
StateCurve rolling(const Model& model) {
    return [&model](double t) {
        Eigen::VectorXd x = model.initial();
        const double curvature = t * 4.0 * std::numbers::pi / 20.0;
        for (int v = 0; v < model.vertex_count() && curvature > 0.0; ++v) {
            const double angle = curvature * x[3 * v];
            x.segment<3>(3 * v) =
                Vec3(std::sin(angle) / curvature, x[3 * v + 1], (1.0 - std::cos(angle)) / curvature);
        }
        return x;
    };
}

}  // namespace

TEST_CASE("contact guard: a ribbon that rolls up is stopped when its ends meet") {
    const Model model = ribbon();
    const ContactGuard guard(model);
    const ClearPath path = guard.follow(model.initial(), rolling(model), 7.0);
    // Its ends meet after half of the turns; they begin to notice each other a little before.
    CHECK(path.end() > 0.48);
    CHECK(path.end() < 0.5);
    CHECK_FALSE(passes_through_itself(model, path.at(path.end())));
    // In between its states are those of the curve.
    const Eigen::VectorXd exact = rolling(model)(0.3 * path.end());
    CHECK((path.at(0.3 * path.end()) - exact).norm() == 0.0);
}

TEST_CASE("contact guard: a way that is clear is gone to its end") {
    const Model model = ribbon();
    const ContactGuard guard(model);
    const StateCurve half = [&](double t) { return rolling(model)(0.4 * t); };
    const ClearPath path = guard.follow(model.initial(), half, 3.0);
    CHECK(path.end() == 1.0);
    CHECK((path.at(1.0) - half(1.0)).norm() == 0.0);
}

TEST_CASE("contact guard: the model gets new pairs when parts come within reach, and only then") {
    Model model = ribbon();
    const ContactGuard guard(model);
    const Eigen::VectorXd flat = model.initial();
    CHECK_FALSE(guard.cover(model, flat, flat));
    const Eigen::VectorXd closed = rolling(model)(0.49);
    REQUIRE(guard.touches(closed));
    CHECK(model.energy_terms(closed).contact == 0.0);
    CHECK(guard.cover(model, flat, closed));
    CHECK(model.energy_terms(closed).contact > 0.0);
    CHECK_FALSE(guard.cover(model, flat, closed));
    CHECK_FALSE(guard.cover(model, closed, flat));
}

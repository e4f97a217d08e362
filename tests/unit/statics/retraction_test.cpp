#include "ruche/statics/retraction.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "energy/samples.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

Eigen::VectorXd some_step(const Model& model) {
    Eigen::VectorXd step(model.size());
    for (int i = 0; i < model.size(); ++i) step[i] = 0.2 * std::sin(1.7 * i + 0.3);
    return step;
}

}  // namespace

TEST_CASE("retraction: it starts along the step, with an error of second order in its length") {
    const Model model(patchwork());
    Retraction retraction(model);
    const Eigen::VectorXd x = rolled(model, {});
    const Eigen::VectorXd step = some_step(model);
    CHECK((retraction(x, step, 0.0) - x).norm() < 1e-12);
    double last = 0.0;
    for (const double t : {0.04, 0.02, 0.01, 0.005}) {
        const double error = (retraction(x, step, t) - x - t * step).norm();
        CAPTURE(error);
        if (last > 0.0) CHECK(last / error == doctest::Approx(4.0).epsilon(0.05));
        last = error;
    }
}

TEST_CASE("retraction: a rigid turn of the whole sheet stays rigid, however far") {
    const Model model(patchwork());
    Retraction retraction(model);
    const Eigen::VectorXd x = rolled(model, {});
    const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized();
    Eigen::VectorXd step = Eigen::VectorXd::Zero(model.size());
    for (int v = 0; v < model.vertex_count(); ++v)
        step.segment<3>(3 * v) = 2.0 * axis.cross(Vec3(x.segment<3>(3 * v)));
    const Eigen::VectorXd turned = retraction(x, step, 1.0);
    CHECK(retraction.rms_rotation(x, step) == doctest::Approx(2.0).epsilon(1e-12));
    for (int v = 1; v < model.vertex_count(); ++v) {
        const double before = (x.segment<3>(3 * v) - x.segment<3>(0)).norm();
        CHECK((turned.segment<3>(3 * v) - turned.segment<3>(0)).norm() ==
              doctest::Approx(before).epsilon(1e-10));
    }
    CHECK(model.energy(turned) == doctest::Approx(model.energy(x)).epsilon(1e-10));
}

TEST_CASE("retraction: squared lengths are linear along a step, between half and 1.6 times what they were") {
    const Model model(patchwork());
    Retraction retraction(model);
    const Eigen::VectorXd x = model.initial();
    Eigen::VectorXd step = Eigen::VectorXd::Zero(model.size());
    for (int v = 0; v < model.vertex_count(); ++v)
        step.segment<3>(3 * v) = Vec3(0.5 * x[3 * v] + 0.2 * x[3 * v + 1], 0.2 * x[3 * v], 0.0);
    // Principal strains and axes of the step's gradient, which is the same everywhere.
    const double root = std::hypot(0.25, 0.2);
    const double strains[] = {0.25 + root, 0.25 - root};
    const double angle = 0.5 * std::atan2(0.4, 0.5);
    const Vec3 axes[] = {Vec3(std::cos(angle), std::sin(angle), 0.0),
                         Vec3(-std::sin(angle), std::cos(angle), 0.0)};
    for (const double t : {0.3, 0.9, 2.0, -0.4, -0.7}) {
        CAPTURE(t);
        const Eigen::VectorXd stretched = retraction(x, step, t);
        for (int v = 1; v < model.vertex_count(); ++v) {
            const Vec3 before = x.segment<3>(3 * v) - x.segment<3>(0);
            Vec3 expected = Vec3::Zero();
            for (const int i : {0, 1}) {
                const double squared = std::clamp(1.0 + 2.0 * t * strains[i], 0.25, 2.56);
                expected += std::sqrt(squared) * axes[i].dot(before) * axes[i];
            }
            CHECK((stretched.segment<3>(3 * v) - stretched.segment<3>(0) - expected).norm() <
                  1e-11 * before.norm());
        }
    }
}

TEST_CASE("retraction: what is held stays, and what is taken elsewhere gets there") {
    ModelInput input = patchwork();
    input.supports = {{.vertex = 4, .fixed = {true, true, true}, .at = Vec3(1.0, 2.0, 3.0)},
                      {.vertex = 9, .fixed = {false, false, true}, .at = Vec3(0.0, 0.0, -1.0)}};
    const Model model(input);
    Retraction retraction(model);
    const Eigen::VectorXd start = retraction.meet_supports(rolled(model, {}));
    CHECK((start.segment<3>(3 * 4) - Vec3(1.0, 2.0, 3.0)).norm() < 1e-12);
    CHECK(start[3 * 9 + 2] == doctest::Approx(-1.0));
    Eigen::VectorXd step = some_step(model);
    step.segment<3>(3 * 4).setZero();
    step[3 * 9 + 2] = 0.0;
    const Eigen::VectorXd moved = retraction(start, step, 1.0);
    CHECK((moved.segment<3>(3 * 4) - start.segment<3>(3 * 4)).norm() < 1e-12);
    CHECK(moved[3 * 9 + 2] == doctest::Approx(start[3 * 9 + 2]));
}

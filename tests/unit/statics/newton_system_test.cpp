#include "ruche/statics/newton_system.hpp"

#include <doctest/doctest.h>

#include "energy/samples.hpp"
#include "ruche/energy/model.hpp"

using namespace ruche;
using namespace ruche::test;

TEST_CASE(
    "rest: a gradient that is but rounding of the coordinates counts as rest, a force above it does not") {
    const Model model(patchwork());
    Eigen::VectorXd x = rolled(model, {});
    AssembledSums sums;
    // Far from the origin coordinates are coarser, and so is the gradient.
    for (const double away : {0.0, 1e3, 1e6}) {
        CAPTURE(away);
        Eigen::VectorXd there = x;
        for (int v = 0; v < model.vertex_count(); ++v) there.segment<3>(3 * v).array() += away;
        model.evaluate(there, Order::hessian, sums);
        Eigen::VectorXd back = there;  // the state that is really stored
        for (int v = 0; v < model.vertex_count(); ++v) back.segment<3>(3 * v).array() -= away;
        AssembledSums exact = sums;
        exact.gradient = sums.gradient - model.gradient(x);
        const double noise = exact.gradient.cwiseAbs().maxCoeff();
        CHECK(at_rest_or_rounded({model, there, exact}, 1e-14));
        if (away > 0.0) CHECK(noise > 1e-15);
        // A force that is a few hundred times the noise is not taken for it.
        exact.gradient[4] += 1e3 * noise + 1e-9;
        CHECK_FALSE(at_rest_or_rounded({model, there, exact}, 1e-14));
        CHECK(at_rest_or_rounded({model, there, exact}, 1e4 * noise + 1e-8));
    }
}

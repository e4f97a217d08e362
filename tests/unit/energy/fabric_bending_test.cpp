#include "ruche/energy/fabric_bending.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "energy/battery.hpp"
#include "energy/oracle.hpp"
#include "energy/samples.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Edge of length 1.2 along x, triangles with the given altitudes; the second one rises by theta.
Eigen::VectorXd hinge(double theta, double altitude_c = 0.8, double altitude_d = 1.1) {
    Eigen::VectorXd x(12);
    x << 0.0, 0.0, 0.0, 1.2, 0.0, 0.0,  //
        0.5, altitude_c, 0.0,           //
        0.8, -altitude_d * std::cos(theta), altitude_d * std::sin(theta);
    return x;
}

const FabricBending term({{{0, 1, 2, 3}, 0.02}});
const Energy energy = energy_of(term, 4, 0);

}  // namespace

TEST_CASE("fabric bending: it passes the battery at small, large and almost closed angles") {
    for (const double theta : {0.0, 1e-9, 1e-4, 0.3, -0.7, 1.5, -2.5, 2.9}) {
        CAPTURE(theta);
        // Near pi the tangent bends within its distance from pi.
        const double step = 2e-3 * std::min(1.0, std::pow(std::numbers::pi - std::abs(theta), 2));
        check_battery(energy, hinge(theta), step);
        check_assembly(term, 4, 0, hinge(theta));
    }
}

TEST_CASE("fabric bending: value, gradient and Hessian agree with automatic differentiation") {
    std::mt19937 random(5);
    for (int k = 0; k < 30; ++k) {
        const double theta = -3.1 + 0.21 * k;
        CAPTURE(theta);
        const Eigen::VectorXd x = random_motion(random)(energy, hinge(theta, 0.3 + 0.05 * k, 1.5));
        const Local<12> local = term.evaluate(0, {x.data(), 4}, Order::hessian);
        const auto unknowns = jets<12>(x);
        const Jet<12> exact = HingeElement{0.02}.energy<Jet<12>>(unknowns);
        check_same({local.value, local.gradient, local.full_hessian()},
                   {exact.value, exact.gradient, exact.hessian}, 1e-11);
    }
}

TEST_CASE("fabric bending: energy is 2 k tan^2(theta/2), the same for a valley and a ridge, and zero flat") {
    for (const double theta : {1e-6, 0.2, 1.0, 2.0, 3.0}) {
        const double t = std::tan(0.5 * theta);
        CHECK(energy.value(hinge(theta)) == doctest::Approx(2.0 * 0.02 * t * t).epsilon(1e-12));
        CHECK(energy.value(hinge(-theta)) == doctest::Approx(2.0 * 0.02 * t * t).epsilon(1e-12));
    }
    const Sums flat = energy.evaluate(hinge(0.0), Order::hessian);
    CHECK(flat.value == 0.0);
    CHECK(flat.gradient.isZero(0.0));
    check_invariance(energy, energy, mirror_z(), hinge(0.7));
}

TEST_CASE("fabric bending: very thin triangles keep their derivatives") {
    check_derivatives(energy, hinge(0.4, 1e-3, 1.1), 1e-6);
    check_derivatives(energy, hinge(0.4, 1e-3, 1e-3), 1e-6);
}

TEST_CASE("fabric bending: a closed hinge or one without area is a barrier, not a crash") {
    CHECK_FALSE(energy.value(hinge(std::numbers::pi)) < 1e20);
    for (const Order order : {Order::value, Order::gradient, Order::hessian, Order::gauss_newton}) {
        const Eigen::VectorXd point = Eigen::VectorXd::Zero(12);
        CHECK_FALSE(std::isfinite(energy.evaluate(point, order).value));
        CHECK_FALSE(std::isfinite(energy.evaluate(hinge(0.2, 0.0), order).value));
    }
}

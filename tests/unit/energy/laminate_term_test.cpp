#include "ruche/energy/laminate_term.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "energy/battery.hpp"
#include "energy/oracle.hpp"
#include "energy/samples.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr double nu = 0.4;

const std::array<std::array<EdgeKind, 3>, 6> edge_kinds = {{
    {EdgeKind::free, EdgeKind::free, EdgeKind::free},
    {EdgeKind::averaged, EdgeKind::averaged, EdgeKind::averaged},
    {EdgeKind::free, EdgeKind::free_rim, EdgeKind::averaged},
    {EdgeKind::clamped_rim, EdgeKind::averaged, EdgeKind::free},
    {EdgeKind::free_rim, EdgeKind::clamped_rim, EdgeKind::free_rim},
    {EdgeKind::free_rim, EdgeKind::free_rim, EdgeKind::free_rim},
}};

/// The same star seen from the other side of the layout's plane: the print changes its side.
LaminateTerm flipped(const Star& star, const std::array<EdgeKind, 3>& kinds, PrintedLaminate print) {
    std::swap(print.front, print.back);
    std::swap(print.front_modulus, print.back_modulus);
    return {nu, {laminate_element(star, kinds, print)}};
}

}  // namespace

TEST_CASE("laminate: every kind of edge passes the battery, printed on the front, the back and both") {
    for (int k = 0; k < int(edge_kinds.size()); ++k) {
        CAPTURE(k);
        const Star star = random_star(k);
        const PrintedLaminate print = sample_print(k % 3 != 1, k % 3 != 0);
        const LaminateTerm term(nu, {laminate_element(star, edge_kinds[k], print)});
        const Energy energy = energy_of(term, 6, 3);
        check_battery(energy, star.x);
        check_invariance(energy, energy_of(flipped(star, edge_kinds[k], print), 6, 3), mirror_z(), star.x);
        check_assembly(term, 6, 3, star.x);
    }
}

TEST_CASE("laminate: value, gradient and Hessian agree with automatic differentiation") {
    for (unsigned seed = 0; seed < 18; ++seed) {
        CAPTURE(seed);
        const Star star = random_star(seed, seed < 12 ? 0.6 : 1e-7);
        const auto element =
            laminate_element(star, edge_kinds[seed % 6], sample_print(seed % 4 != 1, seed % 4 != 0));
        const LaminateTerm term(nu, {element});
        const Local<21> local = term.evaluate(0, {star.x.data(), 6}, Order::hessian);
        const auto unknowns = jets<21>(star.x);
        const Jet<21> exact = LaminateElement{element, nu}.energy<Jet<21>>(unknowns);
        check_same({local.value, local.gradient, local.full_hessian()},
                   {exact.value, exact.gradient, exact.hessian}, 1e-11);
    }
}

TEST_CASE("laminate: plies of one rest metric are at rest when flat on it") {
    Star star = random_star(4, 0.0);
    for (int v = 0; v < 6; ++v) star.x.segment<3>(3 * v) << star.layout[v], 0.0;
    star.x.tail(3).setZero();
    for (const auto& kinds : edge_kinds) {
        auto element = laminate_element(star, kinds, sample_print(true, true));
        for (Ply& ply : element.plies) ply.rest_metric = element.plies.back().rest_metric;
        const LaminateTerm term(nu, {element});
        const Energy energy = energy_of(term, 6, 3);
        std::mt19937 random(3);
        const Sums rest = energy.evaluate(random_motion(random)(energy, star.x), Order::hessian);
        CHECK(std::abs(rest.value) <= 1e-14 * rest.hessian.norm());
        CHECK(rest.gradient.norm() <= 1e-13 * rest.hessian.norm());
    }
}

TEST_CASE("laminate: a free rim costs no more than the same triangle with any rotation of that normal") {
    const Star star = random_star(9);
    const PrintedLaminate print = sample_print(true, false);
    const LaminateTerm rim(
        nu, {laminate_element(star, {EdgeKind::free_rim, EdgeKind::averaged, EdgeKind::averaged}, print)});
    const LaminateTerm free(
        nu, {laminate_element(star, {EdgeKind::free, EdgeKind::averaged, EdgeKind::averaged}, print)});
    const double least = rim.evaluate(0, {star.x.data(), 6}, Order::value).value;
    double best = infinity;
    Eigen::VectorXd x = star.x;
    for (double y = -2.0; y <= 2.0; y += 1e-3) {
        x[18] = y;
        best = std::min(best, free.evaluate(0, {x.data(), 6}, Order::value).value);
    }
    CHECK(least <= best);
    CHECK(best == doctest::Approx(least).epsilon(1e-5));
}

TEST_CASE("laminate: max_normal_rotation is the largest |theta/2 +- xi|") {
    Star star = random_star(0, 0.0);
    for (int v = 0; v < 6; ++v) star.x.segment<3>(3 * v) << star.layout[v], 0.0;
    star.x.tail(3) << 0.1, -0.3, 0.05;
    const LaminateTerm term(nu, {laminate_element(star, edge_kinds[0], sample_print(true, false))});
    // Flat: only xi = y / l, the mean altitudes of the sample being 0.7, 0.8, 0.9.
    CHECK(term.max_normal_rotation(0, {star.x.data(), 6}) == doctest::Approx(0.3 / 0.8).epsilon(1e-12));
}

TEST_CASE("laminate: thin triangles and steep folds keep their derivatives") {
    const auto compare = [](const Star& star, const std::array<EdgeKind, 3>& kinds, double tolerance) {
        const auto element = laminate_element(star, kinds, sample_print(true, false));
        const LaminateTerm term(nu, {element});
        const Local<21> local = term.evaluate(0, {star.x.data(), 6}, Order::hessian);
        const auto unknowns = jets<21>(star.x);
        const Jet<21> exact = LaminateElement{element, nu}.energy<Jet<21>>(unknowns);
        check_same({local.value, local.gradient, local.full_hessian()},
                   {exact.value, exact.gradient, exact.hessian}, tolerance);
    };
    Star star = random_star(2, 0.1);
    const Vec3 foot = 0.5 * (star.x.segment<3>(0) + star.x.segment<3>(3));
    star.x.segment<3>(6) = foot + 1e-4 * (star.x.segment<3>(6) - star.x.segment<3>(0));
    // As in the fabric, strain from squared lengths loses the square of the thinness to rounding.
    for (const auto& kinds : edge_kinds) compare(star, kinds, 1e-15 / 1e-8);
    for (unsigned seed = 0; seed < 6; ++seed) compare(random_star(seed, 3.0), edge_kinds[seed % 2], 1e-10);
}

TEST_CASE("laminate: a collapsed triangle or flap is a number or not finite, but never a crash") {
    const Star star = random_star(1);
    const LaminateTerm term(nu, {laminate_element(star, edge_kinds[0], sample_print(true, false))});
    Eigen::VectorXd x = star.x;
    x.segment<3>(9) = x.segment<3>(3);  // a flap without area
    CHECK_FALSE(std::isfinite(term.evaluate(0, {x.data(), 6}, Order::hessian).value));
    x = Eigen::VectorXd::Zero(21);
    for (const Order order : {Order::value, Order::gradient, Order::hessian, Order::gauss_newton}) {
        CHECK_FALSE(std::isfinite(term.evaluate(0, {x.data(), 6}, order).value));
    }
}

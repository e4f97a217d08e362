#include "ruche/energy/contact.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "energy/battery.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr double stiffness = 0.02;

ContactPair pair_of(PairKind kind, double area = 0.7) {
    ContactPair pair{.kind = kind, .reach = 0.5, .area = area, .parallel = 1e-3};
    for (int i = 0; i < corner_count(kind); ++i) pair.vertices[i] = i;
    return pair;
}

Eigen::VectorXd state(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    Eigen::VectorXd x(12);
    x << a, b, c, d;
    return x;
}

struct ContactSample {
    const char* name;
    PairKind kind;
    Eigen::VectorXd x;
};

/// One of every region in which the closest points can lie, within reach.
std::vector<ContactSample> samples() {
    const Vec3 a(0, 0, 0), b(1.2, 0.1, 0), c(0.2, 0.9, 0.1);
    const Vec3 far(9, 9, 9);
    return {
        {"vertex, inside of a triangle", PairKind::vertex_triangle, state({0.4, 0.3, 0.25}, a, b, c)},
        {"vertex, edge of a triangle", PairKind::vertex_triangle, state({0.6, -0.2, 0.25}, a, b, c)},
        {"vertex, corner of a triangle", PairKind::vertex_triangle, state({-0.2, -0.2, 0.1}, a, b, c)},
        {"vertex, inside of an edge", PairKind::vertex_edge, state({0.5, 0.2, 0.2}, a, b, far)},
        {"vertex, end of an edge", PairKind::vertex_edge, state({1.4, 0.2, 0.1}, a, b, far)},
        {"two vertices", PairKind::vertex_vertex, state({0.1, 0.2, 0.2}, a, far, far)},
        {"two edges that cross", PairKind::edge_edge, state(a, b, {0.3, -0.5, 0.2}, {0.7, 0.6, 0.3})},
        {"two edges, end and inside", PairKind::edge_edge, state(a, b, {0.3, 0.3, 0.2}, {0.7, 0.9, 0.3})},
        {"two edges, end and end", PairKind::edge_edge, state(a, b, {1.4, 0.3, 0.1}, {1.9, 0.9, 0.3})},
        {"two nearly parallel edges", PairKind::edge_edge, state(a, b, {0.1, 0.02, 0.2}, {1.3, 0.11, 0.21})},
    };
}

/// Two vertices at the distance u^(1/2) reach.
Eigen::VectorXd apart(double u) {
    return state({0, 0, 0}, {0, 0.5 * std::sqrt(u), 0}, Vec3::Zero(), Vec3::Zero());
}

}  // namespace

TEST_CASE("contact: it passes the battery wherever the closest points lie") {
    for (const ContactSample& sample : samples()) {
        CAPTURE(sample.name);
        const ContactBarrier term(stiffness, {pair_of(sample.kind)});
        const Energy energy = energy_of(term, 4, 0);
        REQUIRE(energy.value(sample.x) > 0.0);
        check_battery(energy, sample.x, 2e-4);
        check_assembly(term, 4, 0, sample.x);
    }
}

TEST_CASE("contact: the sample of nearly parallel edges is one, and the others are not") {
    for (const ContactSample& sample : samples()) {
        if (sample.kind != PairKind::edge_edge) continue;
        ContactPair sharp = pair_of(sample.kind);
        sharp.parallel = 0.0;
        const ContactBarrier with(stiffness, {pair_of(sample.kind)});
        const ContactBarrier without(stiffness, {sharp});
        const bool same = energy_of(with, 4, 0).value(sample.x) == energy_of(without, 4, 0).value(sample.x);
        CHECK(same == (std::string(sample.name) != "two nearly parallel edges"));
    }
}

TEST_CASE("contact: a pair that takes back a double count has no Gauss-Newton part") {
    const ContactBarrier term(stiffness, {pair_of(PairKind::vertex_edge, -0.7)});
    const Energy energy = energy_of(term, 4, 0);
    const Eigen::VectorXd x = samples()[3].x;
    check_battery(energy, x, 2e-4);
    CHECK(energy.evaluate(x, Order::gauss_newton).hessian.isZero(0.0));
    CHECK(energy.value(x) < 0.0);
}

TEST_CASE("contact: energy is -k A (u - 1)^2 ln u, nothing from the reach on, and infinite at contact") {
    const ContactBarrier term(stiffness, {pair_of(PairKind::vertex_vertex)});
    const Energy energy = energy_of(term, 4, 0);
    for (const double u : {1e-6, 0.01, 0.25, 0.8, 0.999}) {
        const double expected = -stiffness * 0.7 * (u - 1.0) * (u - 1.0) * std::log(u);
        CHECK(energy.value(apart(u)) == doctest::Approx(expected).epsilon(1e-10));
    }
    for (const double u : {1.0 + 1e-12, 2.0}) {
        const Sums none = energy.evaluate(apart(u), Order::hessian);
        CHECK(none.value == 0.0);
        CHECK(none.gradient.isZero(0.0));
        CHECK(none.hessian.isZero(0.0));
    }
    for (const Order order : {Order::value, Order::gradient, Order::hessian, Order::gauss_newton})
        CHECK_FALSE(std::isfinite(energy.evaluate(apart(0.0), order).value));
}

TEST_CASE("contact: it begins smoothly, with the third power of what is missing to the reach") {
    const ContactBarrier term(stiffness, {pair_of(PairKind::vertex_vertex)});
    const Energy energy = energy_of(term, 4, 0);
    const auto at = [&](double missing) { return energy.value(apart(1.0 - missing)); };
    CHECK(std::log2(at(2e-3) / at(1e-3)) == doctest::Approx(3.0).epsilon(1e-3));
}

TEST_CASE("contact: the force between two vertices follows the closed form and is equal and opposite") {
    const ContactBarrier term(stiffness, {pair_of(PairKind::vertex_vertex)});
    const Energy energy = energy_of(term, 4, 0);
    // d = reach/2: u = 1/4, db/du = -(3 ln 2 + 9/4), du/dd = 2 d / reach^2 = 1 / reach.
    const Eigen::VectorXd force = -energy.gradient(apart(0.25));
    const double expected = stiffness * 0.7 * (3.0 * std::log(2.0) + 2.25) / 0.5;
    CHECK(force[4] == doctest::Approx(expected).epsilon(1e-12));
    CHECK(force[1] == doctest::Approx(-expected).epsilon(1e-12));
}

#include "ruche/energy/loads.hpp"

#include <doctest/doctest.h>

#include "energy/battery.hpp"

using namespace ruche;
using namespace ruche::test;

TEST_CASE("table: it passes the battery above, below and across its plane") {
    const TableContact term({.up = Vec3(0.6, 0.0, 0.8), .height = 0.5}, {2.0, 3.0, 0.0, 5.0});
    const Energy energy = energy_of(term, 4, 0);
    Eigen::VectorXd x(12);
    x << 0.1, 0.2, 0.1, 1.0, 0.0, 1.0, -3.0, 0.0, -1.0, 0.0, 4.0, -0.3;
    check_derivatives(energy, x);
    check_orders(energy, x);
    check_assembly(term, 4, 0, x);
    // Vertex 0 lies 0.36 below (6 % of 0.1 and 8 % of 0.1 against 0.5), vertex 1 above, vertex 3 0.74 below.
    CHECK(energy.value(x) == doctest::Approx(0.5 * 2.0 * 0.36 * 0.36 + 0.5 * 5.0 * 0.74 * 0.74));
}

TEST_CASE("table: sliding along it and turning about its normal change nothing, and it only pushes up") {
    const TableContact term({.up = Vec3::UnitZ(), .height = 0.2}, {2.0, 3.0});
    const Energy energy = energy_of(term, 2, 0);
    Eigen::VectorXd x(6);
    x << 0.1, 0.2, -0.4, 1.0, 0.0, 0.1;
    check_invariance(energy, energy, turn_about_z(0.7, Vec3(3.0, -2.0, 0.0)), x);
    const Eigen::VectorXd force = -energy.gradient(x);
    CHECK(force.head<2>().isZero(0.0));
    CHECK(force[2] == doctest::Approx(2.0 * 0.6));
    x[2] = 0.2;
    CHECK(energy.gradient(x).head<3>().isZero(0.0));
}

TEST_CASE("lumped mass: a third of each triangle's mass goes to each of its vertices") {
    const Eigen::VectorXd mass = lumped_mass(5, {{{0, 1, 2}, 3.0}, {{2, 1, 3}, 6.0}});
    CHECK(mass.isApprox(Eigen::Matrix<double, 5, 1>(1.0, 3.0, 3.0, 2.0, 0.0)));
}

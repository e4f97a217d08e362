#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "reference_data.hpp"
#include "ruche/material/fabric_law.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr double one_pascal = 1e-6;  // in MPa

/// Strain (E_dd, E_tt, 2 E_dt) in axes d, t, which lie at an angle to the fabric's, to fabric axes, and back
/// for stresses (the transpose, as both do the same work).
Mat3 to_fabric_axes(double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    Mat3 m;
    m << c * c, s * s, -c * s,  //
        s * s, c * c, c * s,    //
        2.0 * c * s, -2.0 * c * s, c * c - s * s;
    return m;
}

struct Pull {
    Vec3 strain = Vec3::Zero();  // in the axes of the pull
    Vec3 stress = Vec3::Zero();
};

/// Pulled to E_dd with transverse and shear strain free: Newton's method on S_tt = S_dt = 0, from the start
/// given, the step halved where the energy would not fall.
Pull pull(const FabricLaw& law, double angle, double strain, Pull state) {
    const Mat3 turn = to_fabric_axes(angle);
    state.strain[0] = strain;
    const auto energy = [&](const Vec3& e) { return law(turn * e).energy; };
    for (int iteration = 0; iteration < 60; ++iteration) {
        const FabricResponse response = law(turn * state.strain);
        state.stress = turn.transpose() * response.stress;
        const Mat3 tangent = turn.transpose() * response.tangent * turn;
        const Vec2 step = -tangent.bottomRightCorner<2, 2>().inverse() * state.stress.tail<2>();
        if (step.norm() < 1e-14) break;
        Vec3 next = state.strain;
        double length = 2.0;
        do {
            length *= 0.5;
            next.tail<2>() = state.strain.tail<2>() + length * step;
        } while (!(energy(next) <= energy(state.strain) + 1e-15) && length > 1e-6);
        state.strain = next;
    }
    return state;
}

/// The curves print ten digits; strains near zero are differences of numbers near one.
bool agrees_relatively(double found, double expected, double relative = 1e-8) {
    return std::abs(found - expected) <= relative * std::abs(expected) + 1e-9;
}

}  // namespace

TEST_CASE("fabric law: a material point pulled at seven angles follows the reference curves") {
    const auto rows = read_csv("uniaxial_orthotropic.csv");
    REQUIRE(rows.size() == 210);  // two blends, seven angles, fifteen stretches
    Pull state;
    for (const std::vector<double>& row : rows) {
        const double stretch = row[2];
        CAPTURE(row[0]);
        CAPTURE(row[1]);
        CAPTURE(stretch);
        Material m;
        m.neo_hookean_share = row[0] == 0.0 ? 0.0 : 0.01;
        if (stretch == 1.0) state = Pull{};
        state = pull(FabricLaw(m), row[1] * std::numbers::pi / 180.0, 0.5 * (stretch * stretch - 1.0), state);
        CHECK(agrees_relatively(state.stress[0] / one_pascal, row[3]));
        CHECK(agrees_relatively(stretch * state.stress[0] / one_pascal, row[4]));
        CHECK(agrees_relatively(state.strain[1], row[5]));
        CHECK(agrees_relatively(std::sqrt(1.0 + 2.0 * state.strain[1]), row[6]));
        CHECK(agrees_relatively(state.strain[2], row[7]));
        CHECK(agrees_relatively(stretch * stretch * state.stress[0] / one_pascal, row[8]));
    }
}

TEST_CASE("fabric law: with the paper's closure it gives eq. 10, and eq. 12 without 1/(1 - nu^2)") {
    Material m;
    m.neo_hookean_share = 0.0;
    const FabricLaw law(m);
    const double nu = m.fabric_poissons_ratio;
    const auto rows = read_csv("uniaxial_paper_closure.csv");
    REQUIRE(rows.size() == 30);
    constexpr double eight_digits = 5e-8;
    for (const std::vector<double>& row : rows) {
        const int axis = row[0] == 0.0 ? 0 : 1;
        const double stretch = row[1];
        CAPTURE(axis);
        CAPTURE(stretch);
        Vec3 strain = Vec3::Zero();
        strain[axis] = row[2];
        strain[1 - axis] = -nu * row[2];
        const double eq10 = law(strain).stress[axis] / one_pascal;
        const double eq12 = eq10 - nu * nu * (law.elasticity() * strain)[axis] / one_pascal;
        // J of the closure: the transverse stretch is sqrt(1 - 2 nu E).
        const double area_ratio = stretch * std::sqrt(1.0 - 2.0 * nu * row[2]);
        for (const auto& [stress, column] : {std::pair{eq12, 3}, {eq10, 7}}) {
            CHECK(agrees_relatively(stress, row[column], eight_digits));
            CHECK(agrees_relatively(stretch * stress, row[column + 1], eight_digits));
            CHECK(agrees_relatively(stretch * stretch * stress, row[column + 2], eight_digits));
            CHECK(agrees_relatively(stretch * stretch * stress / area_ratio, row[column + 3], eight_digits));
        }
    }
}

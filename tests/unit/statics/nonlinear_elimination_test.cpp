#include "ruche/statics/nonlinear_elimination.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "energy/samples.hpp"
#include "ruche/statics/equilibrium.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// A sheet of 20 x 20 cells, bare but for a strip, at rest except that one vertex was pulled out of place.
struct Disturbed {
    static constexpr int cells = 20;
    Model model;
    Eigen::VectorXd rest;
    Eigen::VectorXd x;
    int vertex = -1;

    Disturbed() : model(input()), rest(solve(model).x), x(rest) {
        const auto& vertices = model.input().mesh.vertices;
        for (int v = 0; v < model.vertex_count(); ++v) {
            if (vertex < 0 || (vertices[v] - Vec2(5, 5)).norm() < (vertices[vertex] - Vec2(5, 5)).norm())
                vertex = v;
        }
        x.segment<3>(3 * vertex) += Vec3(0.25, -0.15, 0.2);
    }
    static ModelInput input() {
        ModelInput sheet;
        sheet.mesh = random_grid(cells, cells, 0.2, 5);
        for (const Triangle& tri : sheet.mesh.triangles) {
            const Vec2 centre =
                (sheet.mesh.vertices[tri[0]] + sheet.mesh.vertices[tri[1]] + sheet.mesh.vertices[tri[2]]) /
                3.0;
            sheet.print.push_back({.front = centre.x() > 12 && centre.x() < 14 ? 0.8 : 0.0});
        }
        sheet.prestretch = {1.4, 1.4};
        return sheet;
    }
};

}  // namespace

TEST_CASE("nonlinear elimination: a vertex out of place is brought back and nothing else moves far") {
    const Disturbed sheet;
    Eigen::VectorXd x = sheet.x;
    const std::vector<char> held(sheet.model.size(), 0);
    NonlinearElimination eliminate(sheet.model, held);
    REQUIRE(sheet.model.energy(x) > sheet.model.energy(sheet.rest) + 1e-3);
    const auto distance = [&] { return (x - sheet.rest).cwiseAbs().maxCoeff(); };
    // Each round stops at a hundredth of the force that it began with.
    const double enough = 1e-5 * distance();
    int rounds = 0;
    for (; rounds < 4 && distance() > enough; ++rounds) {
        const double before = sheet.model.energy(x);
        Eigen::VectorXd gradient = sheet.model.gradient(x);
        const double fell = eliminate(sheet.model, x, gradient, 1);
        CHECK(fell > 0.0);
        CHECK(std::abs(before - fell - sheet.model.energy(x)) < 1e-13 * before);    // rounding of the sum
        CHECK((gradient - sheet.model.gradient(x)).cwiseAbs().maxCoeff() < 1e-11);  // rounding, N
    }
    CHECK(rounds <= 3);
}

TEST_CASE("nonlinear elimination: what a support holds stays") {
    const Disturbed sheet;
    Eigen::VectorXd x = sheet.x;
    std::vector<char> held(sheet.model.size(), 0);
    for (int c = 0; c < 3; ++c) held[3 * sheet.vertex + c] = 1;
    Eigen::VectorXd gradient = sheet.model.gradient(x);
    for (int c = 0; c < 3; ++c) gradient[3 * sheet.vertex + c] = 0.0;
    NonlinearElimination eliminate(sheet.model, held);
    CHECK(eliminate(sheet.model, x, gradient, 1) > 0.0);
    CHECK(gradient.segment<3>(3 * sheet.vertex).isZero(0.0));
    CHECK(x.segment<3>(3 * sheet.vertex) == sheet.x.segment<3>(3 * sheet.vertex));
}

TEST_CASE("nonlinear elimination: after a step a spot that folded over is put right") {
    const Disturbed sheet;
    const std::vector<char> held(sheet.model.size(), 0);
    NonlinearElimination eliminate(sheet.model, held);
    // The step turns the sheet, rigidly; one vertex it throws across its neighbours.
    const Eigen::AngleAxisd turn(0.4, Vec3(1, 2, 2).normalized());
    Eigen::VectorXd x = sheet.rest;
    for (int v = 0; v < sheet.model.vertex_count(); ++v)
        x.segment<3>(3 * v) = turn * Vec3(sheet.rest.segment<3>(3 * v)) + Vec3(3, 1, -2);
    x.segment<3>(3 * sheet.vertex) += turn * Vec3(1.9, 0.3, 0.0);
    REQUIRE(sheet.model.health(x).max_dihedral_deg > 120.0);
    const double before = sheet.model.energy(x);
    Eigen::VectorXd gradient = sheet.model.gradient(x);
    const double fell = eliminate.after_step(sheet.model, sheet.rest, 0.1, x, gradient);
    const double least = sheet.model.energy(sheet.rest);
    CHECK(std::abs(before - fell - sheet.model.energy(x)) < 1e-12 * before);
    CHECK((gradient - sheet.model.gradient(x)).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(sheet.model.energy(x) - least < 1e-3 * (before - least));
    CHECK(sheet.model.health(x).max_dihedral_deg < sheet.model.health(sheet.rest).max_dihedral_deg + 5.0);
}

TEST_CASE("nonlinear elimination: after a step too, what a support holds stays") {
    const Disturbed sheet;
    std::vector<char> held(sheet.model.size(), 0);
    for (int c = 0; c < 3; ++c) held[3 * sheet.vertex + c] = 1;
    NonlinearElimination eliminate(sheet.model, held);
    Eigen::VectorXd x = sheet.x;
    Eigen::VectorXd gradient = sheet.model.gradient(x);
    for (int c = 0; c < 3; ++c) gradient[3 * sheet.vertex + c] = 0.0;
    CHECK(eliminate.after_step(sheet.model, sheet.rest, 1e-3, x, gradient) > 0.0);
    CHECK(x.segment<3>(3 * sheet.vertex) == sheet.x.segment<3>(3 * sheet.vertex));
}

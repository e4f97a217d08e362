#include "ruche/statics/nonlinear_elimination.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

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
        pull(Vec3(-0.3, 0.1, 0.15));
    }
    /// At rest but for the vertex, by so much along an edge there, across it and along the normal.
    void pull(const Vec3& by) {
        x = rest;
        x.segment<3>(3 * vertex) += frame(vertex) * by;
    }
    std::vector<int> moved(const Eigen::VectorXd& to) const {
        std::vector<int> vertices;
        for (int v = 0; v < model.vertex_count(); ++v) {
            if (to.segment<3>(3 * v) != x.segment<3>(3 * v)) vertices.push_back(v);
        }
        return vertices;
    }
    /// How the sheet lies in space at a vertex: along an edge, across it, along the normal. Where in space a
    /// free sheet ends is of no meaning.
    Mat3 frame(int at) const {
        for (const Triangle& tri : model.input().mesh.triangles) {
            if (tri[0] != at) continue;
            const auto edge = [&](int corner) -> Vec3 {
                return rest.segment<3>(3 * tri[corner]) - rest.segment<3>(3 * at);
            };
            const Vec3 along = edge(1).normalized();
            const Vec3 normal = edge(1).cross(edge(2)).normalized();
            return (Mat3() << along, normal.cross(along), normal).finished();
        }
        return Mat3::Identity();
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
    Disturbed sheet;
    const std::vector<char> held(sheet.model.size(), 0);
    NonlinearElimination eliminate(sheet.model, held);
    const double least = sheet.model.energy(sheet.rest);
    for (const Vec3& by : {Vec3(0.2, 0.07, 0.1), Vec3(-0.2, 0.07, 0.1), Vec3(0.07, -0.2, 0.1),
                           Vec3(0.07, 0.2, -0.1), Vec3(-0.14, -0.14, 0.0), Vec3(0.0, 0.0, 0.2)}) {
        sheet.pull(by);
        for (const int rings : {0, 1}) {
            CAPTURE(by.transpose());
            CAPTURE(rings);
            Eigen::VectorXd x = sheet.x;
            const double excess = sheet.model.energy(x) - least;
            REQUIRE(excess > 1e-3);
            const double force = sheet.model.gradient(x).cwiseAbs().maxCoeff();
            for (int round = 0; round < 2; ++round) {
                const double before = sheet.model.energy(x);
                Eigen::VectorXd gradient = sheet.model.gradient(x);
                const double fell = eliminate(sheet.model, x, gradient, rings);
                CHECK(fell > 0.0);
                CHECK(std::abs(before - fell - sheet.model.energy(x)) <
                      1e-13 * before);  // rounding of the sum
                const Eigen::VectorXd exact = sheet.model.gradient(x);
                CHECK((gradient - exact).cwiseAbs().maxCoeff() < 1e-11);  // rounding, N
                if (round > 0) continue;
                // A hundredth of the force is left where it acted, and its square of the energy, and as much
                // again where the neighbours pull.
                for (const int v : sheet.moved(x))
                    CHECK(exact.segment<3>(3 * v).cwiseAbs().maxCoeff() <= 0.01 * force);
                CHECK(sheet.model.energy(x) - least < 1e-3 * excess);
            }
            CHECK(sheet.moved(x).size() < sheet.model.vertex_count() / 4.0);
            CHECK((x - sheet.rest).cwiseAbs().maxCoeff() < 0.01 * by.norm());
        }
    }
}

TEST_CASE("nonlinear elimination: a ring of neighbours moves with a spot, more rings than are cheap do not") {
    const Disturbed sheet;
    const std::vector<char> held(sheet.model.size(), 0);
    NonlinearElimination eliminate(sheet.model, held);
    const auto moved = [&](int rings) {
        Eigen::VectorXd x = sheet.x;
        Eigen::VectorXd gradient = sheet.model.gradient(x);
        CHECK(eliminate(sheet.model, x, gradient, rings) > 0.0);
        return sheet.moved(x);
    };
    const std::vector<int> alone = moved(0);
    const std::vector<int> with_ring = moved(1);
    CHECK(with_ring.size() > alone.size());
    CHECK(std::includes(with_ring.begin(), with_ring.end(), alone.begin(), alone.end()));
    for (const int v : with_ring) {
        bool near = false;
        for (const Triangle& tri : sheet.model.input().mesh.triangles) {
            for (const int spot : alone)
                near |=
                    std::count(tri.begin(), tri.end(), v) > 0 && std::count(tri.begin(), tri.end(), spot) > 0;
        }
        CHECK(near);
    }
    CHECK(moved(100) == with_ring);
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
    CHECK(eliminate(sheet.model, x, gradient, 0) > 0.0);
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

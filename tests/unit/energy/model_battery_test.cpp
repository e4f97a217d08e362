#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>

#include "energy/battery.hpp"
#include "energy/oracle_model.hpp"
#include "energy/samples.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Inside the law, and with all bare fabric beyond it.
std::array<Roll, 2> states(const SetUp& set_up) {
    return {{{.turned = set_up.turns_freely},
             {.scale = 1.25, .noise = 0.01, .edge_noise = 0.2, .seed = 2, .turned = set_up.turns_freely}}};
}

Print swapped(const Print& p) { return {p.back, p.front, p.back_modulus, p.front_modulus}; }

/// The same sheet with its vertices and triangles numbered anew and the corners of triangles rotated, and how
/// its unknowns are numbered: unknown i of the original is sign[i] times unknown to[i].
struct Relabelled {
    ModelInput input;
    std::vector<int> to;
    std::vector<double> sign;
};

template <class T>
void shuffle(std::vector<T>& v, std::mt19937& random) {
    std::shuffle(v.begin(), v.end(), random);
}

Relabelled relabel(const Model& model, unsigned seed) {
    std::mt19937 random(seed);
    const ModelInput& old = model.input();
    std::vector<int> vertex(old.mesh.vertex_count());
    std::iota(vertex.begin(), vertex.end(), 0);
    shuffle(vertex, random);
    std::vector<int> triangle(old.mesh.triangle_count());
    std::iota(triangle.begin(), triangle.end(), 0);
    shuffle(triangle, random);  // new triangle k is old triangle[k]
    Relabelled result{old, std::vector<int>(model.size()), std::vector<double>(model.size(), 1.0)};
    ModelInput& input = result.input;
    for (int v = 0; v < old.mesh.vertex_count(); ++v) {
        input.mesh.vertices[vertex[v]] = old.mesh.vertices[v];
        for (int c = 0; c < 3; ++c) result.to[3 * v + c] = 3 * vertex[v] + c;
    }
    for (int k = 0; k < int(triangle.size()); ++k) {
        const Triangle& from = old.mesh.triangles[triangle[k]];
        const int turn = static_cast<int>(random() % 3);
        for (int i = 0; i < 3; ++i) input.mesh.triangles[k][i] = vertex[from[(i + turn) % 3]];
        input.print[k] = old.print[triangle[k]];
    }
    for (NodalForce& force : input.forces) force.vertex = vertex[force.vertex];
    for (Rod& rod : input.rods) {
        for (int& v : rod.vertices) v = vertex[v];
    }

    const Model renumbered(input);
    std::map<std::pair<int, int>, int> place;  // by directed edge, as its first triangle sees it
    for (int at = 3 * model.vertex_count(); at < renumbered.size(); ++at) {
        const auto around = renumbered.vertices_of_edge_unknown(at - 3 * model.vertex_count());
        place[{around[0], around[1]}] = at;
    }
    for (int at = 3 * model.vertex_count(); at < model.size(); ++at) {
        const auto around = model.vertices_of_edge_unknown(at - 3 * model.vertex_count());
        const int a = vertex[around[0]];
        const int b = vertex[around[1]];
        const bool same = place.contains({a, b});
        // What an open rim has for its unknown does not turn about the edge.
        const bool rim = around[2] == around[3];
        result.sign[at] = same || rim ? 1.0 : -1.0;
        result.to[at] = same ? place.at({a, b}) : place.at({b, a});
    }
    return result;
}

}  // namespace

TEST_CASE("model: gradient and Hessian agree with finite differences in every set-up") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        for (const Roll& roll : states(set_up))
            check_derivatives(energy_of(model), rolled(model, roll), 2e-3);
    }
}

TEST_CASE("model: value, gradient and Hessian agree with the oracle in every set-up") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        for (const Roll& roll : states(set_up)) {
            const Eigen::VectorXd x = rolled(model, roll);
            check_same(energy_of(model).evaluate(x, Order::hessian), oracle_sums(set_up.input, x), 1e-11);
        }
    }
}

TEST_CASE("model: value and gradient are the same at every order and Gauss-Newton is semidefinite") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        for (const Roll& roll : states(set_up)) check_orders(energy_of(model), rolled(model, roll));
    }
}

TEST_CASE("model: rigid motions leave the energy and carry gradient and Hessian along") {
    std::mt19937 random(5);
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        // Along gravity nothing moves freely, and a force does not turn with the sheet.
        if (!set_up.turns_freely) continue;
        const Motion motion = random_motion(random);
        check_invariance(energy_of(model), energy_of(model), motion, rolled(model, {}));
    }
}

TEST_CASE("model: under gravity on a table, turning about the vertical and sliding change nothing") {
    ModelInput input = set_ups().back().input;
    input.forces.clear();
    const Model model(std::move(input));
    // Weight does not change as the sheet slides, up to a constant that its height fixes.
    check_invariance(energy_of(model), energy_of(model), turn_about_z(1.1, Vec3(20.0, -7.0, 0.0)),
                     rolled(model, {.turned = false}));
}

TEST_CASE("model: the mirror image printed on the other side has the same energy") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        ModelInput other = set_up.input;
        for (Print& print : other.print) print = swapped(print);
        for (Rod& rod : other.rods) rod.side = rod.side == Side::front ? Side::back : Side::front;
        // The table turns over with gravity.
        for (double& g : other.gravity) g = -g;
        for (NodalForce& force : other.forces) force.force.z() *= -1.0;
        const Model model(set_up.input);
        const Model mirrored(std::move(other));
        const Eigen::VectorXd x = rolled(model, {.turned = set_up.turns_freely});
        check_invariance(energy_of(model), energy_of(mirrored), mirror_z(), x);
    }
}

TEST_CASE("model: a layout and a fabric axis turned together give the same energy") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        constexpr double angle = 0.4;
        ModelInput turned = set_up.input;
        const Mat2 rotation = Eigen::Rotation2Dd(angle).toRotationMatrix();
        for (Vec2& p : turned.mesh.vertices) p = Vec2(rotation * p);
        turned.fabric_axis_deg += angle * 180.0 / std::numbers::pi;
        const Model model(set_up.input);
        const Model other(std::move(turned));
        const Eigen::VectorXd x = rolled(model, {.turned = set_up.turns_freely});
        check_same(energy_of(other).evaluate(x, Order::hessian), energy_of(model).evaluate(x, Order::hessian),
                   1e-11);
    }
}

TEST_CASE("model: a quarter turn of the axes exchanges the fabric's two directions") {
    ModelInput input = patchwork();
    input.prestretch = {1.5, 1.3};
    ModelInput other = input;
    other.fabric_axis_deg = 90.0;
    std::swap(other.prestretch[0], other.prestretch[1]);
    std::swap(other.material.alpha_1, other.material.alpha_2);
    std::swap(other.material.beta_1, other.material.beta_2);
    std::swap(other.material.gamma_1, other.material.gamma_2);
    const Model model(input);
    const Model exchanged(other);
    const Eigen::VectorXd x = rolled(model, {});
    check_same(energy_of(exchanged).evaluate(x, Order::hessian), energy_of(model).evaluate(x, Order::hessian),
               1e-11);
}

TEST_CASE("model: numbering vertices, triangles and corners anew changes nothing") {
    for (const SetUp& set_up : set_ups()) {
        CAPTURE(set_up.name);
        const Model model(set_up.input);
        const Relabelled anew = relabel(model, 17);
        const Model renumbered(anew.input);
        const Eigen::VectorXd x = rolled(model, {.turned = set_up.turns_freely});
        Eigen::VectorXd y(x.size());
        for (int i = 0; i < x.size(); ++i) y[anew.to[i]] = anew.sign[i] * x[i];
        const Sums there = energy_of(renumbered).evaluate(y, Order::hessian);
        Sums back{there.value, Eigen::VectorXd(x.size()), Eigen::MatrixXd(x.size(), x.size())};
        for (int i = 0; i < x.size(); ++i) {
            back.gradient[i] = anew.sign[i] * there.gradient[anew.to[i]];
            for (int j = 0; j < x.size(); ++j) {
                back.hessian(i, j) = anew.sign[i] * anew.sign[j] * there.hessian(anew.to[i], anew.to[j]);
            }
        }
        check_same(back, energy_of(model).evaluate(x, Order::hessian), 1e-12);
        CHECK(std::abs(there.value - model.energy(x)) <= 1e-13 * std::abs(there.value));
    }
}

TEST_CASE("model: without pre-stretch, printed and bare sheets are at rest as printed") {
    for (const bool printed : {false, true}) {
        ModelInput input = patchwork();
        input.prestretch = {1.0, 1.0};
        if (!printed) input.print.clear();
        const Model model(std::move(input));
        const Sums rest = energy_of(model).evaluate(model.initial(), Order::hessian);
        CHECK(std::abs(rest.value) <= 1e-13 * rest.hessian.norm());
        CHECK(rest.gradient.norm() <= 1e-13 * rest.hessian.norm());
    }
}

TEST_CASE("model: the same bits at 1, 2 and 5 threads on a mesh of many blocks") {
    ModelInput input;
    input.mesh = random_grid(24, 20, 0.2, 6);
    for (int t = 0; t < input.mesh.triangle_count(); ++t) {
        input.print.push_back(
            {.front = input.mesh.vertices[input.mesh.triangles[t][0]].x() < 12 ? 0.6 : 0.0});
    }
    const Model model(std::move(input));
    const Eigen::VectorXd x = rolled(model, {});
    check_thread_independent([&]() -> Sums {
        AssembledSums sums;
        const double value = model.evaluate(x, Order::hessian, sums).total();
        const Eigen::Map<const Eigen::VectorXd> hessian(sums.hessian.data(),
                                                        Eigen::Index(sums.hessian.size()));
        return {value, sums.gradient, hessian};
    });
}

TEST_CASE("model: with another extension of the law it is the model built anew, and the first one stays") {
    // At a pre-stretch of 1.9 the flat sheet is beyond the log terms, where the extension decides.
    ModelInput input = patchwork();
    input.prestretch = {1.9, 1.9};
    const Model model(input);
    input.options.log_extension = 1e-2;
    const Model anew(input);
    const Eigen::VectorXd x = model.initial();
    const Sums before = energy_of(model).evaluate(x, Order::hessian);
    const Model narrowed = model.with_log_extension(1e-2);
    CHECK(narrowed.input().options.log_extension == 1e-2);
    const Sums exchanged = energy_of(narrowed).evaluate(x, Order::hessian);
    check_same(exchanged, energy_of(anew).evaluate(x, Order::hessian), 0.0);
    check_same(energy_of(model).evaluate(x, Order::hessian), before, 0.0);
    CHECK(std::abs(exchanged.value - before.value) > 1e-3 * std::abs(before.value));
    CHECK_THROWS_AS(model.with_log_extension(10.0), InputError);
}

#include "ruche/energy/rods.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "energy/battery.hpp"
#include "energy/oracle.hpp"
#include "energy/samples.hpp"
#include "ruche/core/error.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

/// Two edges of a rod and the four triangles at them, deformed at random and turned in space: vertices 0 to 2
/// along the rod, 3 to 6 the corners, edge unknowns 7 and 8.
Eigen::VectorXd random_joint_state(unsigned seed, double noise = 0.25) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-noise, noise);
    const Vec2 layout[7] = {{0.0, 0.0},  {1.0, 0.1}, {2.1, 0.0}, {0.4, 0.9},
                            {0.7, -0.8}, {1.5, 0.8}, {1.4, -0.9}};
    Eigen::VectorXd x(23);
    for (int v = 0; v < 7; ++v) x.segment<3>(3 * v) << layout[v], 0.0;
    for (double& c : x.head(21)) c += uniform(random);
    x.tail(2) << uniform(random), uniform(random);
    if (noise == 0.0) x.tail(2).setZero();
    const Motion motion = random_motion(random);
    for (int v = 0; v < 7; ++v)
        x.segment<3>(3 * v) = motion.rotation * x.segment<3>(3 * v) + motion.translation;
    return x;
}

RodJoint::Element joint_element() {
    return {{0, 1, 2},           {{{3, 4}, {5, 6}}},    {7, 8}, {0.9, 1.2}, {1.0, 1.0},
            Vec3(0.7, 1.3, 5.1), Vec3(0.05, 0.12, -0.1)};
}

RodEdge::Element edge_element() { return {{0, 1, 2, 3}, 4, 1.1, 40.0, 0.02}; }

Eigen::VectorXd edge_state(unsigned seed) {
    const Eigen::VectorXd joint = random_joint_state(seed);
    Eigen::VectorXd x(13);
    x << joint.head(6), joint.segment(9, 6), joint[21];
    return x;
}

/// The middle of the strip along x on a 6 x 2 grid of squares as a rod.
ModelInput straight_rod(int edges, double length = 1.0) {
    ModelInput input;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i <= edges; ++i) input.mesh.vertices.emplace_back(i * length, (j - 1) * length);
    }
    const int row = edges + 1;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < edges; ++i) {
            const int a = j * row + i;
            input.mesh.triangles.push_back({a, a + 1, a + row + 1});
            input.mesh.triangles.push_back({a + row + 1, a + row, a});
        }
    }
    Rod rod{.width = 1.2, .thickness = 0.6};
    for (int i = 0; i <= edges; ++i) rod.vertices.push_back(row + i);
    input.rods = {rod};
    input.options.strips = StripModel::rods;
    return input;
}

}  // namespace

TEST_CASE("rods: edge and joint pass the battery") {
    for (unsigned seed = 0; seed < 6; ++seed) {
        CAPTURE(seed);
        const RodJoint joint({joint_element()});
        const Eigen::VectorXd x = random_joint_state(seed);
        check_battery(energy_of(joint, 7, 2), x);
        check_assembly(joint, 7, 2, x);
        const RodEdge edge({edge_element()});
        const Eigen::VectorXd y = edge_state(seed);
        check_battery(energy_of(edge, 4, 1), y);
        check_assembly(edge, 4, 1, y);
    }
}

TEST_CASE("rods: value, gradient and Hessian agree with automatic differentiation") {
    for (unsigned seed = 0; seed < 12; ++seed) {
        CAPTURE(seed);
        const Eigen::VectorXd x = random_joint_state(seed, seed < 10 ? 0.3 : 1e-6);
        const RodJoint joint({joint_element()});
        const Local<23> local = joint.evaluate(0, {x.data(), 7}, Order::hessian);
        const auto unknowns = jets<23>(x);
        const Jet<23> exact = RodJointElement{joint_element()}.energy<Jet<23>>(unknowns);
        check_same({local.value, local.gradient, local.full_hessian()},
                   {exact.value, exact.gradient, exact.hessian}, 1e-11);
        const Eigen::VectorXd y = edge_state(seed);
        const Local<13> of_edge = RodEdge({edge_element()}).evaluate(0, {y.data(), 4}, Order::hessian);
        const auto edge_unknowns = jets<13>(y);
        const Jet<13> exact_edge = RodEdgeElement{edge_element()}.energy<Jet<13>>(edge_unknowns);
        check_same({of_edge.value, of_edge.gradient, of_edge.full_hessian()},
                   {exact_edge.value, exact_edge.gradient, exact_edge.hessian}, 1e-11);
    }
}

TEST_CASE(
    "rods: mirrored, a rod on the other side has the same energy, and the way along it does not matter") {
    for (unsigned seed = 0; seed < 4; ++seed) {
        const Eigen::VectorXd x = random_joint_state(seed);
        const RodJoint joint({joint_element()});
        RodJoint::Element other = joint_element();
        other.rest = Vec3(-other.rest[0], -other.rest[1], other.rest[2]);
        const RodJoint mirrored({other});
        check_invariance(energy_of(joint, 7, 2), energy_of(mirrored, 7, 2), mirror_z(), x);

        RodJoint::Element back = joint_element();
        back.vertices = {2, 1, 0};
        back.corners = {{{6, 5}, {4, 3}}};
        back.unknowns = {8, 7};
        std::swap(back.lengths[0], back.lengths[1]);
        back.signs = {-1.0, -1.0};
        back.rest[2] *= -1.0;
        check_same(energy_of(RodJoint({back}), 7, 2).evaluate(x, Order::hessian),
                   energy_of(joint, 7, 2).evaluate(x, Order::hessian), 1e-11);
    }
}

TEST_CASE("rods: the natural curvature is the bimetal's, on the side that is printed") {
    ModelInput input;
    const Rod front{.width = 1.0, .thickness = 0.6};
    const Rod back{.width = 1.0, .thickness = 1.0, .side = Side::back};
    for (const double angle : {0.0, 0.4, 2.0}) {
        const Vec2 along(std::cos(angle), std::sin(angle));
        // A front print curls with the fabric, on the back, on the concave side: t turns towards -n.
        CHECK(natural_curvature(input, front, along)[1] == doctest::Approx(0.152362385).epsilon(1e-8));
        CHECK(natural_curvature(input, back, along)[1] == doctest::Approx(-0.051255722).epsilon(1e-8));
        CHECK(std::abs(natural_curvature(input, front, along)[0]) < 1e-12);
    }
    // Unequal pre-stretch twists what lies between the axes, one way or the other.
    input.prestretch = {1.7, 1.3};
    const Vec2 x(1.0, 0.0);
    const Vec2 diagonal = Vec2(1.0, 1.0).normalized();
    const Vec2 other = Vec2(1.0, -1.0).normalized();
    CHECK(std::abs(natural_curvature(input, front, x)[0]) < 1e-12);
    const double twist = natural_curvature(input, front, diagonal)[0];
    CHECK(std::abs(twist) > 0.01);
    CHECK(natural_curvature(input, front, other)[0] == doctest::Approx(-twist).epsilon(1e-10));
    CHECK(natural_curvature(input, back, diagonal)[0] * twist < 0.0);
}

TEST_CASE("rods: stretch, twist and bending store what the closed forms say") {
    ModelInput input = straight_rod(8);
    input.prestretch = {1.0, 1.0};
    Material& m = input.material;
    m.fabric_bending_stiffness = m.alpha_1 = m.alpha_2 = m.alpha_3 = m.beta_1 = m.beta_2 = 0.0;
    m.neo_hookean_share = 0.0;
    const Model model(input);
    const double e = m.plastic_youngs_modulus;
    const Eigen::VectorXd flat = model.initial();
    CHECK(model.energy(flat) < 1e-25);

    Eigen::VectorXd x = flat;
    for (int v = 0; v < model.vertex_count(); ++v) x[3 * v] *= 1.01;
    const double green = 0.5 * (1.01 * 1.01 - 1.0);
    CHECK(model.energy(x) == doctest::Approx(0.5 * e * 1.2 * 0.6 * green * green * 8.0).epsilon(1e-10));

    // Sections turned one against the other.
    x = flat;
    constexpr double per_edge = 0.02;
    for (int k = 0; k < 8; ++k) x[3 * model.vertex_count() + k] = per_edge * k;
    const double j =
        0.2287 * 1.2 * std::pow(0.6, 3);  // Timoshenko and Goodier's table: 0.229 a b^3 for a = 2 b
    const double twist = 2.0 * std::tan(0.5 * per_edge);
    CHECK(model.energy(x) == doctest::Approx(0.5 * e / 2.8 * j * twist * twist * 7.0).epsilon(2e-3));

    // On a cylinder: radius 10, chords of 1 mm.
    x = flat;
    const double turn = 0.1;
    const double radius = 0.5 / std::sin(0.5 * turn);
    for (int v = 0; v < model.vertex_count(); ++v) {
        const double angle = turn * flat[3 * v];
        x[3 * v] = radius * std::sin(angle);
        x[3 * v + 2] = radius * (1.0 - std::cos(angle));
    }
    const double bend = 2.0 * std::tan(0.5 * turn);
    CHECK(model.energy(x) ==
          doctest::Approx(0.5 * e * 1.2 * std::pow(0.6, 3) / 12.0 * bend * bend * 7.0).epsilon(1e-9));
}

TEST_CASE("rods: on a helix strains approach curvatures and twist with the second order of the edge length") {
    // A ribbon on the helix (r cos s, r sin s, p s) whose normal points to the axis, turned by 0.3 about it.
    constexpr double r = 4.0;
    constexpr double p = 2.0;
    constexpr double tilt = 0.3;
    const double speed = std::hypot(r, p);
    const double curvature = r / (speed * speed);
    const double torsion = p / (speed * speed);
    const auto error = [&](double h) {
        const auto place = [&](double s) -> Vec3 { return {r * std::cos(s), r * std::sin(s), p * s}; };
        const auto side = [&](double s) -> Vec3 {
            const Vec3 t = Vec3(-r * std::sin(s), r * std::cos(s), p) / speed;
            const Vec3 to_axis(-std::cos(s), -std::sin(s), 0.0);
            const Vec3 n = std::cos(tilt) * to_axis + std::sin(tilt) * t.cross(to_axis);
            return n.cross(t);
        };
        const double ds = h / speed;
        Eigen::VectorXd x = Eigen::VectorXd::Zero(23);
        for (int k = 0; k < 3; ++k) x.segment<3>(3 * k) = place(k * ds);
        for (int e = 0; e < 2; ++e) {
            const double s = (e + 0.5) * ds;
            x.segment<3>(9 + 6 * e) = place(s) + h * side(s);
            x.segment<3>(12 + 6 * e) = place(s) - h * side(s);
        }
        RodJoint::Element element = joint_element();
        element.lengths = {h, h};
        const Vec3 kappa = RodJoint({element}).strain(0, {x.data(), 7}) / h;
        const Vec3 exact(torsion, -curvature * std::cos(tilt), curvature * std::sin(tilt));
        return (kappa - exact).norm();
    };
    CHECK(error(0.02) < 1e-4);
    CHECK(std::log2(error(0.2) / error(0.1)) == doctest::Approx(2.0).epsilon(0.1));
}

TEST_CASE("rods: the fabric at a rod's section stores what its hinge would without a rod") {
    // For small folds and a section that stands in the middle.
    ModelInput with = straight_rod(4);
    Material& m = with.material;
    m.alpha_1 = m.alpha_2 = m.alpha_3 = m.beta_1 = m.beta_2 = m.neo_hookean_share = 0.0;
    ModelInput without = with;
    without.rods.clear();
    without.options.strips = StripModel::shell;
    const Model rods(with);
    const Model bare(without);
    Eigen::VectorXd x = bare.initial();
    for (int v = 0; v < bare.vertex_count(); ++v) x[3 * v + 2] = 1e-3 * std::abs(x[3 * v + 1]);
    Eigen::VectorXd y = rods.initial();
    y.head(x.size()) = x;
    const double flat = rods.energy(rods.initial());
    const double folded = rods.energy(y) - flat;
    CHECK(folded == doctest::Approx(bare.energy(x)).epsilon(1e-5));
    // A turned section costs.
    y[3 * rods.vertex_count() + 1] += 1e-3;
    CHECK(rods.energy(y) > folded + flat);
}

TEST_CASE("rods: what is no rod is refused") {
    const auto refused = [](auto&& change) {
        ModelInput input = straight_rod(4);
        change(input);
        CHECK_THROWS_AS(Model{input}, InputError);
    };
    refused([](ModelInput& input) { input.rods[0].vertices = {5, 7}; });
    refused([](ModelInput& input) { input.rods[0].vertices = {0, 1, 2}; });  // on the boundary
    refused([](ModelInput& input) { input.rods[0].vertices = {5}; });
    refused([](ModelInput& input) { input.rods[0].vertices = {5, 99}; });
    refused([](ModelInput& input) { input.rods[0].width = 0.0; });
    refused([](ModelInput& input) { input.print.assign(input.mesh.triangles.size(), {.front = 0.6}); });
    refused([](ModelInput& input) { input.options.strips = StripModel::shell; });
    CHECK_NOTHROW(Model{straight_rod(4)});
}

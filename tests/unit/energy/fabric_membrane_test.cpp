#include "ruche/energy/fabric_membrane.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "energy/battery.hpp"
#include "energy/oracle.hpp"
#include "energy/samples.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr FabricLaw::Options plain{};

Material without_blend() {
    Material m;
    m.neo_hookean_share = 0.0;
    return m;
}

/// One triangle stretched by the given factors along the fabric axes, sheared, and turned in space.
struct Sample {
    std::array<Vec2, 3> relaxed;
    Eigen::VectorXd x;
};
Sample sample(double stretch_1, double stretch_2, unsigned seed) {
    const Star star = random_star(seed);
    Sample s{{star.layout[0], star.layout[1], star.layout[2]}, Eigen::VectorXd::Zero(9)};
    std::mt19937 random(seed);
    const Motion motion = random_motion(random);
    for (int v = 0; v < 3; ++v) {
        const Vec2 p = s.relaxed[v];
        s.x.segment<3>(3 * v) =
            motion.rotation * Vec3(stretch_1 * p.x() + 0.1 * p.y(), stretch_2 * p.y(), 0.0) +
            motion.translation;
    }
    return s;
}

FabricMembrane membrane(const Sample& s, const Material& m, const FabricLaw::Options& options = plain) {
    return {FabricLaw(m, options), m.fabric_thickness, {{{0, 1, 2}, s.relaxed}}};
}

}  // namespace

TEST_CASE("fabric membrane: it passes the battery inside the law, compressed and beyond the log terms") {
    for (const auto& [stretch_1, stretch_2] :
         {std::pair{1.2, 1.4}, {0.6, 1.5}, {1.0, 1.0}, {1.9, 2.1}, {0.3, 1.8}}) {
        CAPTURE(stretch_1);
        const Sample s = sample(stretch_1, stretch_2, 5);
        const FabricMembrane term = membrane(s, Material{});
        check_battery(energy_of(term, 3, 0), s.x, 2e-3);
        check_assembly(term, 3, 0, s.x);
    }
}

TEST_CASE("fabric membrane: value, gradient and Hessian agree with automatic differentiation") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        CAPTURE(seed);
        const Sample s = sample(0.5 + 0.09 * seed, 1.9 - 0.06 * seed, seed);
        const Material material = seed % 3 == 0 ? without_blend() : Material{};
        const FabricLaw::Options options{.log_extension = 1e-2, .tensor_shear = seed % 2 == 0};
        const FabricMembrane term = membrane(s, material, options);
        const Local<9> local = term.evaluate(0, {s.x.data(), 3}, Order::hessian);
        const FabricElement oracle{s.relaxed, material, options};
        const auto unknowns = jets<9>(s.x);
        const Jet<9> exact = oracle.energy<Jet<9>>(unknowns);
        check_same({local.value, local.gradient, local.full_hessian()},
                   {exact.value, exact.gradient, exact.hessian}, 1e-11);
    }
}

TEST_CASE("fabric membrane: relaxed fabric has neither energy nor force, wherever it lies") {
    const Sample s = sample(1.0, 1.0, 8);
    const FabricMembrane term = membrane(s, Material{});
    Eigen::VectorXd x(9);
    for (int v = 0; v < 3; ++v) x.segment<3>(3 * v) << s.relaxed[v], 0.0;
    std::mt19937 random(3);
    const Energy energy = energy_of(term, 3, 0);
    const Sums rest = energy.evaluate(random_motion(random)(energy, x), Order::hessian);
    CHECK(std::abs(rest.value) <= 1e-15 * rest.hessian.norm());
    CHECK(rest.gradient.norm() <= 1e-14 * rest.hessian.norm());
}

TEST_CASE("fabric membrane: green_strain is that of the deformation gradient") {
    const Sample s = sample(1.3, 1.1, 2);
    const Vec3 strain = membrane(s, Material{}).green_strain(0, {s.x.data(), 3});
    // F = [[1.3, 0.1], [0, 1.1]]
    CHECK(strain[0] == doctest::Approx(0.5 * (1.3 * 1.3 - 1.0)).epsilon(1e-13));
    CHECK(strain[1] == doctest::Approx(0.5 * (0.01 + 1.1 * 1.1 - 1.0)).epsilon(1e-13));
    CHECK(strain[2] == doctest::Approx(1.3 * 0.1).epsilon(1e-12));
}

TEST_CASE("fabric membrane: thin triangles keep their derivatives") {
    for (const double thinness : {1e-2, 1e-4}) {
        Sample s = sample(1.1, 1.2, 4);
        s.relaxed = {Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(0.5, thinness)};
        for (int v = 0; v < 3; ++v) {
            s.x.segment<3>(3 * v) << 1.1 * s.relaxed[v].x(), 1.2 * s.relaxed[v].y(), 0.0;
        }
        const FabricMembrane term = membrane(s, Material{});
        const Local<9> local = term.evaluate(0, {s.x.data(), 3}, Order::hessian);
        const auto unknowns = jets<9>(s.x);
        const Jet<9> exact = FabricElement{s.relaxed, Material{}, plain}.energy<Jet<9>>(unknowns);
        // Strain from squared lengths loses the square of the thinness to rounding.
        check_same({local.value, local.gradient, local.full_hessian()},
                   {exact.value, exact.gradient, exact.hessian}, 1e-14 / (thinness * thinness));
        check_orders(energy_of(term, 3, 0), s.x);
    }
}

TEST_CASE("fabric membrane: a collapsed triangle meets the barrier at every order, without a crash") {
    const Sample s = sample(1.0, 1.0, 6);
    const FabricMembrane term = membrane(s, Material{});
    Eigen::VectorXd x = Eigen::VectorXd::Zero(9);
    x[3] = 1.0;
    x[6] = 0.3;
    x[7] = 1e-6;
    const double barrier = term.evaluate(0, {x.data(), 3}, Order::value).value;
    x[7] = 0.0;
    for (const double x2 : {0.0, 0.3, 0.5, 1.0 / 3.0, 0.9}) {  // on the line of the other two
        x[6] = x2;
        for (const Order order : {Order::value, Order::gradient, Order::hessian, Order::gauss_newton}) {
            CHECK_FALSE(term.evaluate(0, {x.data(), 3}, order).value < barrier);
        }
    }
    const Eigen::VectorXd point = Eigen::VectorXd::Constant(9, 2.0);
    CHECK_FALSE(std::isfinite(term.evaluate(0, {point.data(), 3}, Order::hessian).value));
    const Eigen::VectorXd nan = Eigen::VectorXd::Constant(9, std::nan(""));
    CHECK_FALSE(std::isfinite(term.evaluate(0, {nan.data(), 3}, Order::hessian).value));
}

TEST_CASE(
    "fabric membrane: the Gauss-Newton form does not hold a stretched sheet in its plane, the Hessian does") {
    const Star star = random_star(4);
    const Sample s{{star.layout[0], star.layout[1], star.layout[2]}, {}};
    const FabricMembrane term = membrane(s, Material{});
    // Without rotation: z is out of the plane.
    Eigen::VectorXd x = Eigen::VectorXd::Zero(9);
    for (int v = 0; v < 3; ++v) x.segment<2>(3 * v) = 1.4 * s.relaxed[v];
    for (int v = 0; v < 3; ++v) {
        CHECK(term.evaluate(0, {x.data(), 3}, Order::hessian).hessian(3 * v + 2, 3 * v + 2) > 1e-3);
        CHECK(term.evaluate(0, {x.data(), 3}, Order::gauss_newton).hessian(3 * v + 2, 3 * v + 2) == 0.0);
    }
}

#include "ruche/energy/fabric_ply.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "energy/battery.hpp"
#include "energy/oracle.hpp"
#include "energy/samples.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr double poissons_ratio = 0.4;

const std::array<std::array<EdgeKind, 3>, 4> ply_edge_kinds = {{
    {EdgeKind::free, EdgeKind::free, EdgeKind::free},
    {EdgeKind::averaged, EdgeKind::clamped_rim, EdgeKind::averaged},
    {EdgeKind::free, EdgeKind::open_rim, EdgeKind::free},
    {EdgeKind::open_rim, EdgeKind::open_rim, EdgeKind::open_rim},
}};

/// Fabric in which law and linear ply agree for small strains: isotropic, no logarithms, no blend.
Material hookean(double modulus) {
    Material m;
    m.fabric_youngs_modulus = modulus;
    m.alpha_1 = m.alpha_2 = modulus;
    m.alpha_3 = modulus / (2.0 * (1.0 + m.fabric_poissons_ratio));
    m.beta_1 = m.beta_2 = m.neo_hookean_share = 0.0;
    return m;
}

PrintedLaminate turned_over(PrintedLaminate print) {
    std::swap(print.front, print.back);
    std::swap(print.front_modulus, print.back_modulus);
    return print;
}

/// (L - L_layout, c) of the forms a = diag(a1, a2), b = diag(b1, b2) of a right triangle with legs of 1 mm.
FormVector deviation(const Vec2& a, const Vec2& b) {
    FormVector d;
    d << a[0] + a[1] - 2.0, a[1] - 1.0, a[0] - 1.0, 0.0, 0.5 * b[0], 0.5 * b[1];
    return d;
}

const std::array<Vec2, 3> right_triangle = {Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(0.0, 1.0)};
std::array<Vec2, 3> shrunk(double s1, double s2) {
    return {Vec2(0.0, 0.0), Vec2(1.0 / s1, 0.0), Vec2(0.0, 1.0 / s2)};
}

/// Psi~ integrated over [z0, z1] by Simpson's rule with many intervals, over the triangle.
double fine_quadrature(const FabricPly::Layer& layer, const FabricLaw& law, const Vec2& s, const Vec2& a,
                       const Vec2& b) {
    constexpr int intervals = 2000;
    const double step = (layer.z1 - layer.z0) / intervals;
    double sum = 0.0;
    for (int k = 0; k <= intervals; ++k) {
        const double z = layer.z0 + k * step;
        const double weight = k == 0 || k == intervals ? 1.0 : 2.0 + 2.0 * (k % 2);
        const Vec3 strain(0.5 * (s[0] * s[0] * (a[0] - 2.0 * z * b[0]) - 1.0),
                          0.5 * (s[1] * s[1] * (a[1] - 2.0 * z * b[1]) - 1.0), 0.0);
        sum += weight * law(strain).energy;
    }
    return sum * step / 3.0 * 0.5 / (s[0] * s[1]);
}

}  // namespace

TEST_CASE("fabric ply: laminates with the fabric's own law pass the battery with every kind of edge") {
    for (int k = 0; k < int(ply_edge_kinds.size()); ++k) {
        CAPTURE(k);
        const Star star = random_star(k);
        const PrintedLaminate print = sample_print(k != 1, k != 2);
        const LaminateTerm term(poissons_ratio,
                                {with_fabric_law(laminate_element(star, ply_edge_kinds[k], print))});
        const Energy energy = energy_of(term, 6, 3);
        check_battery(energy, star.x);
        const LaminateTerm flipped(
            poissons_ratio, {with_fabric_law(laminate_element(star, ply_edge_kinds[k], turned_over(print)))});
        check_invariance(energy, energy_of(flipped, 6, 3), mirror_z(), star.x);
        check_assembly(term, 6, 3, star.x);
    }
}

TEST_CASE("fabric ply: value, gradient and Hessian agree with automatic differentiation") {
    for (unsigned seed = 0; seed < 12; ++seed) {
        CAPTURE(seed);
        const Star star = random_star(seed, 0.25);
        const auto element = with_fabric_law(
            laminate_element(star, ply_edge_kinds[seed % 4], sample_print(seed % 3 != 1, seed % 3 != 0)));
        const LaminateTerm term(poissons_ratio, {element});
        const Local<21> local = term.evaluate(0, {star.x.data(), 6}, Order::hessian);
        const auto unknowns = jets<21>(star.x);
        const Jet<21> exact = LaminateElement{element, poissons_ratio}.energy<Jet<21>>(unknowns);
        check_same({local.value, local.gradient, local.full_hessian()},
                   {exact.value, exact.gradient, exact.hessian}, 1e-11);
    }
}

TEST_CASE("fabric ply: an open rim at its least is a free rim while the plies are linear") {
    const Star star = random_star(9);
    const PrintedLaminate print = sample_print(true, false);
    const LaminateTerm rim(
        poissons_ratio,
        {laminate_element(star, {EdgeKind::free_rim, EdgeKind::free, EdgeKind::averaged}, print)});
    const LaminateTerm open(
        poissons_ratio,
        {laminate_element(star, {EdgeKind::open_rim, EdgeKind::free, EdgeKind::averaged}, print)});
    Eigen::VectorXd x = star.x;
    // Quadratic in c: one Newton step is the minimum.
    const Local<21> before = open.evaluate(0, {x.data(), 6}, Order::hessian);
    x[18] -= before.gradient[18] / before.hessian(18, 18);
    const Local<21> least = open.evaluate(0, {x.data(), 6}, Order::gradient);
    const Local<21> eliminated = rim.evaluate(0, {x.data(), 6}, Order::gradient);
    CHECK(least.value == doctest::Approx(eliminated.value).epsilon(1e-12));
    CHECK(std::abs(least.gradient[18]) <= 1e-12 * std::abs(before.gradient[18]));
    CHECK((least.gradient.head<18>() - eliminated.gradient.head<18>()).norm() <=
          1e-11 * eliminated.gradient.norm());
}

TEST_CASE("fabric ply: three points hold the energy of a released strip to 1e-6, two do not") {
    // Table 1's fabric under strips with curvatures of 0.15 and 0.45 /mm.
    const FabricLaw law((Material()));
    const Vec2 s(1.7, 1.7);
    const Vec2 a(0.9, 0.9);
    const FabricPly::Layer layer{-0.46, 0.0, right_triangle, shrunk(s[0], s[1])};
    const auto errors = [&](const Vec2& b) -> Vec2 {
        const double exact = fine_quadrature(layer, law, s, a, b);
        const double three = FabricPly(layer).evaluate(law, deviation(a, b), Order::value).energy;
        double two = 0.0;
        for (const double at : {-1.0, 1.0}) {
            const double z = -0.23 + 0.23 * at / std::sqrt(3.0);
            const FabricPly::Layer thin{z - 1e-7, z + 1e-7, right_triangle, layer.relaxed};
            two += 0.5 * 0.46 / 2e-7 * FabricPly(thin).evaluate(law, deviation(a, b), Order::value).energy;
        }
        return {std::abs(two / exact - 1.0), std::abs(three / exact - 1.0)};
    };
    const Vec2 moderate = errors(Vec2(-0.15, -0.05));
    CHECK(moderate[0] > 1e-5);
    CHECK(moderate[1] < 1e-6);
    const Vec2 strong = errors(Vec2(-0.45, 0.0));
    CHECK(strong[0] > 1e-4);
    CHECK(strong[1] < 5e-5);
}

TEST_CASE("fabric ply: of isotropic fabric without logarithms it is the linear ply, at every strain") {
    // Eq. 8 has Green's strain of each height too: a_bar^-1 (a - 2 z b) - I = 2 E.
    const double modulus = 1.05;
    const Material m = hookean(modulus);
    const FabricLaw law(m);
    const auto difference = [&](double strain) {
        const double s = 1.0 + strain;
        const Vec2 a(1.0 - 0.4 * strain, 1.0 + 0.3 * strain);
        const Vec2 b(-0.7 * strain, 0.2 * strain);
        const FabricPly ply({-0.46, 0.0, right_triangle, shrunk(s, s)});
        const Ply linear{-0.46, 0.0, modulus, Mat2(Mat2::Identity() / (s * s))};
        const double reference = 0.5 * laminate_energy_density(Mat2(a.asDiagonal()), Mat2(b.asDiagonal()),
                                                               {&linear, 1}, m.fabric_poissons_ratio);
        return std::abs(ply.evaluate(law, deviation(a, b), Order::value).energy / reference - 1.0);
    };
    for (const double strain : {0.7, 0.1, 1e-3}) CHECK(difference(strain) <= 1e-12);
}

TEST_CASE("fabric ply: the log terms leave the linear ply in stress with the second order of strain") {
    // Tangent at rest: C_11 + beta_1 / gamma_1. A relative error of first order in energy is one of second
    // order in stress.
    Material m = hookean(1.0);
    m.beta_1 = m.beta_2 = 0.1;
    const double nu_f = m.fabric_poissons_ratio;
    const double coupling = nu_f / (1.0 - nu_f * nu_f);
    m.gamma_1 = m.gamma_2 = 0.9;
    const FabricLaw law(m);
    const auto relative_difference = [&](double strain) {
        const Vec2 a(1.0 + strain, 1.0);
        const Vec2 b(0.3 * strain, 0.0);
        const FabricPly ply({-0.46, 0.0, right_triangle, right_triangle});
        // Only E11 = (a - 1)/2 - z b is not zero.
        const auto squared = [&](double z) { return std::pow(0.5 * strain - z * b[0], 2); };
        const double mean = (squared(-0.46) + 4.0 * squared(-0.23) + squared(0.0)) / 6.0;
        const double tangent = coupling / nu_f + m.beta_1 / m.gamma_1;
        const double linear = 0.5 * 0.46 * 0.5 * tangent * mean;
        return std::abs(ply.evaluate(law, deviation(a, b), Order::value).energy / linear - 1.0);
    };
    const double order = std::log2(relative_difference(0.02) / relative_difference(0.01));
    CHECK(order == doctest::Approx(1.0).epsilon(0.05));
}

TEST_CASE("fabric ply: no stress without pre-stretch when flat, beyond the law it stays finite") {
    const FabricLaw law((Material()));
    const FabricPly rest({-0.46, 0.0, right_triangle, right_triangle});
    const FabricPly::Response flat = rest.evaluate(law, FormVector::Zero(), Order::hessian);
    CHECK(std::abs(flat.energy) < 1e-16);
    CHECK(flat.stress.norm() < 1e-15);
    const FabricPly beyond({-0.46, 0.0, right_triangle, shrunk(1.9, 1.9)});
    CHECK(beyond.green_strain(1, FormVector::Zero())[0] > law.gamma(0));
    CHECK(std::isfinite(beyond.evaluate(law, FormVector::Zero(), Order::value).energy));
    // Fabric that is bent into itself has no energy that could be asked for.
    CHECK_FALSE(
        std::isfinite(rest.evaluate(law, deviation(Vec2(1.0, 1.0), Vec2(-3.0, 0.0)), Order::value).energy));
}

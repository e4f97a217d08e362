#include "ruche/material/laminate.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "energy/oracle.hpp"
#include "reference_data.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

Mat2 matrix(double m11, double m12, double m22) { return (Mat2() << m11, m12, m12, m22).finished(); }

/// A front print of Table 1 at equal pre-stretch in an orthonormal layout basis.
std::vector<Ply> front_print(double plastic, double stretch, double fabric = 0.46) {
    return printed_plies({.front = plastic, .fabric = fabric, .front_modulus = 72.3, .fabric_modulus = 1.05},
                         Mat2::Identity(), Mat2::Identity() / (stretch * stretch));
}

/// Forms of least energy with some components held at zero, as (a, b) with a from the reference metric I.
FormVector least(const LaminateForm& form, const std::array<bool, 6>& held) {
    FormMatrix q = form.quadratic;
    FormVector l = form.linear;
    for (int i = 0; i < 6; ++i) {
        if (!held[i]) continue;
        q.row(i).setZero();
        q.col(i).setZero();
        q(i, i) = 1.0;
        l[i] = 0.0;
    }
    FormVector d = -q.fullPivLu().solve(l);
    d[0] += 1.0;
    d[2] += 1.0;
    return d;
}
constexpr std::array<bool, 6> nothing = {};

/// Timoshenko's bimetal, theory page.
double timoshenko(double tp, double tf, double stretch) {
    const double p = 72.3;
    const double q = 1.05 * stretch * stretch;
    const double e = (stretch * stretch - 1.0) / (2.0 * stretch * stretch);
    return 6.0 * p * q * tp * tf * (tp + tf) * e /
           (q * q * std::pow(tf, 4) + p * p * std::pow(tp, 4) +
            2.0 * p * q * tf * tp * (2.0 * tf * tf + 3.0 * tf * tp + 2.0 * tp * tp));
}

struct Forms {
    Mat2 a, b, basis;
};
Forms random_forms(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-0.3, 0.3);
    return {matrix(0.9 + u(random), u(random), 1.0 + u(random)), matrix(u(random), u(random), u(random)),
            (Mat2() << 1.0 + u(random), u(random), u(random), 1.0 + u(random)).finished()};
}

double density(const Forms& forms, const std::vector<Ply>& plies) {
    return laminate_energy_density(forms.a, forms.b, plies, 0.4);
}

bool near(double found, double expected) { return std::abs(found - expected) <= 1e-12 * std::abs(expected); }

}  // namespace

TEST_CASE("laminate: energy densities are those of the reference, fabric and plastic apart") {
    const auto rows = read_csv("unit_bilayer_density.csv");
    REQUIRE(rows.size() == 12);
    for (const std::vector<double>& row : rows) {
        const Mat2 a = matrix(row[0], row[2], row[1]);
        const Mat2 b = 1e-3 * matrix(row[3], row[5], row[4]);
        // The file's h are those of eq. 8: layers of half that thickness.
        const auto plies = front_print(0.5e3 * row[7], row[8], 0.5e3 * row[6]);
        REQUIRE(plies.size() == 2);
        constexpr double joule_per_m2 = 1e-3;  // in mJ/mm^2
        for (int k = 0; k < 2; ++k) {
            const double one = laminate_energy_density(a, b, std::span(plies).subspan(k, 1), 0.4);
            CHECK(std::abs(one / joule_per_m2 - row[9 + k]) <= 1e-10 * row[11]);  // 12 digits printed
        }
        CHECK(laminate_energy_density(a, b, plies, 0.4) / joule_per_m2 ==
              doctest::Approx(row[11]).epsilon(1e-10));
    }
}

TEST_CASE("laminate: the free minimum is Timoshenko's bimetal, concave on the fabric's side") {
    struct Case {
        double plastic, curvature, contraction;
    };
    for (const Case& c : {Case{0.6, 0.152362385, 0.94958916}, Case{1.0, 0.051255722, 0.96991169}}) {
        const LaminateForm form = laminate_form(front_print(c.plastic, 1.7), 0.4, Mat2::Identity());
        const FormVector d = least(form, nothing);
        const double expected = timoshenko(c.plastic, 0.46, 1.7);
        CHECK(d[3] == doctest::Approx(-expected).epsilon(1e-12));
        CHECK(d[5] == doctest::Approx(-expected).epsilon(1e-12));
        CHECK(std::abs(d[1]) + std::abs(d[4]) <= 1e-14);
        CHECK(d[0] == doctest::Approx(d[2]).epsilon(1e-13));
        // Nine and eight digits are given.
        CHECK(std::abs(-d[3] / d[0] - c.curvature) <= 1e-9);
        CHECK(std::abs(std::sqrt(d[0]) - c.contraction) <= 1e-8);
        const double residual =
            (form.quadratic * (d - (FormVector() << 1, 0, 1, 0, 0, 0).finished()) + form.linear)
                .cwiseAbs()
                .maxCoeff();
        CHECK(residual <= 1e-13 * form.linear.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("laminate: Timoshenko's bimetal has no Poisson's ratio in it") {
    for (const double nu : {0.0, 0.2, 0.49}) {
        const FormVector d = least(laminate_form(front_print(0.6, 1.7), nu, Mat2::Identity()), nothing);
        CHECK(d[3] == doctest::Approx(-timoshenko(0.6, 0.46, 1.7)).epsilon(1e-12));
    }
}

TEST_CASE("laminate: a wide strip rolls to 1 + nu times the narrow one's form") {
    struct Case {
        double plastic, curvature;
    };
    for (const Case& c : {Case{0.6, 0.220942}, Case{1.0, 0.073218}}) {
        const LaminateForm form = laminate_form(front_print(c.plastic, 1.7), 0.4, Mat2::Identity());
        const FormVector d = least(form, {false, false, false, false, true, true});  // b12 = b22 = 0
        CHECK(d[3] == doctest::Approx(-1.4 * timoshenko(c.plastic, 0.46, 1.7)).epsilon(1e-9));
        CHECK(std::abs(-d[3] / d[0] - c.curvature) <= 1e-6);  // six digits are given
        CHECK(std::abs(d[0] - d[2]) > 1e-3);
    }
}

TEST_CASE("laminate: the form agrees with the plain formula whatever metric it deviates from") {
    CHECK(rc::check("forms", [](unsigned seed) {
        const Forms f = random_forms(seed);
        const Mat2 metric = f.basis.transpose() * f.basis;
        const auto plies = printed_plies({0.6, 0.3, 0.46, 72.3, 20.0, 1.05}, metric, metric / 2.89);
        // The oracle's energy is that of a triangle, half of the parametric square.
        const double expected = 2.0 * laminate_energy<double>({f.a(0, 0), f.a(0, 1), f.a(1, 1)},
                                                              {f.b(0, 0), f.b(0, 1), f.b(1, 1)}, plies, 0.4);
        RC_ASSERT(near(density(f, plies), expected));
        const LaminateForm form = laminate_form(plies, 0.4, metric);
        FormVector d;
        d << f.a(0, 0) - metric(0, 0), f.a(0, 1) - metric(0, 1), f.a(1, 1) - metric(1, 1), f.b(0, 0),
            f.b(0, 1), f.b(1, 1);
        RC_ASSERT(near(form.constant + d.dot(form.linear + 0.5 * form.quadratic * d), expected));
        RC_ASSERT((form.quadratic - form.quadratic.transpose()).norm() <= 1e-14 * form.quadratic.norm());
    }));
}

TEST_CASE("laminate: two plies of one material are one ply of the summed thickness") {
    CHECK(rc::check("cut at any height", [](unsigned seed) {
        const Forms f = random_forms(seed);
        const Mat2 metric = f.basis.transpose() * f.basis;
        const double cut = -0.3 + 0.9 * (seed % 1000) / 1000.0;
        RC_ASSERT(near(density(f, {{-0.3, cut, 5.0, metric}, {cut, 0.6, 5.0, metric}}),
                       density(f, {{-0.3, 0.6, 5.0, metric}})));
    }));
}

TEST_CASE("laminate: a front print is a back print in the mirror") {
    CHECK(rc::check("swap sides, mirror b", [](unsigned seed) {
        const Forms f = random_forms(seed);
        const Mat2 metric = f.basis.transpose() * f.basis;
        for (const auto& [front, back] : {std::pair{0.6, 0.0}, {0.6, 0.4}}) {
            const PrintedLaminate print{front, back, 0.46, 72.3, 20.0, 1.05};
            const PrintedLaminate mirrored{back, front, 0.46, 20.0, 72.3, 1.05};
            RC_ASSERT(near(density({f.a, f.b, f.basis}, printed_plies(print, metric, metric / 2.0)),
                           density({f.a, -f.b, f.basis}, printed_plies(mirrored, metric, metric / 2.0))));
        }
    }));
}

TEST_CASE("laminate: energy per parametric area does not depend on the basis but for its area") {
    CHECK(rc::check("change of basis", [](unsigned seed) {
        const Forms f = random_forms(seed);
        const auto in_basis = [&](const Mat2& form) -> Mat2 { return f.basis.transpose() * form * f.basis; };
        const Mat2 relaxed = Vec2(1.0 / 2.89, 1.0 / 1.69).asDiagonal();
        const PrintedLaminate print{0.6, 0.0, 0.46, 72.3, 0.0, 1.05};
        const double plain = density(f, printed_plies(print, Mat2::Identity(), relaxed));
        const double other = density({in_basis(f.a), in_basis(f.b), f.basis},
                                     printed_plies(print, in_basis(Mat2::Identity()), in_basis(relaxed)));
        RC_ASSERT(near(other, std::abs(f.basis.determinant()) * plain));
    }));
}

TEST_CASE("printed plies: z = 0 is the interface of one print and mid-fabric between two") {
    const Mat2 layout = Mat2::Identity();
    const Mat2 fabric = layout / 2.89;
    const auto front = printed_plies({.front = 0.6, .fabric = 0.4}, layout, fabric);
    REQUIRE(front.size() == 2);
    CHECK(front[0].z0 == -0.4);
    CHECK(front[0].z1 == 0.0);
    CHECK(front[0].rest_metric == fabric);
    CHECK(front[1].z0 == 0.0);
    CHECK(front[1].z1 == 0.6);
    CHECK(front[1].rest_metric == layout);
    const auto back = printed_plies({.back = 0.6, .fabric = 0.4}, layout, fabric);
    REQUIRE(back.size() == 2);
    CHECK(back[0].z0 == 0.0);
    CHECK(back[0].z1 == 0.4);
    CHECK(back[1].z0 == -0.6);
    CHECK(back[1].z1 == 0.0);
    const auto both = printed_plies({.front = 0.6, .back = 0.3, .fabric = 0.4}, layout, fabric);
    REQUIRE(both.size() == 3);
    CHECK(both[0].z0 == -0.2);
    CHECK(both[0].z1 == doctest::Approx(0.2));
    CHECK(both[1].z1 == doctest::Approx(0.8));
    CHECK(both[2].z0 == doctest::Approx(-0.5));
}

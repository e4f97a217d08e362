#include "ruche/material/fabric_law.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "energy/jet.hpp"
#include "energy/oracle.hpp"
#include "reference_data.hpp"

using namespace ruche;
using namespace ruche::test;

namespace {

constexpr double pascal = 1e-6;  // in MPa

FabricLaw law_with_share(double share) {
    Material m;
    m.neo_hookean_share = share;
    return FabricLaw(m);
}

/// 14 digits are printed; near zero what was rounded is the stress of the largest terms, about 1e5 Pa.
bool agrees(double found_mpa, double expected_pa) {
    return std::abs(found_mpa / pascal - expected_pa) <= 1e-12 * std::abs(expected_pa) + 1e-9;
}

}  // namespace

TEST_CASE("fabric law: energies and stresses are those of the reference, with and without the blend") {
    const FabricLaw own = law_with_share(0.0);
    const FabricLaw neo_hookean = law_with_share(1.0);
    const FabricLaw blend = law_with_share(0.01);
    const auto rows = read_csv("unit_membrane_values.csv");
    REQUIRE(rows.size() == 11);
    for (const std::vector<double>& row : rows) {
        const Vec3 strain(row[0], row[1], row[2]);
        CAPTURE(strain.transpose());
        CHECK(agrees(0.5 * strain.dot(own.elasticity() * strain), row[3]));
        CHECK(agrees(own(strain).energy, row[5]));
        CHECK(agrees(neo_hookean(strain).energy, row[6]));
        CHECK(agrees(blend(strain).energy, row[7]));
        for (int i = 0; i < 3; ++i) {
            CHECK(agrees(own(strain).stress[i], row[8 + i]));
            CHECK(agrees(blend(strain).stress[i], row[11 + i]));
        }
    }
}

TEST_CASE("fabric law: on the frame at 1.7 the stresses are those of the theory page") {
    const Vec3 hold(0.945, 0.945, 0.0);
    CHECK(law_with_share(0.0)(hold).stress[0] == doctest::Approx(0.1584450).epsilon(1e-7));
    CHECK(law_with_share(0.0)(hold).stress[1] == doctest::Approx(0.1898485).epsilon(1e-6));
    CHECK(law_with_share(0.01)(hold).stress[0] == doctest::Approx(0.1607728).epsilon(1e-7));
    CHECK(law_with_share(0.01)(hold).stress[1] == doctest::Approx(0.1918622).epsilon(1e-7));
}

TEST_CASE("fabric law: stress and tangent are the energy's derivatives inside and beyond the log terms") {
    const FabricLaw::Options options{.log_extension = 1e-2, .tensor_shear = true};
    const Material material;
    const FabricLaw law(material, options);
    for (const Vec3& e : {Vec3(0.0, 0.0, 0.0), Vec3(0.4, -0.2, 0.3), Vec3(0.95, 0.9, 0.2),
                          Vec3(0.9, 1.5, -0.4), Vec3(2.0, 3.0, 1.0), Vec3(-0.4, -0.3, 0.1)}) {
        CAPTURE(e.transpose());
        using J = Jet<3>;
        const Form<J> c{2.0 * J::unknown(0, e[0]) + 1.0, J::unknown(2, e[2]),
                        2.0 * J::unknown(1, e[1]) + 1.0};
        const J exact = fabric_density(c, material, options);
        const FabricResponse response = law(e);
        CHECK(std::abs(response.energy - exact.value) <= 1e-13 * std::abs(exact.value) + 1e-17);
        CHECK((response.stress - exact.gradient).norm() <= 1e-13 * exact.gradient.norm() + 1e-16);
        CHECK((response.tangent - exact.hessian).norm() <= 1e-13 * exact.hessian.norm());
    }
}

TEST_CASE("fabric law: energy, stress and tangent are continuous where the linear extension begins") {
    for (const double extension : {1e-3, 1e-6}) {
        const FabricLaw law(Material{}, {.log_extension = extension});
        for (int axis = 0; axis < 2; ++axis) {
            const auto at = [&](double beyond) -> FabricResponse {
                Vec3 strain(0.3, 0.3, 0.05);
                strain[axis] = law.strain_limit(axis) + beyond;
                return law(strain);
            };
            CHECK(law.strain_limit(axis) == doctest::Approx(law.gamma(axis) - extension));
            const double near = 1e-5 * extension;
            // A change of strain by h changes a function f by f' h: energy by the stress, stress by the
            // tangent, the log's tangent 1/delta by a part h/delta of itself.
            CHECK(at(near).energy == doctest::Approx(at(-near).energy).epsilon(1e-4));
            CHECK(at(near).stress[axis] == doctest::Approx(at(-near).stress[axis]).epsilon(1e-4));
            CHECK(at(near).tangent(axis, axis) ==
                  doctest::Approx(at(-near).tangent(axis, axis)).epsilon(1e-4));
            // Beyond, the log term's tangent stays; without the blend nothing else bends.
            Material straight;
            straight.neo_hookean_share = 0.0;
            const FabricLaw linear(straight, {.log_extension = extension});
            Vec3 strain(0.3, 0.3, 0.05);
            strain[axis] = linear.strain_limit(axis) + 0.1;
            const Mat3 first = linear(strain).tangent;
            strain[axis] += 5.0;
            CHECK(linear(strain).tangent == first);
        }
    }
}

TEST_CASE("fabric law: at rest without energy or stress, and infinite where the area is gone") {
    const FabricResponse rest = law_with_share(0.01)(Vec3::Zero());
    CHECK(rest.energy == 0.0);
    CHECK(rest.stress.norm() <= 1e-18);
    for (const Vec3& e : {Vec3(-0.5, 0.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(-0.6, 0.3, 0.0),
                          Vec3(0.1, 0.1, 5.0), Vec3(-0.6, -0.6, 0.0)}) {
        CHECK(law_with_share(0.01)(e).energy == infinity);
        CHECK(std::isfinite(law_with_share(0.0)(e).energy));
    }
}

TEST_CASE("fabric law: tensor shear halves what alpha_3 does, and nothing else") {
    Material m;
    m.neo_hookean_share = 0.0;
    const FabricLaw tensor(m, {.tensor_shear = true});
    m.alpha_3 *= 0.5;
    const FabricLaw half(m);
    const Vec3 strain(0.3, -0.1, 0.4);
    CHECK(tensor(strain).energy == doctest::Approx(half(strain).energy).epsilon(1e-15));
    CHECK(tensor(strain).stress.isApprox(half(strain).stress, 1e-15));
    CHECK(tensor.elasticity()(2, 2) == doctest::Approx(0.5 * 0.063419).epsilon(1e-15));
}

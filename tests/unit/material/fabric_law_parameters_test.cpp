#include "ruche/material/fabric_law_parameters.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace ruche;

TEST_CASE(
    "stress by parameter: agrees with differences of the law, which shrink with the square of the step") {
    const Vec3 strains[] = {Vec3(0.3, -0.1, 0.15), Vec3(0.945, -0.12, 0.02), Vec3(0.2, 0.9635, -0.1),
                            Vec3(-0.2, 0.05, 0.3)};
    for (const bool tensor_shear : {false, true}) {
        const FabricLaw::Options options{.tensor_shear = tensor_shear};
        for (const Vec3& strain : strains) {
            const StressByParameter exact = stress_by_parameter(Material{}, options, strain);
            for (std::size_t i = 0; i < law_parameter_count; ++i) {
                CAPTURE(i);
                const auto difference = [&](double step) -> Vec3 {
                    Material up;
                    Material down;
                    up.*law_parameters[i] += step;
                    down.*law_parameters[i] -= step;
                    return (FabricLaw(up, options)(strain).stress - FabricLaw(down, options)(strain).stress) /
                           (2.0 * step);
                };
                const double size = 1e-2 * Material{}.*law_parameters[i];
                // gamma moves the start of the linear extension too: small steps keep the side.
                const double step = i == 5 || i == 6 ? 1e-5 : size;
                const Vec3 coarse = difference(step);
                const Vec3 fine = difference(0.5 * step);
                const Vec3 extrapolated = (4.0 * fine - coarse) / 3.0;
                const int column = static_cast<int>(i);
                const double scale = exact.col(column).norm() + 1e-3;
                CHECK((extrapolated - exact.col(column)).norm() < 1e-7 * scale);
                const double error = (fine - exact.col(column)).norm();
                if (error > 1e-9 * scale)
                    CHECK((coarse - exact.col(column)).norm() / error == doctest::Approx(4.0).epsilon(0.05));
            }
        }
    }
}

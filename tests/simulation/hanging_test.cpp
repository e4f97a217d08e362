// Sheets that hang: what resists is the weight's geometric stiffness, not the sheet's own.
#include <doctest/doctest.h>

#include <string>

#include "ruche/core/error.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;

namespace {

Scene hanging(const std::string& supports, const std::string& thickness) {
    return parse_scene(R"(
[pattern]
generator = "staggered"
[pattern.options]
rows = 7
strips_per_row = 2
[fabric]
margin_mm = 1
[gravity]
acceleration_mm_per_s2 = [0, 0, -9810]
[plastic]
thickness_mm = )" + thickness +
                           supports,
                       "hanging.toml");
}

/// Where the weight pulls: the mean of positions weighted with the forces of gravity.
Vec3 centre_of_mass(const Result& result, const Scene& scene) {
    ModelInput heavy = scene_model(scene, result.layout);
    ModelInput weightless = heavy;
    weightless.gravity = {0, 0, 0};
    const Eigen::VectorXd& x = result.equilibrium.x;
    const Eigen::VectorXd weight = Model(heavy).gradient(x) - Model(weightless).gradient(x);
    Vec3 sum = Vec3::Zero();
    double total = 0.0;
    for (int v = 0; v < static_cast<int>(result.shape.size()); ++v) {
        sum += weight[3 * v + 2] * result.shape[v];
        total += weight[3 * v + 2];
    }
    return sum / total;
}

}  // namespace

TEST_CASE("hanging: from a pin, a corner, a clamped edge or two pins the sheet comes to rest") {
    for (const std::string supports :
         {"\n[[support]]\npoint_mm = [0, 8]\n", "\n[[support]]\npoint_mm = [-14, 8.5]\n",
          "\n[[support]]\nmin_mm = [-15, -10]\nmax_mm = [-13.9, 10]\n",
          "\n[[support]]\nmin_mm = [-15, 8.99]\nmax_mm = [15, 10]\n",
          "\n[[support]]\npoint_mm = [-14, 8.5]\n[[support]]\npoint_mm = [-14, -8.5]\nmove_mm = [0, 1, "
          "0]\n"}) {
        for (const std::string thickness : {"0.6", "1.0"}) {
            CAPTURE(supports);
            CAPTURE(thickness);
            const Result result = simulate(hanging(supports, thickness));
            CHECK(result.equilibrium.status == SolveStatus::converged);
            CHECK(result.equilibrium.stable);
            CHECK(result.equilibrium.iterations < 100);
        }
    }
}

TEST_CASE("hanging: from one pin the centre of mass ends below it") {
    const Scene scene = hanging("\n[[support]]\npoint_mm = [-14, 8.5]\n", "1.0");
    const Result result = simulate(scene);
    REQUIRE(result.equilibrium.status == SolveStatus::converged);
    const Vec3 pin = scene_model(scene, result.layout).supports.front().at;
    const Vec3 from_pin = centre_of_mass(result, scene) - pin;
    CHECK(from_pin.z() < -3.0);
    CHECK(from_pin.head<2>().norm() < 1e-3);
}

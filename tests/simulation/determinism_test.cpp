#include <doctest/doctest.h>

#include <cstring>

#include "ruche/core/parallel.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"

using namespace ruche;

namespace {

/// Five rows of a cylinder, some 2000 triangles: enough for every parallel loop to be shared out.
Result roll(int threads, bool deterministic = true) {
    Scene scene = parse_scene(
        "[pattern]\ngenerator = \"staggered\"\n[pattern.options]\nrows = 5\n[fabric]\nmargin_mm = 1\n",
        "k.toml");
    scene.solver.deterministic = deterministic;
    scene.solver.threads = threads;
    return simulate(scene);
}

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

}  // namespace

TEST_CASE("solve: same bits at 1, 2 and 3 threads") {
    const int before = thread_count();
    const Result one = roll(1);
    CHECK(thread_count() == 1);
    REQUIRE(one.equilibrium.status == SolveStatus::converged);
    REQUIRE(one.layout.mesh.triangle_count() > 1000);
    for (const int threads : {2, 3, 2}) {
        CAPTURE(threads);
        const Result other = roll(threads);
        CHECK(thread_count() == threads);
        CHECK(other.equilibrium.iterations == one.equilibrium.iterations);
        CHECK(other.equilibrium.factorizations == one.equilibrium.factorizations);
        CHECK(same_bits(other.equilibrium.x, one.equilibrium.x));
        CHECK(other.equilibrium.energy.total() == one.equilibrium.energy.total());
        CHECK(other.equilibrium.residual == one.equilibrium.residual);
    }
    set_thread_count(before);
}

TEST_CASE("solve: the same bits whatever solver.deterministic says") {
    const int before = thread_count();
    CHECK(same_bits(roll(2, false).equilibrium.x, roll(1).equilibrium.x));
    set_thread_count(before);
}

// How little the finest mesh can do with: its solve alone, from two starts that no coarser mesh can give,
// beside the whole release. The one is the shape on the very same mesh with half a per cent more pre-stretch:
// nothing is carried over at all. The other is carried over from the converged shape of another mesh with
// nearly as many triangles. The former costs what every scheme costs that goes on with Newton's method on the
// finest mesh, the difference to the latter is the price of carrying over, the rest of the release is coarser
// meshes and what is done once.
//
//     finest_mesh_limit [TRIANGLES] [SCENE...]      (default 20000, all scenes of `ruche bench` but the
//     drawing)
//
// One thread. Costs are processor time over that of one factorisation of the final Hessian.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ruche/core/parallel.hpp"
#include "ruche/core/process_usage.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/release.hpp"
#include "ruche/statics/rigid_motions.hpp"
#include "ruche/statics/sparse_cholesky.hpp"
#include "ruche/study/benchmark_scene.hpp"

namespace ruche::bench {
namespace {

template <class Work>
double processor_seconds_of(Work&& work) {
    const double begin = processor_seconds();
    work();
    return processor_seconds() - begin;
}

/// Median of five; nan when the Hessian is not positive definite, which is no measure.
double factorization_seconds(const Model& model, const Eigen::VectorXd& x) {
    AssembledSums sums;
    model.evaluate(x, Order::hessian, sums);
    RigidMotions(model).hold(model.pattern(), x, RigidMotions::Resisting::supports_and_loads, sums.hessian);
    SparseCholesky cholesky(model, vertex_elimination_order(model.pattern()));
    std::vector<double> seconds(5);
    bool definite = true;
    for (double& s : seconds) s = processor_seconds_of([&] { definite &= cholesky.factorize(sums.hessian); });
    std::nth_element(seconds.begin(), seconds.begin() + 2, seconds.end());
    return definite ? seconds[2] : std::numeric_limits<double>::quiet_NaN();
}

struct MeshedScene {
    BenchmarkScene made;
    PrintMesh layout;

    MeshedScene(const std::string& name, int triangles) : made(name) {
        made.resize(triangles);
        layout = scene_mesh(made.scene());
    }
    const Scene& scene() const { return made.scene(); }
};

Model model_of(const Scene& scene, const PrintMesh& layout) { return Model(scene_model(scene, layout)); }

struct Effort {
    Equilibrium end;
    double seconds = 0.0;
};

template <class Solve>
Effort effort_of(Solve&& solve) {
    Effort effort;
    effort.seconds = processor_seconds_of([&] { effort.end = solve(); });
    return effort;
}

std::string cells(const Effort& effort, double unit) {
    const Equilibrium& end = effort.end;
    if (end.status != SolveStatus::converged || !end.stable) return "- | -";
    return fmt::format("{} / {} | {:.1f}", end.iterations, end.factorizations, effort.seconds / unit);
}

void study(const std::string& name, int triangles) {
    constexpr double more = 1.005;
    constexpr double nearly = 0.9;
    const MeshedScene finest(name, triangles);
    const SolveOptions options = to_the_end(finest.scene());
    const Model model = model_of(finest.scene(), finest.layout);

    Scene stretched = finest.scene();
    for (double& stretch : stretched.fabric.prestretch) stretch *= more;
    const Eigen::VectorXd same =
        release(stretched, finest.layout, model_of(stretched, finest.layout), {}).equilibrium.x;
    const Effort from_same = effort_of([&] { return solve(model, options, {}, &same); });

    const MeshedScene other(name, static_cast<int>(nearly * triangles));
    const std::vector<Print> print = laminated_print(other.scene(), other.layout);
    const Eigen::VectorXd near =
        release(other.scene(), other.layout, model_of(other.scene(), other.layout), {}).equilibrium.x;
    const Effort from_other = effort_of([&] {
        return solve(model, options, {}, LayoutShape{other.layout.mesh, print, near});
    });

    std::optional<Release> released;
    const Effort whole = effort_of([&] {
        released.emplace(release(finest.scene(), finest.layout, model, {}));
        return released->equilibrium;
    });
    const double unit = factorization_seconds(released->model, released->equilibrium.x);
    fmt::print("| {} | {} | {} | {} | {} |\n", name, finest.layout.mesh.triangle_count(),
               cells(from_same, unit), cells(from_other, unit), cells(whole, unit));
    std::fflush(stdout);
}

}  // namespace
}  // namespace ruche::bench

int main(int argc, char** argv) {
    const int triangles = argc > 1 ? std::atoi(argv[1]) : 20000;
    std::vector<std::string> scenes(argv + std::min(argc, 2), argv + argc);
    if (scenes.empty()) scenes = {"strips", "staggered", "torus", "stars"};
    ruche::set_thread_count(1);
    fmt::print(
        "Iterations / factorisations on the finest mesh, and the cost in factorisations.\n\n"
        "| scene | triangles | from the same mesh | cost | from another mesh | cost | release | cost |\n"
        "|---|---|---|---|---|---|---|---|\n");
    for (const std::string& scene : scenes) ruche::bench::study(scene, triangles);
}

#include "ruche/scene/simulate.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "ruche/core/parallel.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/check_scene.hpp"

namespace ruche {
namespace {

class Stopwatch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - begin_).count();
        begin_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Goes on from `first`; the effort of both counts.
Equilibrium solve_on(const Model& model, const SolveOptions& options, const Control& control,
                     const Equilibrium& first) {
    Equilibrium second = solve(model, options, control, &first.x);
    second.iterations += first.iterations;
    second.factorizations += first.factorizations;
    second.seconds += first.seconds;
    return second;
}

/// A sheet that rests on a table is released in free space first and then laid down: from the flat state,
/// pressed on the table, it could not curl.
Equilibrium release(const Model& model, const SolveOptions& options, const Control& control,
                    const Eigen::VectorXd* start) {
    const ModelInput& input = model.input();
    if (!input.table.present || start != nullptr) return solve(model, options, control, start);
    ModelInput weightless = input;
    weightless.gravity = {0, 0, 0};
    weightless.table.present = false;
    Equilibrium first = solve(Model(std::move(weightless)), options, control);
    if (first.status != SolveStatus::converged) return first;
    const Vec3 gravity(input.gravity[0], input.gravity[1], input.gravity[2]);
    const Vec3 up = gravity.norm() > 0.0 ? Vec3(-gravity.normalized()) : Vec3::UnitZ();
    double lowest = infinity;
    for (int v = 0; v < model.vertex_count(); ++v)
        lowest = std::min(lowest, up.dot(first.x.segment<3>(3 * v)));
    for (int v = 0; v < model.vertex_count(); ++v)
        first.x.segment<3>(3 * v) += (input.table.height - lowest) * up;
    return solve_on(model, options, control, first);
}

/// "strip 'a'", or "bare fabric".
std::string carrier(const PrintMesh& layout, int triangle) {
    const int strip = layout.strip[static_cast<std::size_t>(triangle)];
    return strip < 0 ? "bare fabric" : "strip '" + layout.strips[static_cast<std::size_t>(strip)].id + "'";
}

std::string self_intersection_warning(const Result& result) {
    const Intersection& first = result.self_intersections.front();
    return fmt::format(
        "the sheet passes through itself at {} pairs of triangles, contact is not simulated: first at "
        "({:.4g}, {:.4g}, {:.4g}) mm, {} through {}; more places are in the report's health",
        result.self_intersections.size(), first.place.x(), first.place.y(), first.place.z(),
        carrier(result.layout, first.triangles[0]), carrier(result.layout, first.triangles[1]));
}

}  // namespace

Result simulate(const Scene& scene, const Control& control, const Start& start) {
    Stopwatch watch;
    Result result;
    result.scene = scene;
    check_scene(scene);
    result.warnings = scene.warnings;
    if (scene.solver.threads > 0) set_thread_count(scene.solver.threads);

    control.say({"mesh", 0.0, "meshing"});
    result.layout = scene_mesh(scene);
    result.warnings.insert(result.warnings.end(), result.layout.warnings.begin(),
                           result.layout.warnings.end());
    ModelInput input = scene_model(scene, result.layout);
    result.seconds["mesh"] = watch.lap();
    control.say({"mesh", 1.0,
                 std::to_string(input.mesh.triangle_count()) + " triangles, " +
                     std::to_string(input.mesh.vertex_count()) + " vertices"});

    auto model = std::make_unique<Model>(input);
    Eigen::VectorXd from;
    if (start.state != nullptr) {
        from = start.resume ? resume_from(*start.state, scene, input, start.path)
                            : start_from(*start.state, input.mesh, model->size());
    }
    result.equilibrium = release(*model, scene.solver, control, from.size() > 0 ? &from : nullptr);
    if (result.equilibrium.health.beyond_law > 0 && input.options.log_extension > 1e-6 &&
        result.equilibrium.status == SolveStatus::converged) {
        // The shape leans on the law's linear extension: go on with the paper's much steeper one.
        input.options.log_extension = 1e-6;
        model = std::make_unique<Model>(input);
        result.equilibrium = solve_on(*model, scene.solver, control, result.equilibrium);
        result.warnings.push_back(
            "the fabric is stretched into the limit of its law somewhere; the log extension was narrowed to "
            "1e-6");
    }
    result.seconds["release"] = watch.lap();

    for (int v = 0; v < model->vertex_count(); ++v)
        result.shape.emplace_back(result.equilibrium.x.segment<3>(3 * v));
    result.energy_density = model->energy_density(result.equilibrium.x);
    result.self_intersections = find_self_intersections(result.shape, result.layout.mesh.triangles);
    result.equilibrium.health.self_intersections = static_cast<int>(result.self_intersections.size());
    if (!result.self_intersections.empty()) result.warnings.push_back(self_intersection_warning(result));
    result.assumptions = assumptions(scene, result.layout);
    result.seconds["check"] = watch.lap();
    return result;
}

}  // namespace ruche

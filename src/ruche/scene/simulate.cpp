#include "ruche/scene/simulate.hpp"

#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <memory>

#include "ruche/core/parallel.hpp"
#include "ruche/scene/alternatives.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/check_scene.hpp"
#include "ruche/scene/release.hpp"
#include "ruche/statics/iterate.hpp"

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

/// "strip 'a'", or "bare fabric".
std::string carrier(const PrintMesh& layout, int triangle) {
    const int strip = main_strip(layout, triangle);
    return strip < 0 ? "bare fabric" : "strip '" + layout.strips[static_cast<std::size_t>(strip)].id + "'";
}

std::string self_intersection_warning(const Result& result) {
    const Intersection& first = result.self_intersections.front();
    return fmt::format(
        "the sheet passes through itself at {} pairs of triangles, {}: first at ({:.4g}, {:.4g}, {:.4g}) mm, "
        "{} through {}; more places are in the report's health",
        result.self_intersections.size(),
        result.scene.model.contact ? "although contact is on"
                                   : "model.contact = true would keep it from that",
        first.place.x(), first.place.y(), first.place.z(), carrier(result.layout, first.triangles[0]),
        carrier(result.layout, first.triangles[1]));
}

/// The sheet as it is printed, before anything moves.
void show_flat(const Model& model, const Control& control) {
    if (!control.watch) return;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(model.size());
    for (int v = 0; v < model.vertex_count(); ++v)
        x.segment<2>(3 * v) = model.input().mesh.vertices[static_cast<std::size_t>(v)];
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    control.watch({.sheet = model.input(), .x = x, .energy = unknown, .residual = unknown});
}

/// A run before its release: what all shapes of the scene have in common.
struct Prepared {
    Result result;
    Model model;
    Stopwatch watch;
};

Prepared prepare(const Scene& scene, const Control& control) {
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
    const TriangleMesh& mesh = result.layout.mesh;
    Model model(scene_model(scene, result.layout));
    result.seconds["mesh"] = watch.lap();
    control.say({"mesh", 1.0,
                 std::to_string(mesh.triangle_count()) + " triangles, " +
                     std::to_string(mesh.vertex_count()) + " vertices"});
    result.assumptions = assumptions(scene, result.layout);
    show_flat(model, control);
    return {std::move(result), std::move(model), watch};
}

/// The result with a released shape in it.
void take(Result& result, Release released, Stopwatch& watch) {
    result.equilibrium = std::move(released.equilibrium);
    result.warnings.insert(result.warnings.end(), released.warnings.begin(), released.warnings.end());
    result.seconds["release"] = watch.lap();
    const TriangleMesh& mesh = result.layout.mesh;
    result.shape = vertex_vectors(result.equilibrium.x, mesh.vertex_count());
    result.energy_density = released.model.energy_density(result.equilibrium.x);
    result.self_intersections = find_self_intersections(result.shape, mesh.triangles);
    result.equilibrium.health.self_intersections = static_cast<int>(result.self_intersections.size());
    if (!result.self_intersections.empty()) result.warnings.push_back(self_intersection_warning(result));
    result.seconds["check"] = watch.lap();
}

Release first_release(const Result& result, Model model, const Control& control, const Start& start) {
    Eigen::VectorXd from;
    if (start.state != nullptr) {
        from = start.resume ? resume_from(*start.state, result.scene, model.input(), start.path)
                            : start_from(*start.state, model);
    }
    return release(result.scene, result.layout, std::move(model), control, from.size() > 0 ? &from : nullptr);
}

Model copy(const Model& model) { return Model(ModelInput(model.input())); }

ShapeList list_of(const AlternativeSearch& search, const Equilibrium& ordinary) {
    ShapeList list{.symmetries = search.symmetries,
                   .starts = search.starts,
                   .without_result = search.without_result,
                   .interrupted = search.interrupted};
    for (const Alternative& shape : search.shapes)
        list.shapes.push_back({.number = static_cast<int>(list.shapes.size()) + 1,
                               .energy = shape.equilibrium.energy.total(),
                               .ordinary = shape.equilibrium.x == ordinary.x,
                               .found_from = shape.found_from});
    return list;
}

/// With the scene's own limit of time, from now on.
Control limited(Control control, const Scene& scene) {
    if (scene.solver.time_limit_s > 0.0) {
        control.deadline =
            Control::Clock::now() + std::chrono::duration_cast<Control::Clock::duration>(
                                        std::chrono::duration<double>(scene.solver.time_limit_s));
    }
    return control;
}

}  // namespace

std::vector<Vec3> vertex_vectors(const Eigen::VectorXd& unknowns, int vertex_count) {
    std::vector<Vec3> vectors;
    vectors.reserve(static_cast<std::size_t>(vertex_count));
    for (int v = 0; v < vertex_count; ++v) vectors.emplace_back(unknowns.segment<3>(3 * v));
    return vectors;
}

std::vector<char> passes_through_itself(const Result& result) {
    std::vector<char> marks(result.layout.mesh.triangles.size(), 0);
    for (const Intersection& pair : result.self_intersections) {
        for (const int t : pair.triangles) marks[static_cast<std::size_t>(t)] = 1;
    }
    return marks;
}

Result simulate(const Scene& scene, const Control& control, const Start& start) {
    Prepared run = prepare(scene, control);
    Release released = first_release(run.result, std::move(run.model), limited(control, scene), start);
    take(run.result, std::move(released), run.watch);
    return std::move(run.result);
}

ResultWithAlternatives simulate_alternatives(const Scene& scene, int wanted, const Control& control,
                                             const Start& start) {
    Prepared run = prepare(scene, control);
    ResultWithAlternatives found{.ordinary = run.result, .shapes = {}};
    const Control timed = limited(control, scene);
    take(found.ordinary, first_release(run.result, copy(run.model), timed, start), run.watch);
    const Equilibrium& ordinary = found.ordinary.equilibrium;
    if (ordinary.status == SolveStatus::interrupted) return found;
    const AlternativeSearch search =
        find_alternatives(scene, run.result.layout, run.model, ordinary, wanted, timed);
    found.ordinary.seconds["search"] = run.watch.lap();
    found.ordinary.alternatives = list_of(search, ordinary);
    for (const Alternative& shape : search.shapes) {
        found.shapes.push_back(run.result);
        take(found.shapes.back(), with_its_model(copy(run.model), shape.equilibrium), run.watch);
    }
    return found;
}

}  // namespace ruche

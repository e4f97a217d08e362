#include "ruche/scene/release.hpp"

#include <fmt/format.h>

#include "ruche/core/parallel.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/statics/contact_guard.hpp"
#include "ruche/statics/sparse_cholesky.hpp"

namespace ruche {
namespace {

/// `next` after `first`: the effort of both counts.
Equilibrium after(const Equilibrium& first, Equilibrium next) {
    next.iterations += first.iterations;
    next.factorizations += first.factorizations;
    next.seconds += first.seconds;
    next.levels.insert(next.levels.begin(), first.levels.begin(), first.levels.end());
    return next;
}

SolveOptions as_a_start(const Scene& scene) {
    SolveOptions options = scene.solver;
    options.enough_rotation = 0.02;
    options.max_iterations = 60;
    return options;
}

/// Meshes of the same pattern, finest first, each with elements three times as long as the one before (2.5
/// times where that is very fine, twice where meshes are nested) as far as that saves enough triangles to be
/// worth a level. None where something else than the sheet's own forces acts.
std::vector<PrintMesh> coarser_layouts(const Scene& scene, const PrintMesh& finest) {
    constexpr int small = 1500;    // triangles: solved faster than coarsened
    constexpr double worth = 0.4;  // of the triangles of the level above, at most
    // Twice as long below, levels hardly save the finest mesh a step; four times, it takes more steps with
    // 80 000 triangles, and three times with 200 000.
    constexpr int very_fine = 100'000;  // triangles
    std::vector<PrintMesh> layouts;
    if (!scene.solver.coarse_start || !scene.supports.empty() || !scene.forces.empty() ||
        !scene.pattern.mesh.empty())
        return layouts;
    const Pattern pattern = scene_pattern(scene);
    MeshOptions options = mesh_options(scene);
    int count = finest.mesh.triangle_count();
    while (count > small) {
        if (options.subdivisions > 0) {
            --options.subdivisions;
        } else {
            const double coarsening = count > very_fine ? 2.5 : 3.0;
            options.size_mm *= coarsening;
            options.fabric_size_mm *= coarsening;
            options.elements_across = std::max(0.5, options.elements_across / coarsening);
        }
        PrintMesh layout = mesh_pattern(pattern, options);
        if (layout.mesh.triangle_count() > worth * count) break;
        count = layout.mesh.triangle_count();
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

/// Free of contact, and of weight when the sheet is to be laid on a table.
Scene free_of_obstacles(Scene scene) {
    scene.model.contact = false;
    if (scene.gravity.table) scene.gravity = {};
    return scene;
}

bool touches_itself(const Model& model, const Eigen::VectorXd& x) {
    return passes_through_itself(model, x) || ContactGuard(model).touches(x);
}

}  // namespace

SolveOptions to_the_end(const Scene& scene) {
    constexpr double paper_log_extension = 1e-6;
    SolveOptions options = scene.solver;
    options.narrow_log_extension = paper_log_extension;
    return options;
}

ReleasePath::ReleasePath(const Scene& scene, const PrintMesh& layout, const Model& model)
    : scene_(scene),
      layout_(layout),
      model_(model),
      free_scene_(free_of_obstacles(scene)),
      coarser_(coarser_layouts(scene, layout)) {
    if (scene.gravity.table || scene.model.contact) free_model_.emplace(scene_model(free_scene_, layout));
    if (!coarser_.empty()) coarsest_model_.emplace(scene_model(free_scene_, coarser_.back()));
}

const PrintMesh& ReleasePath::first_layout() const { return coarser_.empty() ? layout_ : coarser_.back(); }

const Model& ReleasePath::first_model() const { return coarsest_model_ ? *coarsest_model_ : free_model(); }

const Model& ReleasePath::free_model() const { return free_model_ ? *free_model_ : model_; }

Equilibrium ReleasePath::from_flat(const Control& control) const {
    const SolveOptions options = coarser_.empty() ? to_the_end(scene_) : as_a_start(scene_);
    Equilibrium first = solve(first_model(), options, control);
    return coarser_.empty() ? settle(std::move(first), control) : climb(std::move(first), control);
}

Equilibrium ReleasePath::from(Equilibrium start, const Control& control) const {
    if (!coarser_.empty()) return climb(std::move(start), control);
    return settle(after(start, solve(free_model(), to_the_end(scene_), control, &start.x)), control);
}

/// To finer and finer meshes.
Equilibrium ReleasePath::climb(Equilibrium start, const Control& control) const {
    const auto solve_on = [&](const Model& model, const SolveOptions& options, const PrintMesh& below) {
        return after(start, solve(model, options, control,
                                  LayoutShape{below.mesh, laminated_print(scene_, below), start.x}));
    };
    for (std::size_t level = coarser_.size() - 1; level > 0; --level)
        start = solve_on(Model(scene_model(free_scene_, coarser_[level - 1])), as_a_start(scene_),
                         coarser_[level]);
    Equilibrium end = solve_on(free_model(), to_the_end(scene_), coarser_.front());
    end.iterations = end.levels.back().iterations;
    end.factorizations = end.levels.back().factorizations;
    return settle(std::move(end), control);
}

/// Among the obstacles that the free sheet did not know of.
Equilibrium ReleasePath::settle(Equilibrium free, const Control& control) const {
    return lay_on_table(keep_apart(std::move(free), control), control);
}

/// A sheet that touches itself is released once more, from the flat state: contact cannot undo what has
/// passed through.
Equilibrium ReleasePath::keep_apart(Equilibrium free, const Control& control) const {
    if (!scene_.model.contact || free.status == SolveStatus::interrupted) return free;
    Scene weightless = free_scene_;
    weightless.model.contact = true;
    const Model apart(scene_model(weightless, layout_));
    if (!touches_itself(apart, free.x)) return free;
    Equilibrium end = after(free, solve(apart, to_the_end(scene_), control));
    end.iterations = end.levels.back().iterations;
    end.factorizations = end.levels.back().factorizations;
    return end;
}

/// A sheet that rests on a table is released in free space first and then laid down: from the flat state,
/// pressed on the table, it could not curl.
Equilibrium ReleasePath::lay_on_table(Equilibrium free, const Control& control) const {
    const ModelInput& input = model_.input();
    if (!input.table.present || free.status != SolveStatus::converged) return free;
    const Vec3 gravity(input.gravity[0], input.gravity[1], input.gravity[2]);
    const Vec3 up = gravity.norm() > 0.0 ? Vec3(-gravity.normalized()) : Vec3::UnitZ();
    double lowest = infinity;
    for (int v = 0; v < model_.vertex_count(); ++v)
        lowest = std::min(lowest, up.dot(free.x.segment<3>(3 * v)));
    for (int v = 0; v < model_.vertex_count(); ++v)
        free.x.segment<3>(3 * v) += (input.table.height - lowest) * up;
    return after(free, solve(model_, to_the_end(scene_), control, &free.x));
}

Release with_its_model(Model model, Equilibrium end) {
    std::vector<std::string> warnings;
    if (end.log_extension != model.input().options.log_extension) {
        model = model.with_log_extension(end.log_extension);
        warnings.push_back(
            fmt::format("the fabric is stretched into the limit of its law somewhere; the log extension was "
                        "narrowed to {}",
                        end.log_extension));
    }
    return {std::move(model), std::move(end), std::move(warnings)};
}

Release release(const Scene& scene, const PrintMesh& layout, Model model, const Control& control,
                const Eigen::VectorXd* start) {
    control.say({"release", -1.0,
                 fmt::format("{} threads, dense kernels for {} (OpenBLAS)", thread_count(), blas_kernels())});
    const bool impossible = start != nullptr && scene.model.contact && passes_through_itself(model, *start);
    Equilibrium end = start != nullptr && !impossible ? solve(model, to_the_end(scene), control, start)
                                                      : ReleasePath(scene, layout, model).from_flat(control);
    Release released = with_its_model(std::move(model), std::move(end));
    if (impossible) {
        released.warnings.emplace_back(
            "the given start passes through itself, which contact cannot undo: the sheet is released from "
            "the "
            "flat state instead");
    }
    return released;
}

}  // namespace ruche

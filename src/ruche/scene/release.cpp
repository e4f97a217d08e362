#include "ruche/scene/release.hpp"

#include <fmt/format.h>

#include "ruche/core/parallel.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/statics/contact_guard.hpp"
#include "ruche/statics/sparse_cholesky.hpp"

namespace ruche {
namespace {

constexpr double paper_log_extension = 1e-6;

/// `next` after `first`: the effort of both counts.
Equilibrium after(const Equilibrium& first, Equilibrium next) {
    next.iterations += first.iterations;
    next.factorizations += first.factorizations;
    next.seconds += first.seconds;
    next.levels.insert(next.levels.begin(), first.levels.begin(), first.levels.end());
    return next;
}

SolveOptions to_the_end(const Scene& scene) {
    SolveOptions options = scene.solver;
    options.narrow_log_extension = paper_log_extension;
    return options;
}

/// Meshes of the same pattern, finest first, each with elements twice as long as the one before as far as
/// that saves enough triangles to be worth a level.
std::vector<PrintMesh> coarser_layouts(const Scene& scene, const PrintMesh& finest) {
    constexpr int small = 1500;    // triangles: solved faster than coarsened
    constexpr double worth = 0.4;  // of the triangles of the level above, at most
    std::vector<PrintMesh> layouts;
    if (!scene.pattern.mesh.empty()) return layouts;
    const Pattern pattern = scene_pattern(scene);
    MeshOptions options = scene.mesh;
    int count = finest.mesh.triangle_count();
    while (count > small) {
        options.size_mm *= 2.0;
        options.fabric_size_mm *= 2.0;
        options.elements_across = std::max(1.0, 0.5 * options.elements_across);
        PrintMesh layout = mesh_pattern(pattern, options);
        if (layout.mesh.triangle_count() > worth * count) break;
        count = layout.mesh.triangle_count();
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

/// From the flat printed state, by way of coarser meshes where nothing but the sheet's own forces act.
Equilibrium release_from_flat(const Scene& scene, const PrintMesh& layout, const Model& model,
                              const Control& control) {
    if (!scene.solver.coarse_start || !scene.supports.empty() || !scene.forces.empty())
        return solve(model, to_the_end(scene), control);
    const std::vector<PrintMesh> layouts = coarser_layouts(scene, layout);
    SolveOptions rough = scene.solver;
    rough.enough_rotation = 0.01;
    rough.max_iterations = 60;
    const PrintMesh* below = nullptr;
    Equilibrium start;
    const auto solve_level = [&](const Model& on, const SolveOptions& options) {
        if (below == nullptr) return solve(on, options, control);
        return after(start, solve(on, options, control, LayoutShape{below->mesh, below->print, start.x}));
    };
    for (auto level = layouts.rbegin(); level != layouts.rend(); ++level) {
        start = solve_level(Model(scene_model(scene, *level)), rough);
        below = &*level;
    }
    Equilibrium end = solve_level(model, to_the_end(scene));
    end.iterations = end.levels.back().iterations;
    end.factorizations = end.levels.back().factorizations;
    return end;
}

bool touches_itself(const Model& model, const Eigen::VectorXd& x) {
    return passes_through_itself(model, x) || ContactGuard(model).touches(x);
}

/// The same with contact between parts of the sheet, whose model is `model`.
Equilibrium release_with_contact(const Scene& scene, const PrintMesh& layout, const Model& model,
                                 const Control& control) {
    Scene alone = scene;
    alone.model.contact = false;
    const Equilibrium first = release_from_flat(alone, layout, Model(scene_model(alone, layout)), control);
    if (first.status == SolveStatus::interrupted || !touches_itself(model, first.x)) return first;
    Equilibrium end = after(first, solve(model, to_the_end(scene), control));
    end.iterations = end.levels.back().iterations;
    end.factorizations = end.levels.back().factorizations;
    return end;
}

/// A sheet that rests on a table is released in free space first and then laid down: from the flat state,
/// pressed on the table, it could not curl.
Equilibrium lay_on_table(const Scene& scene, const PrintMesh& layout, const Model& model,
                         const Control& control) {
    Scene weightless = scene;
    weightless.gravity = {};
    const Model free(scene_model(weightless, layout));
    Equilibrium first = scene.model.contact ? release_with_contact(weightless, layout, free, control)
                                            : release_from_flat(weightless, layout, free, control);
    if (first.status != SolveStatus::converged) return first;
    const ModelInput& input = model.input();
    const Vec3 gravity(input.gravity[0], input.gravity[1], input.gravity[2]);
    const Vec3 up = gravity.norm() > 0.0 ? Vec3(-gravity.normalized()) : Vec3::UnitZ();
    double lowest = infinity;
    for (int v = 0; v < model.vertex_count(); ++v)
        lowest = std::min(lowest, up.dot(first.x.segment<3>(3 * v)));
    for (int v = 0; v < model.vertex_count(); ++v)
        first.x.segment<3>(3 * v) += (input.table.height - lowest) * up;
    return after(first, solve(model, to_the_end(scene), control, &first.x));
}

Equilibrium first_equilibrium(const Scene& scene, const PrintMesh& layout, const Model& model,
                              const Control& control, const Eigen::VectorXd* start) {
    if (start != nullptr) return solve(model, to_the_end(scene), control, start);
    if (model.input().table.present) return lay_on_table(scene, layout, model, control);
    if (scene.model.contact) return release_with_contact(scene, layout, model, control);
    return release_from_flat(scene, layout, model, control);
}

}  // namespace

Release release(const Scene& scene, const PrintMesh& layout, Model model, const Control& control,
                const Eigen::VectorXd* start) {
    control.say({"release", -1.0,
                 fmt::format("{} threads, dense kernels for {} (OpenBLAS)", thread_count(), blas_kernels())});
    std::vector<std::string> warnings;
    if (start != nullptr && scene.model.contact && passes_through_itself(model, *start)) {
        start = nullptr;
        warnings.emplace_back(
            "the given start passes through itself, which contact cannot undo: the sheet is released from "
            "the "
            "flat state instead");
    }
    Equilibrium end = first_equilibrium(scene, layout, model, control, start);
    if (end.log_extension != scene.model.log_extension) {
        ModelInput narrowed = model.input();
        narrowed.options.log_extension = end.log_extension;
        model = Model(std::move(narrowed));
        warnings.push_back(
            fmt::format("the fabric is stretched into the limit of its law somewhere; the log extension was "
                        "narrowed to {}",
                        end.log_extension));
    }
    return {std::move(model), std::move(end), std::move(warnings)};
}

}  // namespace ruche

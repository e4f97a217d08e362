#include "ruche/scene/release_film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/geometry/rigid_alignment.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/result.hpp"
#include "ruche/statics/equilibrium.hpp"

namespace ruche {
namespace {

constexpr int quick = 3000;     ///< triangles that are followed as they are
constexpr int aimed_at = 2000;  ///< triangles of a coarser mesh
constexpr int most = 15000;     ///< triangles beyond which a film would take too long

/// A mesh that is solved quickly; nothing where there is none.
std::optional<PrintMesh> quick_layout(const Result& result) {
    const Scene& scene = result.scene;
    const int count = result.layout.mesh.triangle_count();
    if (count <= quick) return result.layout;
    const bool held = !scene.supports.empty() || !scene.forces.empty();
    if (held || !scene.pattern.mesh.empty()) {
        if (count > most) return {};
        return result.layout;
    }
    const double coarser = std::sqrt(static_cast<double>(count) / aimed_at);
    MeshOptions options = undivided(mesh_options(scene));
    options.size_mm *= coarser;
    options.fabric_size_mm *= coarser;
    options.elements_across = std::max(1.0, options.elements_across / coarser);
    PrintMesh layout = mesh_pattern(scene_pattern(scene), options);
    if (layout.mesh.triangle_count() > most) return {};
    if (layout.mesh.triangle_count() > 0.7 * count) return result.layout;
    return layout;
}

SolveOptions roughly(const Scene& scene) {
    SolveOptions options = scene.solver;
    options.enough_rotation = 2e-3;
    options.max_iterations = 40;
    return options;
}

/// The pre-stretch with that share of the mismatch (s^2 - 1)/(2 s^2).
double prestretch_at(double share, double full) {
    return 1.0 / std::sqrt(1.0 - share * (1.0 - 1.0 / (full * full)));
}

void turn_onto(std::vector<Vec3>& shape, const std::vector<Vec3>& next) {
    const RigidAlignment motion = align(shape, next);
    for (Vec3& p : shape) p = motion.rotation * p + motion.translation;
}

bool found(const Equilibrium& frame, const SolveOptions& options) {
    return frame.status != SolveStatus::interrupted && frame.x.allFinite() && !frame.health.tangled &&
           frame.iterations < options.max_iterations;
}

/// The released shape on the film's mesh.
Eigen::VectorXd released(const Result& result, const Model& model, const Control& control) {
    const SolveOptions options = roughly(result.scene);
    const TriangleMesh& fine = result.layout.mesh;
    if (fine.vertex_count() == model.vertex_count() && result.equilibrium.x.size() == model.size())
        return result.equilibrium.x;
    const std::vector<Print> print = laminated_print(result.scene, result.layout);
    return solve(model, options, control, LayoutShape{fine, print, result.equilibrium.x}).x;
}

ReleaseFilm follow(const Result& result, PrintMesh layout, const Control& control) {
    const Scene& scene = result.scene;
    const int frames = scene.output.film_frames;
    const int vertices = layout.mesh.vertex_count();
    const SolveOptions options = roughly(scene);
    const bool free = scene.supports.empty() && scene.forces.empty() && !scene.gravity.table;
    ModelInput input = scene_model(scene, layout);
    const Control quiet{.stop = control.stop, .deadline = control.deadline};
    Eigen::VectorXd x = released(result, Model(input), quiet);
    std::vector<Vec3> next = vertex_vectors(x, vertices);
    ReleaseFilm film{.layout = std::move(layout)};
    const auto keep = [&](double share, std::vector<Vec3> shape) {
        if (free) turn_onto(shape, next);
        next = shape;
        film.frames.push_back({share, input.prestretch, std::move(shape)});
    };
    for (int i = frames - 1; i > 0 && !control.stopped() && !control.timed_out(); --i) {
        const double share = static_cast<double>(i) / frames;
        control.say({"film", 1.0 - share, fmt::format("film of the release, {} frames to go", i)});
        for (std::size_t k = 0; k < 2; ++k)
            input.prestretch[k] = prestretch_at(share, scene.fabric.prestretch[k]);
        const Equilibrium frame = solve(Model(input), options, quiet, &x);
        if (!found(frame, options)) continue;
        x = frame.x;
        keep(share, vertex_vectors(x, vertices));
    }
    std::vector<Vec3> flat;
    flat.reserve(film.layout.mesh.vertices.size());
    for (const Vec2& v : film.layout.mesh.vertices) flat.emplace_back(v.x(), v.y(), 0.0);
    input.prestretch = {1, 1};
    keep(0.0, std::move(flat));
    std::reverse(film.frames.begin(), film.frames.end());
    return film;
}

}  // namespace

std::optional<ReleaseFilm> film_release(const Result& result, const Control& control) {
    if (result.scene.output.film_frames == 0 || result.equilibrium.status != SolveStatus::converged)
        return {};
    try {
        std::optional<PrintMesh> layout = quick_layout(result);
        if (!layout) return {};
        ReleaseFilm film = follow(result, std::move(*layout), control);
        // A flat sheet and nothing else would not show a release.
        if (control.stopped() || control.timed_out() || film.frames.size() < 3) return {};
        return film;
    } catch (const InputError&) {
        return {};  // the coarser mesh cannot carry the scene's loads
    }
}

}  // namespace ruche

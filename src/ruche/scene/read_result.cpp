#include "ruche/scene/read_result.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ruche/core/document.hpp"
#include "ruche/core/error.hpp"
#include "ruche/energy/model.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/state.hpp"

namespace ruche {
namespace {

/// What the report says of how the solve ended.
void read_verdict(const std::string& path, Equilibrium& equilibrium) {
    constexpr std::size_t longest = 256U << 20U;
    try {
        const auto report = nlohmann::json::parse(read_file(path, "report", longest));
        const std::string status = report.at("status");
        equilibrium.status = status == "converged"     ? SolveStatus::converged
                             : status == "interrupted" ? SolveStatus::interrupted
                                                       : SolveStatus::not_converged;
        equilibrium.stable = report.at("stable");
        equilibrium.residual = report.at("residual_N");
    } catch (const nlohmann::json::exception&) {
        throw InputError({.file = path}, "is no report of a result, or damaged", "Run the scene again.");
    }
}

}  // namespace

Result read_result(const std::string& folder) {
    const auto in_folder = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    if (!std::filesystem::exists(in_folder("report.json")))
        throw InputError({.file = folder}, "holds no result: there is no report.json in it",
                         "`ruche simulate SCENE -o DIR` makes one; give that DIR.");
    Result result;
    read_verdict(in_folder("report.json"), result.equilibrium);
    result.scene = read_scene(in_folder("scene.toml"));
    const State state = read_state(in_folder("state.ruche"));
    result.layout = scene_mesh(result.scene);
    const Model model(scene_model(result.scene, result.layout));
    if (result.layout.mesh.triangles != state.layout.triangles || state.x.size() != model.size())
        throw InputError({.file = folder}, "holds a result of another mesh than its scene makes now",
                         "The drawing or the program has changed since. Run the scene again.");
    result.equilibrium.x = state.x;
    result.equilibrium.energy = model.energy_terms(state.x);
    result.shape = vertex_vectors(state.x, model.vertex_count());
    result.energy_density = model.energy_density(state.x);
    result.self_intersections = find_self_intersections(result.shape, result.layout.mesh.triangles);
    return result;
}

}  // namespace ruche

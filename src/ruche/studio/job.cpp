#include "ruche/studio/job.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ruche/output/result_folder.hpp"
#include "ruche/scene/build.hpp"
#include "ruche/scene/simulate.hpp"

namespace ruche {

/// The scene on larger elements: about `wanted` triangles, as far as the drawing's details allow.
static Scene coarsened(Scene scene, double wanted) {
    if (!scene.pattern.mesh.empty()) return scene;
    const Pattern pattern = scene_pattern(scene);
    double printed = 0.0;
    for (const Strip& strip : pattern.strips) printed += area(strip.region);
    const auto count = [](double covered, double size) { return covered / (0.433 * size * size); };
    const double bare = std::max(0.0, area(pattern.fabric) - printed);
    const double fine = count(printed, scene.mesh.size_mm) + count(bare, scene.mesh.fabric_size_mm);
    const double factor = std::max(1.0, std::sqrt(fine / wanted));
    scene.mesh.size_mm *= factor;
    scene.mesh.fabric_size_mm *= factor;
    scene.mesh.elements_across = std::min(scene.mesh.elements_across, 1.0);
    return scene;
}

void run_preview(const JobOrder& order, const Control& control) {
    constexpr double triangles = 1500.0;
    constexpr int patience = 60;  // iterations: what does not come to rest by then is shown as it is
    Scene scene = coarsened(order.scene, triangles);
    scene.solver.max_iterations = std::min(scene.solver.max_iterations, patience);
    scene.model.contact = false;
    (void)simulate(scene, control);
}

std::string run_release(const JobOrder& order, const Workspace& workspace, const Control& control) {
    const std::string folder = (workspace.root() / order.folder).string();
    check_result_folder(folder);
    std::optional<State> state;
    Start start;
    if (!order.start.empty()) {
        start.path = workspace.inside(order.start + "/state.ruche").string();
        state = read_state(start.path);
        start.state = &*state;
    }
    Result result = simulate(order.scene, control, start);
    add_film(result, control);
    (void)write_result(result, folder, control);
    return std::string(name_of(result.equilibrium.status));
}

}  // namespace ruche

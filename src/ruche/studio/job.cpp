#include "ruche/studio/job.hpp"

#include <optional>

#include "ruche/output/result_folder.hpp"
#include "ruche/scene/preview.hpp"
#include "ruche/scene/simulate.hpp"
#include "ruche/study/scan/scan_files.hpp"
#include "ruche/study/silhouette/silhouette_files.hpp"

namespace ruche {

void run_preview(const JobOrder& order, const Control& control) {
    constexpr double triangles = 1500.0;
    (void)simulate(preview_scene(order.scene, triangles), control);
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

void run_comparison(const JobOrder& order, const Workspace& workspace, const Control& control) {
    const std::string folder = workspace.inside(order.folder).string();
    const std::string made = workspace.inside(order.made).string();
    if (order.photo)
        (void)compare_silhouette_files(folder, made, folder, *order.photo);
    else
        (void)compare_files(folder, made, folder, {.unit = order.unit}, control);
}

}  // namespace ruche

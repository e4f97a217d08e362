#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "ruche/core/control.hpp"
#include "ruche/scene/scene.hpp"
#include "ruche/studio/live_shape.hpp"
#include "ruche/studio/time_left.hpp"
#include "ruche/studio/workspace.hpp"
#include "ruche/study/silhouette/silhouette_comparison.hpp"

namespace ruche {

enum class JobKind { preview, release, comparison };

/// What is to be computed.
struct JobOrder {
    JobKind kind = JobKind::release;
    std::string owner;  ///< the page that asked; it has one preview at a time
    Scene scene;
    std::string folder;  ///< of the result, relative to the workspace; none of a preview
    std::string start;   ///< result to begin with, relative; or empty
    std::string made;    ///< a file to compare the result with, relative: a scan; with `photo` a photo
    std::string unit;    ///< of the scan; empty: guessed
    std::optional<SilhouetteOptions> photo = {};
};

/// A preview: the scene released on so coarse a mesh (about 1500 triangles) that it takes a second or two.
/// Nothing is written. Throws as `simulate`.
void run_preview(const JobOrder& order, const Control& control);

/// A release as `ruche simulate` would do it, written into its folder. Returns what it came to: "converged",
/// "not_converged", "interrupted". Throws as `simulate` and `write_result`.
std::string run_release(const JobOrder& order, const Workspace& workspace, const Control& control);

/// The result in the order's folder against what was made, as `ruche compare` does it; writes into that
/// folder. Throws as `compare_files` and `compare_silhouette_files`.
void run_comparison(const JobOrder& order, const Workspace& workspace, const Control& control);

}  // namespace ruche

#pragma once

#include <atomic>
#include <string>

#include "ruche/core/control.hpp"
#include "ruche/scene/scene.hpp"
#include "ruche/studio/live_shape.hpp"
#include "ruche/studio/time_left.hpp"
#include "ruche/studio/workspace.hpp"

namespace ruche {

enum class JobKind { preview, release };

/// What is to be computed.
struct JobOrder {
    JobKind kind = JobKind::release;
    std::string owner;  ///< the page that asked; it has one preview at a time
    Scene scene;
    std::string folder;  ///< for the result, relative to the workspace; none of a preview
    std::string start;   ///< result to begin with, relative; or empty
};

/// A preview: the scene released on so coarse a mesh (about 1500 triangles) that it takes a second or two.
/// Nothing is written. Throws as `simulate`.
void run_preview(const JobOrder& order, const Control& control);

/// A release as `ruche simulate` would do it, written into its folder. Returns what it came to: "converged",
/// "not_converged", "interrupted". Throws as `simulate` and `write_result`.
std::string run_release(const JobOrder& order, const Workspace& workspace, const Control& control);

}  // namespace ruche

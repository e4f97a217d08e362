#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/energy/model.hpp"
#include "ruche/scene/result.hpp"
#include "ruche/scene/scene.hpp"

namespace ruche {

/// Where a solve stands, kept in DIR/state.ruche so that it can go on later, or serve as a start for another.
struct State {
    std::string scene;              ///< the resolved scene as TOML, to say what has changed since
    std::uint64_t fingerprint = 0;  ///< of the model: the same problem only when equal
    TriangleMesh layout;
    Eigen::VectorXd x;   ///< unknowns, bit by bit
    int iterations = 0;  ///< that led here
};

/// Changes with anything that changes the energy: mesh, print, material, loads, supports, model choices. The
/// same on every machine.
std::uint64_t fingerprint(const ModelInput& model);

/// Where a finished or interrupted run stands.
State state_of(const Result& result);

/// The contents of a state file.
std::string to_bytes(const State& state);

/// Throws std::runtime_error when it cannot be written; an earlier file is then left as it was.
void write_state(const std::string& path, const State& state);

/// Throws InputError for a missing, foreign, truncated or damaged file.
State read_state(const std::string& path);

/// The unknowns to go on from when the state belongs to the same model. Throws InputError that names what
/// differs in the scene otherwise; `path` is named in messages.
Eigen::VectorXd resume_from(const State& state, const Scene& scene, const ModelInput& model,
                            const std::string& path);

/// A start on another mesh or for another scene: the state's unknowns for the same mesh, else its shape
/// carried over (see transfer).
Eigen::VectorXd start_from(const State& state, const Model& model);

}  // namespace ruche

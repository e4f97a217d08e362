#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/scene/scene.hpp"
#include "ruche/study/validation/experiment.hpp"

namespace ruche {

/// Which of an experiment's runs one is.
struct RunPlace {
    std::size_t variant = 0;
    double at = 0.0;    ///< of the sweep; 0 without one
    double mesh = 1.0;  ///< element size over the scene's

    auto operator<=>(const RunPlace&) const = default;
};

/// A release (or a sample that is pulled or hangs) that is to be computed.
struct ValidationRun {
    RunPlace place;
    Scene scene;
    std::optional<ClampedSample> pull;
    std::optional<CantileverSample> hang;
    std::string picture_title;  ///< empty: no picture of it
    std::string command;        ///< that repeats it
    std::string key;            ///< of what it depends on, the program included: 16 hexadecimal digits
};

struct RunOutcome {
    std::map<std::string, double> values;  ///< by metric
    bool certain = false;                  ///< converged and stable
    std::string message;                   ///< why it stopped
    std::vector<std::string> warnings;
    int triangles = 0;
    double seconds = 0.0;
    std::string picture;  ///< PNG file's contents
};

/// Every run of an experiment, or of its quick subset; `program` names what computes, so that another
/// program's outcomes are not taken for this one's. Throws InputError for scenes that cannot be read.
std::vector<ValidationRun> expand(const Experiment& experiment, bool quick, const std::string& program);

/// Computes it on the calling thread; nothing when `control` stopped it. Throws InputError.
std::optional<RunOutcome> compute(const ValidationRun& run, const Experiment& experiment,
                                  const Control& control);

/// Outcomes on disk, by key: "runs/KEY.json" and "runs/KEY.png" below the folder.
class RunStore {
  public:
    explicit RunStore(std::string folder);
    std::optional<RunOutcome> find(const ValidationRun& run) const;  ///< nothing for a damaged file, too
    void keep(const ValidationRun& run, const RunOutcome& outcome) const;

  private:
    std::string path(const ValidationRun& run, const char* ending) const;
    std::string folder_;
};

}  // namespace ruche

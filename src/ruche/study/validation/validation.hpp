#pragma once

#include <map>
#include <string>
#include <vector>

#include "ruche/core/control.hpp"
#include "ruche/study/validation/estimate.hpp"
#include "ruche/study/validation/validation_run.hpp"

namespace ruche {

/// The values of one metric of one variant along the sweep.
struct ValueSeries {
    std::string variant;
    std::string metric;
    std::vector<double> x;
    std::vector<Estimate> y;
    std::vector<double> low, high;  ///< with the swept value off by its spread; empty without one
};

/// What values that carry an uncertainty say about a claim.
enum class Verdict {
    holds,       ///< for everything within the uncertainties
    unresolved,  ///< for a part of that: it takes finer meshes
    fails        ///< for nothing within them; or there is no number, or no certified equilibrium
};

struct CheckOutcome {
    CheckSpec check;
    Verdict verdict = Verdict::fails;
    std::vector<std::string> details;  ///< one per value that was looked at, those against the claim first
};

/// "holds", "not resolved", "does not hold".
const char* to_text(Verdict verdict);

struct ExperimentOutcome {
    Experiment experiment;
    std::vector<ValidationRun> runs;
    std::vector<RunOutcome> outcomes;  ///< of each run
    std::vector<ValueSeries> series;
    std::vector<CheckOutcome> checks;

    const ValueSeries& of(const std::string& variant, const std::string& metric) const;
};

struct Validation {
    std::vector<ExperimentOutcome> experiments;
    bool quick = false;
    bool interrupted = false;  ///< only what had been computed before is kept, nothing is judged
    std::size_t computed = 0;  ///< runs that were not on disk yet
    double seconds = 0.0;      ///< by the clock, this time
    int jobs = 1;

    /// Claims that were not shown. A quick run cannot show all, and does not say that it did: there those
    /// that its meshes do not resolve are not among them.
    std::size_t failed_checks() const;
    std::size_t unresolved_checks() const;
};

struct ValidationOptions {
    bool quick = false;
    int jobs = 0;         ///< runs at a time, each on one thread; 0 = all cores
    std::string folder;   ///< where outcomes are kept, below runs/
    std::string program;  ///< what computes, see `expand`
};

/// Runs experiments, those runs that are not on disk yet, and judges them. Throws InputError for experiments
/// that cannot be run.
[[nodiscard]] Validation validate(std::vector<Experiment> experiments, const ValidationOptions& options,
                                  const Control& control = {});

/// Values with uncertainties from an experiment's outcomes, along the sweep.
std::vector<ValueSeries> value_series(const ExperimentOutcome& outcome);

/// Judges every check of an experiment whose series are there, by the worst of its values.
std::vector<CheckOutcome> judge(const ExperimentOutcome& outcome);

/// One page with everything in it: claims, plots, tables, pictures, commands.
std::string validation_page(const Validation& validation);

/// The same as JSON; docs/file-formats.md lists the keys.
std::string validation_json(const Validation& validation);

}  // namespace ruche

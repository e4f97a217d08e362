#pragma once

#include "ruche/scene/result.hpp"
#include "ruche/study/validation/validation_run.hpp"

namespace ruche {

/// One metric of a released shape, by itself (`MetricSpec::over` is the caller's). NaN where there is nothing
/// to measure, and for metrics of samples.
double measured(const MetricSpec& metric, const Result& result);

/// A run's clamped sample at the strains of the experiment's metrics.
RunOutcome pull_sample(const ValidationRun& run, const Experiment& experiment);

/// A run's strip of fabric that hangs from a clamp.
RunOutcome hang_sample(const ValidationRun& run, const Experiment& experiment);

}  // namespace ruche

#include "ruche/study/validation/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <mutex>
#include <optional>

#include "ruche/core/parallel.hpp"

namespace ruche {
namespace {

/// A run to compute: experiment and run, by index.
struct OpenRun {
    std::size_t experiment = 0, run = 0;
};

/// What had been computed before, and what is left to do: the finest meshes first, so that no long run is
/// left over at the end.
std::vector<OpenRun> look_up(Validation& validation, const RunStore& store) {
    std::vector<OpenRun> open;
    for (std::size_t e = 0; e < validation.experiments.size(); ++e) {
        ExperimentOutcome& outcome = validation.experiments[e];
        outcome.outcomes.resize(outcome.runs.size());
        for (std::size_t r = 0; r < outcome.runs.size(); ++r) {
            if (std::optional<RunOutcome> known = store.find(outcome.runs[r]))
                outcome.outcomes[r] = std::move(*known);
            else
                open.push_back({e, r});
        }
    }
    std::ranges::stable_sort(open, {}, [&](const OpenRun& o) {
        return validation.experiments[o.experiment].runs[o.run].place.mesh;
    });
    return open;
}

std::string title_of(const ExperimentOutcome& outcome, const ValidationRun& run) {
    const Experiment& e = outcome.experiment;
    std::string text = fmt::format("{}, {}", e.name, e.variants[run.place.variant].name);
    if (!e.sweep.key.empty()) text += fmt::format(", {} = {:g}", e.sweep.key, run.place.at);
    return text + fmt::format(", mesh x {:g}", run.place.mesh);
}

/// Computes all that is open, several at a time; each run has one thread, since what is parallel inside runs
/// serially there. Returns how many were finished.
std::size_t run_all(Validation& validation, const std::vector<OpenRun>& open, const RunStore& store,
                    const Control& control) {
    std::mutex mutex;
    std::size_t done = 0;
    set_thread_count(validation.jobs);
    parallel_for(open.size(), [&](std::size_t i) {
        if (control.stopped()) return;
        ExperimentOutcome& outcome = validation.experiments[open[i].experiment];
        const ValidationRun& run = outcome.runs[open[i].run];
        const Control inner{.stop = control.stop};
        std::optional<RunOutcome> result = compute(run, outcome.experiment, inner);
        if (!result) return;
        store.keep(run, *result);
        const std::scoped_lock lock(mutex);
        ++done;
        control.say({"validate", static_cast<double>(done) / static_cast<double>(open.size()),
                     fmt::format("{} of {} runs: {}, {:.1f} s", done, open.size(), title_of(outcome, run),
                                 result->seconds)});
        outcome.outcomes[open[i].run] = std::move(*result);
    });
    return done;
}

/// The values of a metric at one place of the sweep, coarsest mesh first.
Estimate estimate_at(const ExperimentOutcome& outcome, RunPlace place, const std::vector<double>& meshes,
                     const std::string& metric) {
    std::vector<double> values;
    bool certain = true;
    for (const double mesh : meshes) {
        place.mesh = mesh;
        const auto run = std::ranges::find(outcome.runs, place, &ValidationRun::place);
        const RunOutcome& found = outcome.outcomes[static_cast<std::size_t>(run - outcome.runs.begin())];
        values.push_back(found.values.at(metric));
        certain = certain && found.certain;
    }
    Estimate result = estimate(values, meshes[0] / meshes[1]);
    result.certain = certain;
    return result;
}

double value_at(const ExperimentOutcome& outcome, const RunPlace& place, const std::string& metric) {
    const auto run = std::ranges::find(outcome.runs, place, &ValidationRun::place);
    return outcome.outcomes[static_cast<std::size_t>(run - outcome.runs.begin())].values.at(metric);
}

}  // namespace

const ValueSeries& ExperimentOutcome::of(const std::string& variant, const std::string& metric) const {
    const auto found = std::ranges::find_if(
        series, [&](const ValueSeries& s) { return s.variant == variant && s.metric == metric; });
    assert(found != series.end());
    return *found;
}

const char* to_text(Verdict verdict) {
    static constexpr const char* texts[] = {"holds", "not resolved", "does not hold"};
    return texts[static_cast<std::size_t>(verdict)];
}

static std::size_t checks_with(const Validation& validation, Verdict verdict) {
    std::size_t count = 0;
    for (const ExperimentOutcome& e : validation.experiments)
        count += static_cast<std::size_t>(std::ranges::count(e.checks, verdict, &CheckOutcome::verdict));
    return count;
}

std::size_t Validation::unresolved_checks() const { return checks_with(*this, Verdict::unresolved); }

std::size_t Validation::failed_checks() const {
    return checks_with(*this, Verdict::fails) + (quick ? 0 : unresolved_checks());
}

std::vector<ValueSeries> value_series(const ExperimentOutcome& outcome) {
    const Experiment& e = outcome.experiment;
    // What was run: meshes coarsest first, values of the sweep with all of these meshes.
    std::vector<double> meshes;
    for (const ValidationRun& run : outcome.runs)
        if (std::ranges::find(meshes, run.place.mesh) == meshes.end()) meshes.push_back(run.place.mesh);
    std::ranges::sort(meshes, std::greater<>());
    std::vector<ValueSeries> list;
    for (std::size_t v = 0; v < e.variants.size(); ++v) {
        for (const MetricSpec& metric : e.metrics) {
            ValueSeries series{.variant = e.variants[v].name, .metric = metric.name};
            for (const ValidationRun& run : outcome.runs) {
                if (run.place.variant != v || run.place.mesh != meshes.back()) continue;
                series.x.push_back(run.place.at);
                series.y.push_back(estimate_at(outcome, run.place, meshes, metric.name));
                const double spread = e.sweep.spread;
                RunPlace off{.variant = v, .at = run.place.at + spread, .mesh = meshes.front()};
                if (spread == 0.0 ||
                    std::ranges::find(outcome.runs, off, &ValidationRun::place) == outcome.runs.end())
                    continue;
                // The change on the coarsest mesh, at the value on the finest.
                const double middle = value_at(
                    outcome, {.variant = v, .at = run.place.at, .mesh = meshes.front()}, metric.name);
                const double above = value_at(outcome, off, metric.name) - middle;
                off.at = run.place.at - spread;
                const double below = value_at(outcome, off, metric.name) - middle;
                series.low.push_back(series.y.back().value + std::min(above, below));
                series.high.push_back(series.y.back().value + std::max(above, below));
            }
            if (!series.x.empty()) list.push_back(std::move(series));
        }
    }
    return list;
}

Validation validate(std::vector<Experiment> experiments, const ValidationOptions& options,
                    const Control& control) {
    const auto begin = Control::Clock::now();
    Validation validation{.quick = options.quick, .jobs = options.jobs > 0 ? options.jobs : thread_count()};
    for (Experiment& e : experiments) {
        std::vector<ValidationRun> runs = expand(e, options.quick, options.program);
        validation.experiments.push_back({.experiment = std::move(e), .runs = std::move(runs)});
    }
    const RunStore store(options.folder);
    const std::vector<OpenRun> open = look_up(validation, store);
    validation.computed = run_all(validation, open, store, control);
    validation.seconds = std::chrono::duration<double>(Control::Clock::now() - begin).count();
    validation.interrupted = validation.computed < open.size();
    if (validation.interrupted) return validation;
    for (ExperimentOutcome& outcome : validation.experiments) {
        outcome.series = value_series(outcome);
        outcome.checks = judge(outcome);
    }
    return validation;
}

}  // namespace ruche

#include <nlohmann/json.hpp>

#include "ruche/study/validation/validation.hpp"

namespace ruche {

namespace {
using ValidationJson = nlohmann::ordered_json;

ValidationJson estimate_json(double x, const Estimate& e) {
    return {{"at", x},
            {"value", e.value},
            {"uncertainty", e.uncertainty},
            {"order", e.order},
            {"extrapolated", e.extrapolated},
            {"on_meshes", e.values},
            {"certain", e.certain}};
}

ValidationJson series_json(const ValueSeries& s) {
    ValidationJson json = {{"variant", s.variant}, {"metric", s.metric}, {"values", ValidationJson::array()}};
    for (std::size_t i = 0; i < s.x.size(); ++i) {
        json["values"].push_back(estimate_json(s.x[i], s.y[i]));
        if (i < s.low.size()) json["values"].back()["spread"] = {s.low[i], s.high[i]};
    }
    return json;
}

ValidationJson outcome_json(const ExperimentOutcome& o) {
    const Experiment& e = o.experiment;
    ValidationJson json = {{"name", e.name}, {"title", e.title}, {"sweep", e.sweep.key}};
    for (const CheckOutcome& c : o.checks)
        json["checks"].push_back({{"says", c.check.says},
                                  {"verdict", to_text(c.verdict)},
                                  {"holds", c.verdict == Verdict::holds},
                                  {"details", c.details}});
    for (const ValueSeries& s : o.series) json["series"].push_back(series_json(s));
    for (std::size_t i = 0; i < o.runs.size(); ++i) {
        const ValidationRun& run = o.runs[i];
        const RunOutcome& r = o.outcomes[i];
        json["runs"].push_back({{"key", run.key},
                                {"variant", e.variants[run.place.variant].name},
                                {"at", run.place.at},
                                {"mesh", run.place.mesh},
                                {"certain", r.certain},
                                {"triangles", r.triangles},
                                {"seconds", r.seconds},
                                {"values", r.values},
                                {"command", run.command}});
    }
    return json;
}
}  // namespace

std::string validation_json(const Validation& v) {
    ValidationJson json = {{"version", RUCHE_VERSION},
                           {"quick", v.quick},
                           {"failed_checks", v.failed_checks()},
                           {"unresolved_checks", v.unresolved_checks()},
                           {"seconds", v.seconds},
                           {"jobs", v.jobs},
                           {"experiments", ValidationJson::array()}};
    for (const ExperimentOutcome& o : v.experiments) json["experiments"].push_back(outcome_json(o));
    return json.dump(1) + "\n";
}

}  // namespace ruche

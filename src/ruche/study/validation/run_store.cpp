#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "ruche/core/atomic_file.hpp"
#include "ruche/core/document.hpp"
#include "ruche/study/validation/validation_run.hpp"

namespace ruche {

namespace {
using RunJson = nlohmann::ordered_json;

/// JSON has no NaN: null.
double number_or_nan(const RunJson& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}
}  // namespace

RunStore::RunStore(std::string folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(std::filesystem::path(folder_) / "runs");
}

std::string RunStore::path(const ValidationRun& run, const char* ending) const {
    return (std::filesystem::path(folder_) / "runs" / (run.key + ending)).string();
}

std::optional<RunOutcome> RunStore::find(const ValidationRun& run) const {
    const std::string file = path(run, ".json");
    if (!std::filesystem::is_regular_file(file)) return std::nullopt;
    try {
        const RunJson json = RunJson::parse(read_file(file, "outcome of a run", 1U << 20U));
        RunOutcome outcome{.certain = json.at("certain"),
                           .message = json.at("message"),
                           .warnings = json.at("warnings"),
                           .triangles = json.at("triangles"),
                           .seconds = json.at("seconds")};
        for (const auto& [name, value] : json.at("values").items())
            outcome.values[name] = number_or_nan(value);
        if (!run.picture_title.empty()) outcome.picture = read_file(path(run, ".png"), "picture", 64U << 20U);
        return outcome;
    } catch (const RunJson::exception&) {
        return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

void RunStore::keep(const ValidationRun& run, const RunOutcome& outcome) const {
    const RunJson json = {{"certain", outcome.certain},   {"message", outcome.message},
                          {"warnings", outcome.warnings}, {"triangles", outcome.triangles},
                          {"seconds", outcome.seconds},   {"command", run.command},
                          {"values", outcome.values}};
    // The picture first: where the numbers are, everything is.
    if (!run.picture_title.empty()) write_file_atomically(path(run, ".png"), outcome.picture);
    write_file_atomically(path(run, ".json"), json.dump(1) + "\n");
}

}  // namespace ruche

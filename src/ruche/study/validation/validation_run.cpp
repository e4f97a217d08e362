#include "ruche/study/validation/validation_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "ruche/core/document.hpp"
#include "ruche/core/table_reader.hpp"
#include "ruche/output/picture.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"
#include "ruche/scene/write_scene.hpp"
#include "ruche/study/validation/run_measures.hpp"

namespace ruche {
namespace {

namespace fs = std::filesystem;

bool is_of_sample(const std::string& path) { return path.starts_with("pull.") || path.starts_with("hang."); }

/// FNV-1a, 64 bits: a name for a text, not a protection against anybody.
class TextKey {
  public:
    void add(std::string_view text) {
        for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
        value_ = (value_ ^ 0xffU) * 0x100000001b3ULL;  // where a text ends matters
    }
    std::string hex() const { return fmt::format("{:016x}", value_); }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

template <class Struct>
void add_fields(TextKey& key, const Struct& s) {
    for (const Field<Struct>& field : fields<Struct>()) key.add(to_string(get(s, field)));
}

std::string key_of(const ValidationRun& run, const Experiment& experiment, const std::string& program) {
    TextKey key;
    key.add(program);
    key.add(to_toml(run.scene));
    for (const std::string& file : pattern_files(run.scene)) {
        const std::string path = resolved_path(run.scene, file);
        if (fs::is_regular_file(path)) key.add(read_file(path, "drawing", 1U << 30U));
    }
    if (run.pull) add_fields(key, *run.pull);
    if (run.hang) add_fields(key, *run.hang);
    for (const MetricSpec& metric : experiment.metrics) add_fields(key, metric);
    key.add(run.picture_title);
    return key.hex();
}

/// All element sizes by one factor.
void scale(MeshOptions& mesh, double factor) {
    mesh.size_mm *= factor;
    mesh.fabric_size_mm *= factor;
    mesh.grading *= factor;
    mesh.elements_across /= factor;
}

/// A sample with the values that `changes` give to its table.
template <class Sample>
Sample changed(Sample sample, const char* name, const std::vector<Override>& changes) {
    Node root;
    apply_overrides(root, changes);
    TableReader reader(root, "");
    if (const Node* node = reader.take_table(name)) {
        TableReader table(*node, name);
        table.read(sample);
        table.finish();
    }
    return sample;
}

ValidationRun planned(const Experiment& e, const RunPlace& place) {
    const VariantSpec& variant = e.variants[place.variant];
    std::vector<Override> of_scene;
    std::vector<Override> of_sample;
    const auto change = [&](const std::string& text) {
        const Override o = parse_override(text);
        (is_of_sample(o.path) ? of_sample : of_scene).push_back(o);
    };
    for (const std::string& text : variant.set) change(text);
    if (!e.sweep.key.empty()) change(fmt::format("{}={}", e.sweep.key, place.at));

    const std::string file =
        (fs::path(e.file).parent_path() / (variant.scene.empty() ? e.scene : variant.scene)).string();
    ValidationRun run{.place = place, .scene = read_scene(file, of_scene)};
    run.scene.solver.threads = 0;  // how many there are is the caller's business
    if (e.pull) {
        run.pull = changed(*e.pull, "pull", of_sample);
        run.pull->element_size_mm *= place.mesh;
    } else if (e.hang) {
        run.hang = changed(*e.hang, "hang", of_sample);
        run.hang->columns = static_cast<int>(std::lround(run.hang->columns / place.mesh));
    }
    if (run.pull || run.hang) {
        run.command = fmt::format("ruche validate {}", e.name);
        return run;
    }
    scale(run.scene.mesh, e.nested ? e.meshes.front() : place.mesh);
    if (e.nested)
        run.scene.mesh.subdivisions = static_cast<int>(std::lround(std::log2(e.meshes.front() / place.mesh)));
    run.command = "ruche simulate " + file;
    for (const Override& o : of_scene) run.command += fmt::format(" --set '{}={}'", o.path, o.value);
    if (place.mesh != 1.0 || e.nested)
        for (const Field<MeshOptions>& field : fields<MeshOptions>())
            run.command += fmt::format(" --set mesh.{}={}", field.key, to_string(get(run.scene.mesh, field)));
    return run;
}

}  // namespace

/// Those metrics that are told as shares of another one.
static void divide(std::map<std::string, double>& values, const std::vector<MetricSpec>& metrics) {
    const std::map<std::string, double> whole = values;
    for (const MetricSpec& metric : metrics)
        if (!metric.over.empty()) values.at(metric.name) /= whole.at(metric.over);
}

std::vector<ValidationRun> expand(const Experiment& e, bool quick, const std::string& program) {
    const std::vector<double>& meshes = quick ? e.quick_meshes : e.meshes;
    std::vector<double> sweep = quick ? e.sweep.quick : e.sweep.values;
    if (sweep.empty()) sweep = {0.0};
    std::vector<ValidationRun> runs;
    for (std::size_t v = 0; v < e.variants.size(); ++v) {
        if (quick && !e.variants[v].quick) continue;
        for (const double at : sweep) {
            for (const double mesh : meshes) {
                runs.push_back(planned(e, {v, at, mesh}));
                for (const PictureSpec& picture : e.pictures)
                    if (!quick && mesh == meshes.back() && picture.variant == e.variants[v].name &&
                        (e.sweep.key.empty() || picture.at == at))
                        runs.back().picture_title = picture.title.empty() ? e.title : picture.title;
            }
            if (e.sweep.spread > 0.0 && !quick)
                for (const double off : {at - e.sweep.spread, at + e.sweep.spread})
                    runs.push_back(planned(e, {v, off, meshes.front()}));
        }
    }
    for (ValidationRun& run : runs) run.key = key_of(run, e, program);
    return runs;
}

std::optional<RunOutcome> compute(const ValidationRun& run, const Experiment& experiment,
                                  const Control& control) {
    const auto begin = Control::Clock::now();
    RunOutcome outcome;
    if (run.pull) {
        outcome = pull_sample(run, experiment);
    } else if (run.hang) {
        outcome = hang_sample(run, experiment);
    } else {
        const Result result = simulate(run.scene, control);
        const Equilibrium& end = result.equilibrium;
        if (end.status == SolveStatus::interrupted) return std::nullopt;
        outcome.certain = end.status == SolveStatus::converged && end.stable;
        outcome.message = end.message;
        outcome.warnings = result.warnings;
        outcome.triangles = result.layout.mesh.triangle_count();
        for (const MetricSpec& metric : experiment.metrics)
            outcome.values[metric.name] = measured(metric, result);
        if (!run.picture_title.empty())
            outcome.picture =
                to_png(draw_picture(result, {.width_px = 960, .height_px = 480, .title = run.picture_title}));
    }
    divide(outcome.values, experiment.metrics);
    outcome.seconds = std::chrono::duration<double>(Control::Clock::now() - begin).count();
    return outcome;
}

}  // namespace ruche

#include "ruche/study/validation/experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ruche/core/suggest.hpp"
#include "ruche/core/table_reader.hpp"
#include "ruche/core/text_scan.hpp"

namespace ruche {
namespace {

namespace fs = std::filesystem;

template <class Spec>
const Spec* spec_named(const std::vector<Spec>& list, const std::string& wanted) {
    const auto found = std::ranges::find(list, wanted, &Spec::name);
    return found == list.end() ? nullptr : &*found;
}

/// The entries of a list, each read by `read_item(item, path)`; nothing where the key is not there.
template <class Value, class ReadItem>
std::vector<Value> node_list(TableReader& reader, std::string_view key, const char* expected,
                             const ReadItem& read_item) {
    const Node* node = reader.take(key);
    if (node == nullptr) return {};
    const std::string path = reader.path_of(key);
    if (node->kind != Node::Kind::array)
        throw InputError(place_of(*node, path),
                         fmt::format("expected {}, found {}", expected, describe(*node)));
    std::vector<Value> values;
    values.reserve(node->items.size());
    for (const Node& item : node->items) values.push_back(std::get<Value>(read_item(item, path)));
    return values;
}

std::vector<double> number_list(TableReader& reader, std::string_view key) {
    return node_list<double>(reader, key, "a list of numbers", [](const Node& item, const std::string& path) {
        return read_value(item, {.key = "", .kind = FieldKind::number}, path);
    });
}

std::vector<std::string> text_list(TableReader& reader, std::string_view key) {
    return node_list<std::string>(reader, key, "a list of texts",
                                  [](const Node& item, const std::string& path) {
                                      return read_value(item, {.key = "", .kind = FieldKind::text}, path);
                                  });
}

/// Reads each table of a list; `rest(reader, spec)` reads what is in no table of fields.
template <class Spec, class Rest>
std::vector<Spec> specs_of(TableReader& reader, const char* key, const Rest& rest) {
    std::vector<Spec> specs;
    for (const Node* node : reader.take_tables(key)) {
        TableReader table(*node, fmt::format("{}.{}", key, specs.size() + 1));
        Spec spec;
        table.read(spec);
        rest(table, spec);
        table.finish();
        specs.push_back(std::move(spec));
    }
    return specs;
}

/// Refuses a name that is none of `list`.
template <class Spec>
void require_named(const std::vector<Spec>& list, const std::string& wanted, const Place& place,
                   const char* what) {
    if (spec_named(list, wanted) != nullptr) return;
    std::vector<std::string_view> names;
    names.reserve(list.size());
    for (const Spec& spec : list) names.push_back(spec.name);
    throw InputError(place, fmt::format("there is no {} \"{}\"{}", what, wanted, did_you_mean(wanted, names)),
                     fmt::format("There are {}.", fmt::join(names, ", ")));
}

template <class Sample>
void read_sample(TableReader& reader, const char* key, std::optional<Sample>& sample) {
    const Node* node = reader.take_table(key);
    if (node == nullptr) return;
    TableReader table(*node, key);
    table.read(sample.emplace());
    table.finish();
}

/// Those of the file that `variants_from` names, then the experiment's own.
void read_variants(TableReader& reader, Experiment& e) {
    const auto rest = [](TableReader& table, VariantSpec& v) { v.set = text_list(table, "set"); };
    if (!e.variants_from.empty()) {
        const Node root = read_toml((fs::path(e.file).parent_path() / e.variants_from).string());
        TableReader shared(root, "");
        e.variants = specs_of<VariantSpec>(shared, "variant", rest);
        shared.finish();
    }
    for (VariantSpec& own : specs_of<VariantSpec>(reader, "variant", rest))
        e.variants.push_back(std::move(own));
}

void read_curve(ReferenceCurve& curve, const Experiment& experiment, const Place& place) {
    const std::string path = (fs::path(experiment.file).parent_path() / curve.file).string();
    const std::string text = read_file(path, "reference curve", 1U << 20U);
    for (TextScan scan(text); !scan.at_end();) {
        const std::string_view line = scan.take_line();
        const std::size_t comma = line.find(',');
        double x = 0.0;
        double y = 0.0;
        if (line.empty() || line.front() == '#' || scan.line() == 1) continue;
        if (comma == std::string_view::npos || !read_number(line.substr(0, comma), x) ||
            !read_number(line.substr(comma + 1), y))
            throw InputError({.file = path, .line = scan.line()},
                             fmt::format("\"{}\" is not \"x,y\"", line.substr(0, 60)));
        curve.x.push_back(x);
        curve.y.push_back(y);
    }
    if (curve.x.empty()) throw InputError(place, fmt::format("{} holds no values", path));
}

void require_factor(const std::vector<double>& meshes, const Place& place) {
    for (std::size_t i = 1; i < meshes.size(); ++i) {
        const double factor = meshes[i - 1] / meshes[i];
        if (meshes[i] > 0.0 && factor > 1.2 && std::abs(factor - meshes[0] / meshes[1]) < 1e-6) continue;
        throw InputError(place, "is no list of element sizes that fall by one factor",
                         "For example meshes = [1, 0.5, 0.25].");
    }
    if (meshes.size() < 2)
        throw InputError(place, "has fewer than two meshes", "One mesh says nothing about its own error.");
}

/// Each a half of the one before, from the first of `meshes` on.
void require_halves(const Experiment& e, const Place& place) {
    for (const std::vector<double>* meshes : {&e.meshes, &e.quick_meshes})
        for (const double mesh : *meshes) {
            const double halves = std::log2(e.meshes.front() / mesh);
            if (halves >= 0.0 && halves <= 6.0 && std::abs(halves - std::round(halves)) < 1e-6) continue;
            throw InputError(place, fmt::format("{:g} is not a half, quarter, ... of the first mesh", mesh),
                             "For example meshes = [1, 0.5, 0.25]; quick_meshes are of the same kind.");
        }
}

/// What the parts of an experiment say about each other.
void check_names(const Experiment& e) {
    const Place place{.file = e.file};
    const auto at = [&](const char* list, std::size_t i, const char* key) {
        return Place{.file = e.file, .key = fmt::format("{}.{}.{}", list, i + 1, key)};
    };
    if (e.metrics.empty()) throw InputError(place, "has no [[metric]]");
    if (e.checks.empty()) throw InputError(place, "has no [[check]]", "What must it show?");
    for (std::size_t i = 0; i < e.checks.size(); ++i) {
        const CheckSpec& c = e.checks[i];
        require_named(e.metrics, c.metric, at("check", i, "metric"), "metric");
        for (const std::string& name : c.variants)
            require_named(e.variants, name, at("check", i, "variants"), "variant");
        if (!c.other_variant.empty())
            require_named(e.variants, c.other_variant, at("check", i, "other_variant"), "variant");
        if (!c.other_metric.empty())
            require_named(e.metrics, c.other_metric, at("check", i, "other_metric"), "metric");
        if (c.kind == CheckKind::within && e.reference(c.reference) == nullptr)
            require_named(e.metrics, c.reference, at("check", i, "reference"), "metric or reference");
        const bool compares = c.kind == CheckKind::exceeds || c.kind == CheckKind::ratio;
        if (compares && c.other_variant.empty() && c.other_metric.empty())
            throw InputError(at("check", i, "kind"), "compares with nothing",
                             "Name an other_variant or an other_metric.");
    }
    for (std::size_t i = 0; i < e.metrics.size(); ++i)
        if (!e.metrics[i].over.empty())
            require_named(e.metrics, e.metrics[i].over, at("metric", i, "over"), "metric");
    for (std::size_t i = 0; i < e.pictures.size(); ++i)
        require_named(e.variants, e.pictures[i].variant, at("picture", i, "variant"), "variant");
}

}  // namespace

const MetricSpec* Experiment::metric(const std::string& wanted) const { return spec_named(metrics, wanted); }
const VariantSpec* Experiment::variant(const std::string& wanted) const {
    return spec_named(variants, wanted);
}
const ReferenceCurve* Experiment::reference(const std::string& wanted) const {
    return spec_named(references, wanted);
}

Experiment read_experiment(const std::string& folder) {
    Experiment e;
    e.name = fs::path(folder).filename().string();
    e.file = (fs::path(folder) / "experiment.toml").string();
    const Node root = read_toml(e.file);
    TableReader reader(root, "");
    reader.read(e);
    const auto nothing = [](TableReader&, const auto&) {};
    read_sample(reader, "pull", e.pull);
    read_sample(reader, "hang", e.hang);
    if (e.pull && e.hang)
        throw InputError(reader.place_of_key("hang"), "stands beside a [pull]", "A run is one or the other.");
    if (reader.has("meshes")) e.meshes = number_list(reader, "meshes");
    require_factor(e.meshes, reader.place_of_key("meshes"));
    e.quick_meshes = number_list(reader, "quick_meshes");
    if (e.quick_meshes.empty()) e.quick_meshes = {e.meshes[0], e.meshes[1]};
    require_factor(e.quick_meshes, reader.place_of_key("quick_meshes"));
    if (e.nested) require_halves(e, reader.place_of_key("nested"));
    if (const Node* node = reader.take_table("sweep")) {
        TableReader table(*node, "sweep");
        table.read(e.sweep);
        e.sweep.values = number_list(table, "values");
        e.sweep.quick = number_list(table, "quick");
        if (e.sweep.quick.empty()) e.sweep.quick = e.sweep.values;
        table.finish();
        if (e.sweep.key.empty() || e.sweep.values.empty())
            throw InputError(place_of(*node, "sweep"), "needs a key and values");
    }
    read_variants(reader, e);
    if (e.variants.empty()) e.variants.push_back({.name = "as the scene"});
    e.metrics = specs_of<MetricSpec>(reader, "metric", nothing);
    e.references = specs_of<ReferenceCurve>(reader, "reference", nothing);
    for (ReferenceCurve& curve : e.references) read_curve(curve, e, reader.place_of_key("reference"));
    e.pictures = specs_of<PictureSpec>(reader, "picture", nothing);
    e.checks = specs_of<CheckSpec>(
        reader, "check", [](TableReader& table, CheckSpec& c) { c.variants = text_list(table, "variants"); });
    reader.finish();
    check_names(e);
    return e;
}

std::vector<std::string> experiment_names(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        if (fs::exists(entry.path() / "experiment.toml")) names.push_back(entry.path().filename().string());
    if (error || names.empty())
        throw InputError({.file = folder}, "holds no experiments",
                         "Experiments are folders with an experiment.toml; --experiments names the folder "
                         "that they are in. They come with the program's source, in validation/.");
    std::ranges::sort(names);
    return names;
}

}  // namespace ruche

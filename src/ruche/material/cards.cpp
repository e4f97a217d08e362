#include "ruche/material/cards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/suggest.hpp"
#include "ruche/core/table_reader.hpp"
#include "ruche/material/presets.hpp"

namespace ruche {

/// What a card says about itself, and about each value.
namespace {
struct Title {
    std::string name;
    std::string description;
};
struct Calibration {
    double prestretch = 1.0;
};
struct Provenance {
    std::string source;
};
}  // namespace

template <>
std::span<const Field<Title>> fields<Title>() {
    static const Field<Title> table[] = {
        {"name", &Title::name, "", -infinity, infinity, "Name of the card."},
        {"description", &Title::description, "", -infinity, infinity,
         "Which fabric and plastic it describes."},
    };
    return table;
}

template <>
std::span<const Field<Calibration>> fields<Calibration>() {
    static const Field<Calibration> table[] = {
        {"prestretch", &Calibration::prestretch, "", 1, 3,
         "Pre-stretch at which these values were measured or fitted."},
    };
    return table;
}

template <>
std::span<const Field<Provenance>> fields<Provenance>() {
    static const Field<Provenance> table[] = {
        {"source", &Provenance::source, "", -infinity, infinity,
         "Where the value is from: \"measured ...\", a publication, \"assumed: ...\"."},
    };
    return table;
}

std::vector<std::string> preset_names() {
    std::vector<std::string> names;
    for (const Preset& preset : presets()) names.emplace_back(preset.name);
    return names;
}

std::string preset_text(const std::string& name) {
    std::vector<std::string_view> names;
    for (const Preset& preset : presets()) {
        if (preset.name == name) return std::string(preset.text);
        names.push_back(preset.name);
    }
    throw InputError({}, fmt::format("there is no material card \"{}\"{}", name, did_you_mean(name, names)),
                     "`ruche cards` lists them; a card file of your own is given as a path ending in .toml.");
}

static std::vector<std::string> take_texts(TableReader& reader, std::string_view key) {
    std::vector<std::string> texts;
    const Node* node = reader.take(key);
    if (node == nullptr) return texts;
    bool only_texts = node->kind == Node::Kind::array;
    for (const Node& item : node->items) {
        only_texts = only_texts && item.kind == Node::Kind::text;
        texts.push_back(item.text);
    }
    if (!only_texts)
        throw InputError(place_of(*node, reader.path_of(key)),
                         "expected a list of texts in quotes, found " + describe(*node));
    return texts;
}

static CardValue read_card_value(const Node& node, const FieldInfo& field, const std::string& path) {
    if (node.kind != Node::Kind::table)
        throw InputError(place_of(node, path),
                         "expected { value = ..., source = \"...\" }, found " + describe(node),
                         "Every value of a card says where it is from.");
    TableReader reader(node, path);
    CardValue result;
    if (const Node* value = reader.take("value"))
        result.value = std::get<double>(read_value(*value, field, reader.path_of("value")));
    else
        throw InputError(place_of(node, path), "has no value", std::string(field.meaning));
    Provenance provenance;
    reader.read(provenance);
    if (provenance.source.empty())
        throw InputError(place_of(node, path), "has no source",
                         "Every value of a card says where it is from: source = \"measured ...\".");
    result.source = provenance.source;
    if (const Node* interval = reader.take("interval")) {
        FieldInfo pair = field;
        pair.kind = FieldKind::two_numbers;
        const std::string key = reader.path_of("interval");
        const auto ends = std::get<std::array<double, 2>>(read_value(*interval, pair, key));
        if (!(ends[0] <= result.value && result.value <= ends[1]))
            throw InputError(place_of(*interval, key), fmt::format("[{}, {}] does not contain the value {}",
                                                                   ends[0], ends[1], result.value));
        result.interval = ends;
    }
    result.files = take_texts(reader, "files");
    reader.finish();
    return result;
}

/// Values for every pre-stretch stand in [common], those of one calibration in its [[set]].
static void read_values(TableReader& reader, CardSet& set) {
    for (const Field<Material>& field : fields<Material>()) {
        const FieldInfo about = info(field);
        if (const Node* node = reader.take(about.key))
            set.values[std::string(bare_name(about))] =
                read_card_value(*node, about, reader.path_of(about.key));
    }
}

static void check_complete(const CardSet& set, const Place& place) {
    for (const Field<Material>& field : fields<Material>())
        if (!set.values.contains(std::string(bare_name(info(field)))))
            throw InputError(place, fmt::format("has no {}", field.key),
                             "A card gives every value, in each [[set]] or once in [common].");
}

static MaterialCard parse_card(const Node& root) {
    TableReader reader(root, "");
    Title title;
    reader.read(title);
    MaterialCard card{.name = title.name, .description = title.description};
    card.warnings = take_texts(reader, "warnings");
    if (const Node* node = reader.take("printed_thickness_mm"))
        card.printed_thickness = read_card_value(*node,
                                                 {.key = "printed_thickness_mm",
                                                  .unit = "mm",
                                                  .low = 1e-3,
                                                  .high = 20,
                                                  .meaning = "Measured thickness of the printed plastic."},
                                                 "printed_thickness_mm");
    CardSet common;
    if (const Node* node = reader.take_table("common")) {
        TableReader values(*node, "common");
        read_values(values, common);
        values.finish();
    }
    for (const Node* node : reader.take_tables("set")) {
        TableReader values(*node, fmt::format("set.{}", card.sets.size() + 1));
        Calibration calibration;
        values.read(calibration);
        if (!values.has("prestretch"))
            throw InputError(values.place_of_key("prestretch"), "missing",
                             "Each [[set]] says at which pre-stretch its values were found.");
        CardSet set = common;
        set.prestretch = calibration.prestretch;
        read_values(values, set);
        values.finish();
        if (!card.sets.empty() && set.prestretch <= card.sets.back().prestretch)
            throw InputError(values.place_of_key("prestretch"),
                             "the pre-stretches of the sets must increase");
        check_complete(set, place_of(*node, fmt::format("set.{}", card.sets.size() + 1)));
        card.sets.push_back(set);
    }
    reader.finish();
    if (card.sets.empty())
        throw InputError(place_of(root, ""), "is not a material card: it has no [[set]]",
                         "`ruche cards spandex-tpu95a` prints a card to start from.");
    return card;
}

bool is_card_path(std::string_view name_or_path) {
    return name_or_path.ends_with(".toml") || name_or_path.find('/') != std::string_view::npos;
}

MaterialCard load_card(const std::string& name_or_path) {
    const Node root = is_card_path(name_or_path)
                          ? read_toml(name_or_path)
                          : parse_toml(preset_text(name_or_path), "card " + name_or_path);
    MaterialCard card = parse_card(root);
    if (card.name.empty()) card.name = name_or_path;
    return card;
}

/// Two sets around `s` and the weight of the second; the same set twice at and beyond the ends.
struct Bracket {
    const CardSet* low;
    const CardSet* high;
    double weight;
};

static Bracket bracket(const std::vector<CardSet>& sets, double s) {
    const auto above =
        std::find_if(sets.begin(), sets.end(), [&](const CardSet& c) { return c.prestretch >= s; });
    if (above == sets.end()) return {&sets.back(), &sets.back(), 0.0};
    if (above->prestretch == s) return {&*above, &*above, 0.0};
    if (above == sets.begin()) return {&sets.front(), &sets.front(), 0.0};
    const auto below = above - 1;
    return {&*below, &*above, (s - below->prestretch) / (above->prestretch - below->prestretch)};
}

static std::vector<std::string> range_warnings(const MaterialCard& card, double s) {
    const double low = card.sets.front().prestretch;
    const double high = card.sets.back().prestretch;
    constexpr double slack = 0.03;  // the fabric on a frame is not stretched more exactly than this
    if (s > low * (1 - slack) && s < high * (1 + slack)) return {};
    const std::string range = card.sets.size() == 1 ? fmt::format("at a pre-stretch of {} only", low)
                                                    : fmt::format("for pre-stretches of {} to {}", low, high);
    return {fmt::format("card {} was calibrated {}; at {:.4g} its values are a guess", card.name, range, s)};
}

ResolvedCard resolve_card(const MaterialCard& card, const std::array<double, 2>& prestretch) {
    const double s = std::sqrt(prestretch[0] * prestretch[1]);
    const auto [low, high, weight] = bracket(card.sets, s);
    ResolvedCard result{.name = card.name, .warnings = range_warnings(card, s)};
    for (const std::string& warning : card.warnings)
        result.warnings.push_back(fmt::format("card {}: {}", card.name, warning));
    for (const Field<Material>& field : fields<Material>()) {
        const std::string name(bare_name(info(field)));
        const CardValue& a = low->values.at(name);
        const CardValue& b = high->values.at(name);
        set(result.material, field, a.value + weight * (b.value - a.value));
        result.sources[name] =
            a.source == b.source ? a.source : fmt::format("{} and {}, interpolated", a.source, b.source);
        if (a.value != b.value) result.sources[name] += fmt::format(" (between {} and {})", a.value, b.value);
    }
    return result;
}

ResolvedCard resolve_card(const std::string& name_or_path, const std::array<double, 2>& prestretch) {
    return resolve_card(load_card(name_or_path), prestretch);
}

void check_prestretch(const Material& material, const std::array<double, 2>& prestretch, const Place& place) {
    const std::array<double, 2> gamma = {material.gamma_1, material.gamma_2};
    for (std::size_t i = 0; i < 2; ++i) {
        const double limit = std::sqrt(1.0 + 2.0 * gamma[i]);
        if (prestretch[i] < limit) continue;
        throw InputError(
            place,
            fmt::format("{} is beyond the fabric's law, which ends at {:.4f} along its {} axis",
                        prestretch[i], limit, i == 0 ? "first" : "second"),
            fmt::format(
                "The fabric locks at Green strain gamma_{} = {}, a stretch of sqrt(1 + 2 gamma) = {:.4f}. "
                "Stretch less, or use a card that was calibrated at this stretch.",
                i + 1, gamma[i], limit));
    }
}

std::vector<std::string> assumed_values(const Material& material,
                                        const std::map<std::string, std::string>& sources) {
    std::vector<std::string> texts;
    for (const Field<Material>& field : fields<Material>()) {
        const std::string name(bare_name(info(field)));
        const auto source = sources.find(name);
        if (source == sources.end() || source->second.find("assumed") == std::string::npos) continue;
        texts.push_back(fmt::format("{} = {}{}{} ({})", name, to_string(get(material, field)),
                                    field.unit.empty() ? "" : " ", field.unit, source->second));
    }
    return texts;
}

}  // namespace ruche

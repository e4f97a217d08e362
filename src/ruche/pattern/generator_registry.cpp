#include "ruche/pattern/generator_registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ruche/core/suggest.hpp"
#include "ruche/core/text_scan.hpp"
#include "ruche/pattern/generators.hpp"

namespace ruche {
namespace {

using Options = std::map<std::string, std::string>;

template <class Number>
Number number_from(const std::string& text, const Place& place, const char* expected) {
    Number number{};
    if (!read_number(text, number))
        throw InputError(place, fmt::format("\"{}\" is not {}", text, expected),
                         text.find(',') != std::string::npos ? "Write decimals with a point." : "");
    return number;
}

FieldValue read_value(const std::string& text, const FieldInfo& field, const Place& place) {
    switch (field.kind) {
        case FieldKind::number:
            return number_from<double>(text, place, "a number");
        case FieldKind::integer:
            return number_from<int>(text, place, "a whole number");
        case FieldKind::boolean:
            if (text == "true") return true;
            if (text == "false") return false;
            throw InputError(place, fmt::format("\"{}\" is neither true nor false", text),
                             std::string(field.meaning));
        default:
            return text;
    }
}

Place at_option(Place place, std::string_view key) {
    place.key += (place.key.empty() ? "" : ".") + std::string(key);
    return place;
}

template <class Struct>
void read_options(Struct& s, const Options& options, const Place& place) {
    std::vector<std::string_view> keys;
    for (const Field<Struct>& field : fields<Struct>()) keys.push_back(field.key);
    for (const auto& [key, text] : options) {
        const Place here = at_option(place, key);
        bool known = false;
        for (const Field<Struct>& field : fields<Struct>()) {
            if (field.key != key) continue;
            known = true;
            const FieldValue value = read_value(text, info(field), here);
            check(info(field), value, here);
            set(s, field, value);
        }
        if (!known)
            throw InputError(here, "unknown option" + did_you_mean(key, keys),
                             fmt::format("This generator has {}.", fmt::join(keys, ", ")));
    }
}

template <class Struct>
std::vector<GeneratorOption> describe_options() {
    std::vector<GeneratorOption> result;
    const Struct defaults;
    for (const Field<Struct>& field : fields<Struct>()) {
        const FieldInfo about = info(field);
        std::string range = about.kind == FieldKind::choice ? fmt::format("{}", fmt::join(about.names, " | "))
                            : about.kind == FieldKind::boolean ? "true | false"
                                                               : range_text(about);
        result.push_back({std::string(about.key), to_string(get(defaults, field)), std::string(about.unit),
                          std::move(range), std::string(about.meaning), about});
    }
    return result;
}

template <class Struct>
std::string written_out(const Struct& s) {
    std::string text;
    for (const Field<Struct>& field : fields<Struct>())
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", field.key, to_string(get(s, field)));
    return text;
}

struct Generator {
    std::string_view name;
    std::string_view summary;
    std::vector<GeneratorOption> (*options)();
    GeneratedPattern (*run)(const Options&, const Place&);
};

template <class Struct, GeneratedPattern (*make)(const Struct&)>
Generator generator(std::string_view name, std::string_view summary) {
    return {name, summary, &describe_options<Struct>, [](const Options& options, const Place& place) {
                Struct s;
                read_options(s, options, place);
                try {
                    GeneratedPattern result = make(s);
                    result.description = written_out(s);
                    return result;
                } catch (const InputError& error) {
                    if (!error.place().file.empty()) throw;  // in a file that the options name
                    throw InputError(at_option(place, error.place().key), error.problem(), error.advice());
                }
            }};
}

const std::vector<Generator>& table() {
    static const std::vector<Generator> all = {
        generator<SingleStripOptions, generate_strip>("strip", "One straight strip."),
        generator<StaggeredStripsOptions, generate_staggered>(
            "staggered", "Parallel strips in rows shifted by half a period; rolls into a cylinder."),
        generator<RadialStripsOptions, generate_radial>(
            "radial", "Radial strips on an annulus, more of them outward; makes a half torus or a bell."),
        generator<StarTilingOptions, generate_stars>(
            "stars", "3-pointed stars on a hexagonal tiling of a disc; makes a dome."),
        generator<HexagonTilingOptions, generate_hexagons>(
            "hexagons", "Hexagons, outlined or filled, with gaps, on a disc."),
        generator<TracedStripsOptions, generate_traced>(
            "traced", "Locally parallel strips along a direction field on a disc or annulus."),
        generator<CurveNetworkOptions, generate_curves>("curves",
                                                        "A network of curves given as points in a file."),
    };
    return all;
}

}  // namespace

std::vector<GeneratorInfo> generators() {
    std::vector<GeneratorInfo> result;
    for (const Generator& g : table())
        result.push_back({std::string(g.name), std::string(g.summary), g.options()});
    return result;
}

std::vector<std::string> generator_names() {
    std::vector<std::string> names;
    for (const Generator& g : table()) names.emplace_back(g.name);
    return names;
}

GeneratedPattern generate(std::string_view name, const Options& options, const Place& place) {
    std::vector<std::string_view> names;
    for (const Generator& g : table()) {
        names.push_back(g.name);
        if (g.name != name) continue;
        GeneratedPattern result = g.run(options, place);
        result.name = g.name;
        return result;
    }
    throw InputError(at_option(place, "generator"),
                     fmt::format("there is no generator \"{}\"{}", name, did_you_mean(name, names)),
                     fmt::format("There are {}.", fmt::join(names, ", ")));
}

}  // namespace ruche

#include "ruche/output/colour_field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"
#include "ruche/core/suggest.hpp"

namespace ruche {
namespace {

struct Definition {
    const char* name;
    const char* label;
    const char* unit;
    ColourMap map;
    double (*value)(const Result& result, const SurfaceFields& fields, std::size_t triangle);
};

using R = Result;
using F = SurfaceFields;
constexpr Definition definitions[] = {
    {"thickness_mm", "print thickness", "mm", ColourMap::sequential,
     [](const R&, const F& f, std::size_t t) { return f.front_mm[t] + f.back_mm[t]; }},
    {"stretch_max", "largest stretch", "", ColourMap::sequential,
     [](const R&, const F& f, std::size_t t) { return f.stretch_max[t]; }},
    {"stretch_min", "smallest stretch", "", ColourMap::sequential,
     [](const R&, const F& f, std::size_t t) { return f.stretch_min[t]; }},
    {"curvature_max_per_mm", "largest curvature", "/mm", ColourMap::diverging,
     [](const R&, const F& f, std::size_t t) { return f.face_curvature[t].max; }},
    {"curvature_min_per_mm", "smallest curvature", "/mm", ColourMap::diverging,
     [](const R&, const F& f, std::size_t t) { return f.face_curvature[t].min; }},
    {"mean_curvature_per_mm", "mean curvature", "/mm", ColourMap::diverging,
     [](const R&, const F& f, std::size_t t) { return f.face_curvature[t].mean(); }},
    {"gauss_curvature_per_mm2", "Gauss curvature", "/mm^2", ColourMap::diverging,
     [](const R&, const F& f, std::size_t t) { return f.face_curvature[t].gauss(); }},
    {"energy_density_mJ_per_mm2", "energy density", "mJ/mm^2", ColourMap::sequential,
     [](const R& r, const F&, std::size_t t) {
         return r.energy_density.empty() ? NAN : r.energy_density[t];
     }},
};

void set_range(ColourField& field) {
    std::vector<double> sorted;
    for (const double v : field.values)
        if (std::isfinite(v)) sorted.push_back(v);
    if (sorted.empty()) return;
    std::sort(sorted.begin(), sorted.end());
    const auto last = static_cast<double>(sorted.size() - 1);
    field.from = sorted[static_cast<std::size_t>(0.01 * last)];
    field.to = sorted[static_cast<std::size_t>(std::ceil(0.99 * last))];
    if (field.map == ColourMap::diverging) {
        field.to = std::max({std::abs(field.from), std::abs(field.to), 1e-9});
        field.from = -field.to;
    }
    if (!(field.to - field.from > 1e-9 * std::abs(field.to))) {  // the same everywhere
        field.from -= 5e-4;
        field.to += 5e-4;
    }
}

}  // namespace

std::vector<std::string> colour_field_names() {
    std::vector<std::string> names;
    for (const Definition& d : definitions) names.emplace_back(d.name);
    return names;
}

ColourField colour_field(std::string_view name, const Result& result, const SurfaceFields& fields) {
    const auto* const found = std::find_if(std::begin(definitions), std::end(definitions),
                                           [&](const auto& d) { return d.name == name; });
    if (found == std::end(definitions)) {
        const std::vector<std::string> names = colour_field_names();
        throw InputError({.key = "--colour"},
                         fmt::format("\"{}\" is none of {}{}", name, fmt::join(names, ", "),
                                     did_you_mean(name, {names.begin(), names.end()})));
    }
    ColourField field{.label = found->label, .unit = found->unit, .map = found->map};
    for (std::size_t t = 0; t < result.layout.mesh.triangles.size(); ++t)
        field.values.push_back(found->value(result, fields, t));
    set_range(field);
    return field;
}

}  // namespace ruche

#include "ruche/study/calibration/card_values.hpp"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "ruche/core/document.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

const Field<Material>& field_of(double Material::*member) {
    for (const Field<Material>& field : fields<Material>()) {
        const auto* found = std::get_if<double Material::*>(&field.member);
        if (found != nullptr && *found == member) return field;
    }
    throw std::logic_error("not a field of Material");
}

std::string name_of(double Material::*member) { return std::string(bare_name(info(field_of(member)))); }

void put(CardSet& set, double Material::*member, CardValue value) {
    // An interval must hold the value and lie in the field's range.
    const Field<Material>& field = field_of(member);
    if (value.interval) {
        auto& [low, high] = *value.interval;
        low = std::clamp(low, field.low, value.value);
        high = std::clamp(high, value.value, field.high);
    }
    set.values[name_of(member)] = std::move(value);
}

template <class Tests>
std::vector<std::string> files_of(const Tests& tests) {
    std::set<std::string> files;
    for (const auto& test : tests) files.insert(file_with_hash(test.test.file));
    return {files.begin(), files.end()};
}

CardValue assumed(double value, const std::string& why) { return {value, "assumed: " + why, {}, {}}; }

CardValue thickness(const FabricMeasurements& f) {
    if (f.thickness_mm.empty())
        return assumed(
            Material{}.fabric_thickness,
            "nobody measured it; the paper's fabric. All moduli of the fabric scale with 1/thickness, "
            "and curvature nearly with the thickness");
    const std::string pressure = f.thickness_pressure_kpa > 0.0
                                     ? fmt::format(" at {:g} kPa", f.thickness_pressure_kpa)
                                     : ", pressure not stated";
    return mean_of(f.thickness_mm, "measured" + pressure);
}

CardValue areal_density(const FabricMeasurements& f) {
    if (!f.areal_density_kg_per_m2.empty()) return mean_of(f.areal_density_kg_per_m2, "measured");
    if (f.sample_mass_g.empty())
        return assumed(Material{}.fabric_areal_density, "nobody measured it; the paper's fabric");
    std::vector<double> densities;
    densities.reserve(f.sample_mass_g.size());
    for (const double mass : f.sample_mass_g) densities.push_back(1e3 * mass / f.sample_area_mm2);
    return mean_of(densities, fmt::format("measured: mass of {:g} mm^2", f.sample_area_mm2));
}

CardValue plastic_modulus(const Calibration& c) {
    if (c.campaign.plastic.youngs_modulus_mpa > 0.0)
        return {c.campaign.plastic.youngs_modulus_mpa, "stated in " + file_name(c.campaign.file), {}, {}};
    if (c.plastic.empty())
        return assumed(Material{}.plastic_youngs_modulus, "nobody measured it; the paper's TPU 95A");
    std::vector<double> values;
    double variance = 0.0;
    for (const PlasticCurve& curve : c.plastic) {
        values.push_back(curve.modulus);
        variance += std::pow(curve.error / static_cast<double>(c.plastic.size()), 2.0);
    }
    CardValue value = mean_of(
        values, fmt::format("measured: tangent at zero, strains up to {:g}", c.plastic.front().test.window));
    const double half = std::max(1.96 * std::sqrt(variance), half_width_of_mean(spread(values)));
    value.interval = std::array{value.value - half, value.value + half};
    value.files = files_of(c.plastic);
    return value;
}

CardValue bending(const Calibration& c, double areal_density, bool density_assumed) {
    if (!c.bending)
        return assumed(Material{}.fabric_bending_stiffness, "no cantilever was measured; the paper's fabric");
    const BendingFit& fit = *c.bending;
    CardValue value{fit.stiffness, "measured: cantilevers on the master curve", {}, {}};
    if (fit.groups.size() > 1)
        value.source += fmt::format(", mean of {} orientations and sides ({:.3g} to {:.3g} N mm)",
                                    fit.groups.size(), fit.smallest, fit.largest);
    if (density_assumed)
        value.source += fmt::format(
            "; with the assumed areal density of {:g} kg/m^2, to which it is proportional", areal_density);
    if (fit.has_interval) value.interval = std::array{fit.low, fit.high};
    value.files = {file_with_hash(c.campaign.file)};
    return value;
}

std::string_view choice_text(YoungsModulusChoice choice) {
    switch (choice) {
        case YoungsModulusChoice::secant:
            return "measured: secant, a line through the whole unloading branch, mean over orientations";
        case YoungsModulusChoice::tangent:
            return "measured: tangent at zero stretch, mean over orientations";
        case YoungsModulusChoice::working:
            return "measured: pulls as hard as the fabric's law at the pre-stretch";
        case YoungsModulusChoice::stated:
            return "stated in the campaign";
    }
    return {};
}

}  // namespace

CardValue mean_of(const std::vector<double>& readings, const std::string& source) {
    const Spread s = spread(readings);
    CardValue value{s.mean, source, {}, {}};
    if (s.count < 2) {
        value.source += ", one reading";
        return value;
    }
    const double half = half_width_of_mean(s);
    value.source +=
        fmt::format(", mean of {} readings with a standard deviation of {:.2g}", s.count, s.deviation);
    value.interval = std::array{std::max(s.mean - half, 0.0), s.mean + half};
    return value;
}

CardSet measured_values(const Calibration& c) {
    CardSet set;
    put(set, &Material::fabric_thickness, thickness(c.campaign.fabric));
    const CardValue density = areal_density(c.campaign.fabric);
    put(set, &Material::fabric_areal_density, density);
    put(set, &Material::fabric_bending_stiffness,
        bending(c, density.value, density.source.starts_with("assumed")));
    put(set, &Material::neo_hookean_share,
        {c.campaign.fabric.neo_hookean_share, "chosen, part of the fit (paper eq. 5)", {}, {}});
    put(set, &Material::plastic_youngs_modulus, plastic_modulus(c));
    put(set, &Material::plastic_density,
        c.campaign.plastic.density_kg_per_m3 > 0.0
            ? CardValue{c.campaign.plastic.density_kg_per_m3,
                        "stated in " + file_name(c.campaign.file),
                        {},
                        {}}
            : assumed(Material{}.plastic_density, "nobody measured it; typical of TPU 95A"));
    return set;
}

static bool is_fitted(const LawFit& fit, std::size_t parameter) {
    return std::any_of(fit.parameters.begin(), fit.parameters.end(),
                       [&](const ParameterEstimate& p) { return p.parameter == parameter; });
}

static std::string correlated_with(const LawFit& fit, std::size_t parameter) {
    std::string text;
    for (const Correlation& c : fit.correlations) {
        if (c.first != parameter && c.second != parameter) continue;
        const std::size_t other = c.first == parameter ? c.second : c.first;
        text += fmt::format("{}{} ({:+.3f})", text.empty() ? "; correlated with " : ", ",
                            name_of(law_parameters[other]), c.value);
    }
    return text;
}

void add_law_values(CardSet& set, const Calibration& c, const CalibratedSet& fitted) {
    const bool joint = c.campaign.options.mode == FitMode::joint;
    const std::vector<std::string> files = files_of(fitted.tests);
    double reached = 1.0;
    for (const TensionCurve& test : fitted.tests) reached = std::max(reached, test.largest_stretch());
    const std::string source =
        (joint ? fmt::format("fitted to {} tension tests at once", fitted.tests.size())
               : "fitted axis by axis as the paper does (eq. 12 with 1/(1 - nu^2))") +
        fmt::format("; uniaxial stretches up to {:.3f} for use at {:g}", reached, fitted.prestretch);
    for (const ParameterEstimate& p : fitted.fit.parameters) {
        CardValue value{p.value, source, {}, files};
        value.interval = std::array{p.low, p.high};
        if (!p.identifiable())
            value.source += fmt::format(
                "; NOT IDENTIFIABLE: the profile likelihood is flat {}, the interval ends at the fit's bound",
                p.low_open && p.high_open ? "to both sides"
                : p.low_open              ? "downwards"
                                          : "upwards");
        value.source += correlated_with(fitted.fit, p.parameter);
        put(set, law_parameters[p.parameter], value);
    }
    if (!joint) {
        if (c.shear_modulus)
            put(set, &Material::alpha_3,
                {fitted.fit.material.alpha_3, "measured: shear tests, linear range",
                 std::array{c.shear_modulus->low, c.shear_modulus->high}, files_of(c.shear)});
        else
            put(set, &Material::alpha_3,
                assumed(fitted.fit.material.alpha_3,
                        "no shear test; that of an isotropic fabric, sqrt(alpha_1 alpha_2)/(2 (1 + nu))"));
    }
    if (!is_fitted(fitted.fit, law_parameter_count - 1)) {
        const double nu = fitted.fit.material.fabric_poissons_ratio;
        std::vector<double> measured;
        for (const double v : fitted.poissons_ratios)
            if (!std::isnan(v)) measured.push_back(v);
        if (c.campaign.fabric.poissons_ratio > -1.0)
            put(set, &Material::fabric_poissons_ratio,
                {nu, "stated in " + file_name(c.campaign.file), {}, {}});
        else if (!measured.empty())
            put(set, &Material::fabric_poissons_ratio,
                mean_of(measured, "measured: mean of -E22/E11 (paper eq. 9)"));
        else
            put(set, &Material::fabric_poissons_ratio,
                assumed(nu, "no widths were measured; the paper's fabric"));
    }
    put(set, &Material::laminate_poissons_ratio,
        {fitted.fit.material.laminate_poissons_ratio,
         fmt::format("mean of the fabric's and the plastic's {:g}", c.campaign.plastic.poissons_ratio),
         {},
         {}});
    CardValue modulus{fitted.fit.material.fabric_youngs_modulus,
                      std::string(choice_text(c.campaign.fabric.youngs_modulus)),
                      {},
                      {}};
    if (c.campaign.fabric.youngs_modulus != YoungsModulusChoice::stated) modulus.files = files;
    modulus.source +=
        fmt::format("; secant {:.3g}, tangent {:.3g}, working {:.3g} MPa", fitted.fabric_modulus.secant,
                    fitted.fabric_modulus.tangent, fitted.fabric_modulus.working);
    put(set, &Material::fabric_youngs_modulus, modulus);
}

std::string file_with_hash(const std::string& path) {
    constexpr std::size_t longest = 64U << 20U;
    const std::string bytes = read_file(path, "file", longest);
    sha256_ctx context;
    sha256_init(&context);
    sha256_update(&context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
    sha256_digest(&context, digest.size(), digest.data());
    std::string text = file_name(path) + " sha256:";
    for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
    return text;
}

static std::string texts(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& item : list) text += (text.empty() ? "" : ", ") + toml_quoted(item);
    return "[" + text + "]";
}

static std::string value_text(const CardValue& value) {
    std::string text = fmt::format("{{ value = {}, source = {}", value.value, toml_quoted(value.source));
    if (value.interval)
        text += fmt::format(", interval = [{}, {}]", value.interval->at(0), value.interval->at(1));
    if (!value.files.empty()) text += ", files = " + texts(value.files);
    return text + " }";
}

std::string card_text(const MaterialCard& card) {
    std::string text =
        "# Material card, made by `ruche calibrate`. Units are in the keys; intervals are 95 %.\n";
    text += fmt::format("name = {}\n", toml_quoted(card.name));
    if (!card.description.empty()) text += fmt::format("description = {}\n", toml_quoted(card.description));
    if (!card.warnings.empty()) {
        text += "warnings = [\n";
        for (const std::string& warning : card.warnings)
            text += fmt::format("    {},\n", toml_quoted(warning));
        text += "]\n";
    }
    if (card.printed_thickness)
        text += fmt::format("printed_thickness_mm = {}\n", value_text(*card.printed_thickness));
    for (const CardSet& set : card.sets) {
        text += fmt::format("\n[[set]]\nprestretch = {}\n", set.prestretch);
        for (const Field<Material>& field : fields<Material>()) {
            const auto value = set.values.find(std::string(bare_name(info(field))));
            if (value != set.values.end())
                text += fmt::format("{} = {}\n", field.key, value_text(value->second));
        }
    }
    return text;
}

}  // namespace ruche

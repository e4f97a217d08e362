#include "ruche/study/calibration/printed_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "ruche/output/metrics.hpp"
#include "ruche/scene/read_scene.hpp"
#include "ruche/scene/simulate.hpp"
#include "ruche/study/calibration/card_values.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

struct Adjusted {
    double Material::*member;
    std::string_view name;
};

Adjusted adjusted(PrintedParameter parameter) {
    switch (parameter) {
        case PrintedParameter::fabric_youngs_modulus:
            return {&Material::fabric_youngs_modulus, "fabric_youngs_modulus"};
        case PrintedParameter::plastic_youngs_modulus:
            return {&Material::plastic_youngs_modulus, "plastic_youngs_modulus"};
        case PrintedParameter::fabric_thickness:
            break;
    }
    return {&Material::fabric_thickness, "fabric_thickness"};
}

Scene scene_of(const PrintedSample& sample) {
    if (!sample.scene.empty()) return read_scene(sample.scene);
    return parse_scene(fmt::format("pattern.generator = \"strip\"\n"
                                   "pattern.options = {{ length_mm = {}, width_mm = {} }}\n"
                                   "fabric = {{ prestretch = {}, margin_mm = 0 }}\n"
                                   "plastic.thickness_mm = {}\n",
                                   sample.length_mm, sample.width_mm, sample.prestretch, sample.thickness_mm),
                       to_string(sample.place));
}

/// What tension tests measure as force per width, so that its product with the thickness is what is known:
/// another thickness makes other moduli of the same forces.
std::vector<double Material::*> per_thickness(const Campaign& campaign, PrintedParameter parameter) {
    if (campaign.tension.empty() || parameter != PrintedParameter::fabric_thickness) return {};
    std::vector<double Material::*> members = {&Material::alpha_1, &Material::alpha_2, &Material::alpha_3,
                                               &Material::beta_1, &Material::beta_2};
    if (campaign.fabric.youngs_modulus != YoungsModulusChoice::stated)
        members.push_back(&Material::fabric_youngs_modulus);
    return members;
}

std::string name_of(double Material::*member) {
    for (const Field<Material>& field : fields<Material>())
        if (const auto* m = std::get_if<double Material::*>(&field.member); m != nullptr && *m == member)
            return std::string(bare_name(info(field)));
    return {};
}

/// A sample, its scene with the card's material, and what the last release gave.
class Sample {
  public:
    Sample(const PrintedSample& sample, const MaterialCard& card,
           std::vector<double Material::*> per_thickness)
        : sample_(sample), scene_(scene_of(sample)), per_thickness_(std::move(per_thickness)) {
        scene_.material = resolve_card(card, scene_.fabric.prestretch).material;
    }

    /// ln of the simulated radius with one value changed.
    double log_radius(double Material::*member, double value, const Control& control) {
        const double before = std::exchange(scene_.material.*member, value);
        for (const auto modulus : per_thickness_) scene_.material.*modulus *= before / value;
        const Result result = simulate(scene_, control);
        certain_ = result.equilibrium.status == SolveStatus::converged && result.equilibrium.stable;
        double curvature = 0.0;
        int count = 0;
        for (const StripMetrics& strip : measure_strips(result.layout, result.shape)) {
            if (!sample_.strip.empty() && strip.id != sample_.strip) continue;
            if (!std::isfinite(strip.curvature)) continue;
            curvature += std::abs(strip.curvature);
            ++count;
        }
        if (count == 0)
            throw InputError(sample_.place,
                             sample_.strip.empty()
                                 ? "the scene has no strip whose radius can be measured"
                                 : fmt::format("the scene has no strip \"{}\"", sample_.strip));
        radius_ = count / std::max(curvature, 1e-9);
        return std::log(radius_);
    }

    double start(double Material::*member) const { return scene_.material.*member; }
    double measured() const { return std::log(sample_.radius_mm); }
    double error() const {
        constexpr double usual = 0.03;  // of a radius read from a photograph or with a template
        return sample_.radius_error_mm > 0.0 ? sample_.radius_error_mm / sample_.radius_mm : usual;
    }
    PrintedOutcome outcome() const { return {sample_, radius_, certain_}; }

  private:
    PrintedSample sample_;
    Scene scene_;
    std::vector<double Material::*> per_thickness_;
    double radius_ = 0.0;
    bool certain_ = false;
};

}  // namespace

void fit_printed_samples(Calibration& calibration, const Control& control) {
    const Campaign& campaign = calibration.campaign;
    MaterialCard& card = calibration.card;
    if (card.sets.empty()) {
        const MaterialCard base = load_card(campaign.printed_fit.card);
        card.sets = base.sets;
        for (CardSet& set : card.sets)
            for (const auto& [name, value] : measured_values(calibration).values)
                if (value.source.starts_with("measured") || value.source.starts_with("stated"))
                    set.values[name] = value;
        calibration.warnings.push_back(
            "no tension test of the fabric: what was not measured is that of card " + base.name);
    }
    const Adjusted what = adjusted(campaign.printed_fit.parameter);
    std::vector<Sample> samples;
    samples.reserve(campaign.printed.size());
    const auto moduli = per_thickness(campaign, campaign.printed_fit.parameter);
    for (const PrintedSample& sample : campaign.printed) samples.emplace_back(sample, card, moduli);

    double q = std::log(samples.front().start(what.member));
    std::vector<double> slope(samples.size(), 0.0);
    std::vector<double> last(samples.size(), 0.0);
    const auto radii = [&](double at) {
        std::vector<double> values;
        for (Sample& sample : samples) {
            control.say({"printed samples", -1.0, fmt::format("{} = {:.4g}", what.name, std::exp(at))});
            values.push_back(sample.log_radius(what.member, std::exp(at), control));
        }
        return values;
    };
    // One value away from the start for the first slopes; from then on the secants.
    constexpr double first_step = 0.1;
    std::vector<double> values = radii(q + first_step);
    double before = q + first_step;
    PrintedFit fit{.parameter = std::string(what.name)};
    double information = 0.0;
    double sum = 0.0;
    constexpr int most_steps = 10;
    for (int step = 0; step < most_steps; ++step) {
        last = std::exchange(values, radii(q));
        information = 0.0;
        sum = 0.0;
        double gradient = 0.0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (std::abs(q - before) > 1e-6) slope[i] = (values[i] - last[i]) / (q - before);
            const double weight = 1.0 / (samples[i].error() * samples[i].error());
            const double residual = values[i] - samples[i].measured();
            information += weight * slope[i] * slope[i];
            gradient += weight * slope[i] * residual;
            sum += weight * residual * residual;
        }
        if (information < 1e-6)
            throw InputError(campaign.printed.front().place,
                             fmt::format("the radius does not depend on {}", what.name));
        const double change = std::clamp(-gradient / information, -0.7, 0.7);
        if (std::abs(change) < 1e-4) break;
        before = q;
        q += change;
    }
    const int freedom = static_cast<int>(samples.size()) - 1;
    // Samples that contradict each other by more than their errors widen the interval.
    const double scatter = freedom > 0 ? std::max(1.0, std::sqrt(sum / freedom)) : 1.0;
    const double half = (freedom > 0 ? student_t(0.95, freedom) : 1.96) * scatter / std::sqrt(information);
    fit.value = std::exp(q);
    fit.low = std::exp(q - std::min(half, 3.0));
    fit.high = std::exp(q + std::min(half, 3.0));
    for (const Sample& sample : samples) {
        fit.samples.push_back(sample.outcome());
        const PrintedOutcome& outcome = fit.samples.back();
        if (!outcome.certain)
            fit.warnings.push_back(to_string(outcome.sample.place) +
                                   ": the release did not converge to a stable shape");
        if (std::abs(std::log(outcome.simulated_radius_mm / outcome.sample.radius_mm)) > 0.1)
            fit.warnings.push_back(fmt::format("{}: simulated radius {:.3g} mm, measured {:.3g} mm",
                                               to_string(outcome.sample.place), outcome.simulated_radius_mm,
                                               outcome.sample.radius_mm));
    }
    for (CardSet& set : card.sets) {
        for (const auto modulus : moduli) {
            CardValue& value = set.values.at(name_of(modulus));
            const double factor = set.values.at(fit.parameter).value / fit.value;
            value.value *= factor;
            if (value.interval)
                value.interval = std::array{factor * value.interval->at(0), factor * value.interval->at(1)};
            value.source += fmt::format("; at the thickness of the printed samples, times {:.4g}", factor);
        }
        set.values[fit.parameter] = {
            fit.value,
            fmt::format("fitted to the radii of {} printed samples by simulation", samples.size()),
            std::array{fit.low, fit.high},
            {file_with_hash(campaign.file)}};
    }
    calibration.warnings.insert(calibration.warnings.end(), fit.warnings.begin(), fit.warnings.end());
    calibration.printed = fit;
}

}  // namespace ruche

#include "ruche/study/calibration/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "ruche/study/calibration/card_values.hpp"
#include "ruche/study/calibration/grip_correction.hpp"
#include "ruche/study/calibration/paper_fit.hpp"
#include "ruche/study/calibration/printed_fit.hpp"
#include "ruche/study/calibration/statistics.hpp"

namespace ruche {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

LawCurve law_curve(const TensionCurve& test) {
    return {.name = test.name(),
            .angle_deg = test.test.angle_deg,
            .stretch = test.stretch,
            .nominal_stress = test.nominal_stress,
            .transverse = test.transverse,
            .by_force = test.record.driven_by_force};
}

/// Fits one pre-stretch after the other.
class Calibrator {
  public:
    Calibrator(Calibration& result, const Control& control)
        : result_(result), campaign_(result.campaign), control_(control) {}

    void run() {
        const CardValue& thickness = set_value(measured_values(result_), "fabric_thickness");
        thickness_ = thickness.value;
        if (thickness.source.starts_with("assumed") && !campaign_.tension.empty())
            result_.warnings.push_back(
                "the fabric's thickness was not measured: stiffness per width is right, moduli and curvature "
                "are not");
        read_tests();
        const CardSet measured = measured_values(result_);
        for (CalibratedSet& set : result_.sets) {
            fit(set, measured);
            CardSet card = measured;
            card.prestretch = set.prestretch;
            add_law_values(card, result_, set);
            result_.card.sets.push_back(card);
        }
    }

  private:
    static CardValue set_value(const CardSet& set, const std::string& name) { return set.values.at(name); }

    void read_tests() {
        std::set<double> prestretches;
        for (const TensionTest& test : campaign_.tension) prestretches.insert(test.prestretch);
        std::map<std::tuple<std::string, int, int>, double> seen;
        for (const double s : prestretches) {
            CalibratedSet set{.prestretch = s};
            for (const TensionTest& test : campaign_.tension) {
                if (test.prestretch != s) continue;
                control_.say({"read", -1.0, test.file});
                set.tests.push_back(read_tension_curve(test, thickness_));
                append(result_.warnings, set.tests.back().warnings);
                const auto [other, is_new] =
                    seen.try_emplace({test.file, test.specimen, test.cycle}, test.angle_deg);
                if (!is_new && other->second != test.angle_deg)
                    throw InputError(test.place, test.file + " is named for two orientations");
            }
            result_.sets.push_back(std::move(set));
        }
        for (const ShearTest& test : campaign_.shear) {
            result_.shear.push_back(read_shear_curve(test, thickness_));
            append(result_.warnings, result_.shear.back().warnings);
        }
        for (const PlasticTest& test : campaign_.plastic_tension) {
            result_.plastic.push_back(read_plastic_curve(test));
            append(result_.warnings, result_.plastic.back().warnings);
        }
        if (!campaign_.cantilever.empty())
            result_.bending = fit_bending(campaign_.cantilever,
                                          measured_values(result_).values.at("fabric_areal_density").value);
        warn_of_bending();
        if (!result_.shear.empty()) result_.shear_modulus = mean_slope_of(result_.shear);
        if (campaign_.tension.empty() && !result_.shear.empty())
            result_.warnings.push_back("shear tests without tension tests are drawn, but determine nothing");
    }

    void warn_of_bending() {
        if (!result_.bending || result_.bending->groups.size() < 2) return;
        const double ratio = result_.bending->largest / result_.bending->smallest;
        if (ratio > 2.0)
            result_.warnings.push_back(
                fmt::format("k_B differs by a factor of {:.2g} between orientations and sides; the model "
                            "knows their mean only",
                            ratio));
    }

    /// What the fit takes as given.
    Material given(const CalibratedSet& set, const CardSet& measured) const {
        Material m;
        for (const Field<Material>& field : fields<Material>()) {
            const auto value = measured.values.find(std::string(bare_name(info(field))));
            if (value != measured.values.end()) ruche::set(m, field, value->second.value);
        }
        std::vector<double> ratios;
        for (const double v : set.poissons_ratios)
            if (!std::isnan(v)) ratios.push_back(v);
        if (campaign_.fabric.poissons_ratio > -1.0)
            m.fabric_poissons_ratio = campaign_.fabric.poissons_ratio;
        else if (!ratios.empty())
            m.fabric_poissons_ratio = std::clamp(spread(ratios).mean, -0.5, 0.9);
        m.laminate_poissons_ratio = 0.5 * (m.fabric_poissons_ratio + campaign_.plastic.poissons_ratio);
        return m;
    }

    double chosen_modulus(const FabricModulus& modulus) const {
        switch (campaign_.fabric.youngs_modulus) {
            case YoungsModulusChoice::secant:
                return modulus.secant;
            case YoungsModulusChoice::tangent:
                return modulus.tangent;
            case YoungsModulusChoice::working:
                return modulus.working;
            case YoungsModulusChoice::stated:
                break;
        }
        return campaign_.fabric.youngs_modulus_mpa;
    }

    void fit(CalibratedSet& set, const CardSet& measured) {
        bool widths = false;
        for (const TensionCurve& test : set.tests) {
            set.curves.push_back(law_curve(test));
            set.poissons_ratios.push_back(mean_poissons_ratio(test));
            widths = widths || !test.transverse.empty();
        }
        check_orientations(set);
        Material start = given(set, measured);
        start.fabric_youngs_modulus = chosen_modulus(fabric_modulus(set.curves, start, set.prestretch));
        if (campaign_.options.mode == FitMode::paper)
            fit_paper(set, start);
        else
            fit_joint(set, start, widths && campaign_.fabric.poissons_ratio <= -1.0);
        Material& m = set.fit.material;
        m.laminate_poissons_ratio = 0.5 * (m.fabric_poissons_ratio + campaign_.plastic.poissons_ratio);
        set.fabric_modulus = fabric_modulus(set.curves, m, set.prestretch);
        warn_of_fit(set);
        compare_moduli(set);
        if (campaign_.options.mode == FitMode::joint && !result_.shear.empty()) compare_shear(set);
    }

    void fit_paper(CalibratedSet& set, const Material& start) {
        PaperFit paper = fit_as_in_the_paper(set.curves, start);
        Material& m = paper.material;
        m.alpha_3 = result_.shear_modulus
                        ? result_.shear_modulus->value
                        : std::sqrt(m.alpha_1 * m.alpha_2) / (2.0 * (1.0 + m.fabric_poissons_ratio));
        if (!result_.shear_modulus)
            result_.warnings.push_back("no shear test: alpha_3 is that of an isotropic fabric");
        set.fit.material = m;
        set.fit.converged = true;
        for (const ParameterEstimate& p : paper.parameters)
            if (p.parameter != 2) set.fit.parameters.push_back(p);
        for (const LawCurve& curve : set.curves) set.fit.rms.push_back(relative_error(m, curve));
    }

    static double relative_error(const Material& m, const LawCurve& curve) {
        const LawPrediction prediction = predict(m, curve);
        double sum = 0.0;
        for (std::size_t i = 0; i < curve.stretch.size(); ++i)
            sum += std::pow(prediction.nominal_stress[i] - curve.nominal_stress[i], 2.0);
        const double largest = *std::max_element(curve.nominal_stress.begin(), curve.nominal_stress.end());
        return std::sqrt(sum / static_cast<double>(curve.stretch.size())) / largest;
    }

    /// The homogeneous law first, then against the simulated samples until the parameters rest.
    void fit_joint(CalibratedSet& set, Material start, bool fit_poisson) {
        LawFitOptions options{.start = start, .fit_poisson = fit_poisson, .intervals = false};
        control_.say({"fit", -1.0, fmt::format("pre-stretch {:g}: homogeneous law", set.prestretch)});
        set.fit = fit_law(set.curves, options);
        constexpr int most_rounds = 8;
        constexpr double little = 0.02;  // of half an interval
        double last_change = infinity;
        while (set.grip_rounds < most_rounds && has_grips(set)) {
            const LawFit before = set.fit;
            ++set.grip_rounds;
            control_.say({"fit", -1.0,
                          fmt::format("pre-stretch {:g}: simulating the clamped samples, round {}",
                                      set.prestretch, set.grip_rounds)});
            correct_for_grips(set.curves, set.tests, before.material, campaign_.options.element_size_mm);
            set.fit = fit_law(set.curves, options);
            // Changes shrink by about the same factor each time: what all further rounds would change is
            // known.
            const double change = largest_change(before, set.fit);
            const double factor = change / last_change;
            last_change = change;
            if (factor < 1.0 && set.grip_rounds > 1 && change * factor / (1.0 - factor) < little) break;
        }
        for (const LawCurve& curve : set.curves)
            for (const double ratio : curve.force_ratio)
                set.largest_grip_effect = std::max(set.largest_grip_effect, std::abs(ratio - 1.0));
        control_.say({"fit", -1.0, fmt::format("pre-stretch {:g}: intervals", set.prestretch)});
        options.intervals = true;
        set.fit = fit_law(set.curves, options);
    }

    static bool has_grips(const CalibratedSet& set) {
        return std::any_of(set.tests.begin(), set.tests.end(), [](const TensionCurve& test) {
            return test.test.grips == Grips::wide || test.test.grip_width_mm > 0.0;
        });
    }

    /// In units of half an interval, or of a thousandth of the value where the data are better than that.
    static double largest_change(const LawFit& a, const LawFit& b) {
        double change = 0.0;
        for (std::size_t i = 0; i < a.parameters.size(); ++i) {
            const ParameterEstimate& p = b.parameters[i];
            const double wide = std::max(0.5 * (p.high - p.low), 1e-3 * std::abs(p.value) + 1e-12);
            change = std::max(change, std::abs(p.value - a.parameters[i].value) / wide);
        }
        return change;
    }

    void check_orientations(const CalibratedSet& set) {
        std::array<bool, 2> axis{};
        bool between = false;
        std::string found;
        for (const TensionCurve& test : set.tests) {
            const double from_first = std::abs(std::remainder(test.test.angle_deg, 180.0));
            axis[0] = axis[0] || from_first <= 20.0;
            axis[1] = axis[1] || from_first >= 70.0;
            between = between || (from_first >= 15.0 && from_first <= 75.0);
            found += fmt::format("{}{:g}", found.empty() ? "" : ", ", test.test.angle_deg);
        }
        if (!axis[0] || !axis[1])
            throw InputError(
                {.file = campaign_.file, .key = "tension"},
                fmt::format("there is no tension test along the fabric's {} axis (angle_deg near {}); "
                            "there are {} deg at a pre-stretch of {:g}",
                            axis[0] ? "second" : "first", axis[0] ? 90 : 0, found, set.prestretch),
                "Both axes must be pulled; an angle between them, 45 deg say, determines alpha_3.");
        if (!between && campaign_.options.mode == FitMode::joint)
            throw InputError(
                {.file = campaign_.file, .key = "tension"},
                fmt::format("no tension test between the axes: there are {} deg at a pre-stretch of "
                            "{:g}, which say nothing about alpha_3",
                            found, set.prestretch),
                "Add a test at 45 deg, or take mode = \"paper\" with a shear test.");
    }

    void warn_of_fit(const CalibratedSet& set) {
        const std::string at = fmt::format("pre-stretch {:g}: ", set.prestretch);
        if (!set.fit.converged)
            result_.warnings.push_back(at + "the fit did not converge: " + set.fit.message);
        for (std::size_t i = 0; i < set.curves.size(); ++i)
            if (set.fit.rms[i] > 0.05)
                result_.warnings.push_back(
                    fmt::format("{}the law misses {} by {:.0f} % of its largest stress (rms)", at,
                                set.curves[i].name, 100.0 * set.fit.rms[i]));
        for (const ParameterEstimate& p : set.fit.parameters)
            if (!p.identifiable())
                result_.warnings.push_back(fmt::format("{}{} cannot be determined from these tests", at,
                                                       parameter_name(p.parameter)));
        const Material& m = set.fit.material;
        const double limit = std::sqrt(1.0 + 2.0 * std::min(m.gamma_1, m.gamma_2));
        if (limit <= set.prestretch)
            result_.warnings.push_back(fmt::format(
                "{}the fitted fabric locks at a stretch of {:.4g}, below the pre-stretch: measure up to "
                "the pre-stretch and a little beyond",
                at, limit));
    }

    static std::string parameter_name(std::size_t parameter) {
        constexpr std::array<std::string_view, law_parameter_count> names = {
            "alpha_1", "alpha_2", "alpha_3", "beta_1",
            "beta_2",  "gamma_1", "gamma_2", "fabric_poissons_ratio"};
        return std::string(names[parameter]);
    }

    void compare_moduli(CalibratedSet& set) {
        constexpr double thickness = 0.6;
        Material m = set.fit.material;
        set.curvature_used = strip_curvature(m, set.prestretch, thickness);
        m.fabric_youngs_modulus = set.fabric_modulus.working;
        set.curvature_working = strip_curvature(m, set.prestretch, thickness);
        const double ratio = set.fit.material.fabric_youngs_modulus / set.fabric_modulus.working;
        if (ratio < 2.0 && ratio > 0.5) return;
        result_.warnings.push_back(fmt::format(
            "pre-stretch {:g}: E_f = {:.3g} MPa pulls {:.2g} times as hard as the fabric's own law at the "
            "pre-stretch (working modulus {:.3g} MPa). A narrow strip with {:g} mm of plastic gets a "
            "curvature of {:.4g}/mm with the one and {:.4g}/mm with the other; a printed sample decides",
            set.prestretch, set.fit.material.fabric_youngs_modulus, ratio, set.fabric_modulus.working,
            thickness, set.curvature_used, set.curvature_working));
    }

    /// The shear tests against alpha_3 of the tension tests.
    void compare_shear(CalibratedSet& set) {
        set.sheared_alpha_3 = corrected_shear_modulus(result_.shear, set.fit.material);
        const double ratio = set.sheared_alpha_3->value / set.fit.material.alpha_3;
        if (ratio > 0.8 && ratio < 1.25) return;
        result_.warnings.push_back(fmt::format(
            "pre-stretch {:g}: the shear tests give alpha_3 = {:.4g} MPa, the tension tests {:.4g} MPa; "
            "the card has the latter",
            set.prestretch, set.sheared_alpha_3->value, set.fit.material.alpha_3));
    }

    Calibration& result_;
    const Campaign& campaign_;
    const Control& control_;
    double thickness_ = 0.0;
};

}  // namespace

Calibration calibrate(const Campaign& campaign, const Control& control) {
    Calibration result{.campaign = campaign};
    result.card.name = campaign.options.name;
    result.card.description = campaign.options.description;
    if (!campaign.plastic.thickness_mm.empty())
        result.card.printed_thickness = mean_of(campaign.plastic.thickness_mm, "measured");
    Calibrator(result, control).run();
    if (!campaign.printed.empty()) fit_printed_samples(result, control);
    result.card.warnings = result.warnings;
    return result;
}

}  // namespace ruche

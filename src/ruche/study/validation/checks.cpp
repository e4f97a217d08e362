#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ruche/study/validation/validation.hpp"

namespace ruche {
namespace {

/// All numbers that a value may stand for.
struct Interval {
    double low = 0.0, high = 0.0;

    bool finite() const { return std::isfinite(low) && std::isfinite(high); }
};

Interval interval_of(const Estimate& e) { return {e.value - e.uncertainty, e.value + e.uncertainty}; }

/// What is claimed holds for `all` numbers of an interval, or for `none`.
Verdict verdict(bool all, bool none) {
    if (all) return Verdict::holds;
    return none ? Verdict::fails : Verdict::unresolved;
}

Verdict positive(const Interval& v) { return verdict(v.low > 0.0, v.high <= 0.0); }
Verdict larger(const Interval& a, const Interval& b) { return verdict(a.low > b.high, a.high <= b.low); }
Verdict inside(const Interval& v, double low, double high) {
    return verdict(v.low >= low && v.high <= high, v.high < low || v.low > high);
}

/// Collects what is found at the values of a sweep.
class Findings {
  public:
    void add(Verdict found, const std::string& text) {
        static constexpr const char* said[] = {"", "not resolved: ", "not so: "};
        details_[static_cast<std::size_t>(found)].push_back(said[static_cast<std::size_t>(found)] + text);
    }

    CheckOutcome finish(const CheckSpec& check) const {
        const auto& [good, open, bad] = details_;
        CheckOutcome outcome{.check = check, .verdict = Verdict::holds};
        if (!bad.empty())
            outcome.verdict = Verdict::fails;
        else if (!open.empty())
            outcome.verdict = Verdict::unresolved;
        for (const auto* list : {&bad, &open, &good})
            outcome.details.insert(outcome.details.end(), list->begin(), list->end());
        if (!outcome.details.empty()) return outcome;
        return {
            .check = check, .verdict = Verdict::fails, .details = {"not so: there is no value to look at"}};
    }

  private:
    std::array<std::vector<std::string>, 3> details_;  // by verdict
};

/// One check of one variant.
class Judge {
  public:
    Judge(const ExperimentOutcome& outcome, const CheckSpec& check, const std::string& variant,
          Findings& findings)
        : outcome_(outcome),
          check_(check),
          variant_(variant),
          findings_(findings),
          series_(outcome.of(variant, check.metric)) {}

    void look() {
        std::vector<std::size_t> counted;
        for (std::size_t i = 0; i < series_.x.size(); ++i)
            if (series_.x[i] >= check_.where[0] - 1e-9 && series_.x[i] <= check_.where[1] + 1e-9)
                counted.push_back(i);
        if (check_.kind == CheckKind::falls || check_.kind == CheckKind::rises) {
            for (std::size_t k = 1; k < counted.size(); ++k) neighbours(counted[k - 1], counted[k]);
            return;
        }
        for (const std::size_t i : counted) single(i);
    }

  private:
    std::string at(std::size_t i) const {
        const std::string& key = outcome_.experiment.sweep.key;
        return key.empty() ? variant_ : fmt::format("{}, {} = {:g}", variant_, key, series_.x[i]);
    }

    Estimate value(const Estimate& e) const { return check_.absolute ? magnitude(e) : e; }

    /// What is no number, or not of an equilibrium, proves nothing on any mesh.
    void say(Verdict found, const Interval& interval, bool certain, const std::string& text) {
        const bool counts = certain && interval.finite();
        findings_.add(counts ? found : Verdict::fails, certain ? text : text + " (no certified equilibrium)");
    }

    void neighbours(std::size_t i, std::size_t k) {
        const Estimate a = value(series_.y[i]);
        const Estimate b = value(series_.y[k]);
        const bool falls = check_.kind == CheckKind::falls;
        const Interval before = interval_of(a);
        const Interval after = interval_of(b);
        say(falls ? larger(before, after) : larger(after, before),
            {before.low + after.low, before.high + after.high}, a.certain && b.certain,
            fmt::format("{}: {}, then {}", at(i), to_text(a), to_text(b)));
    }

    void single(std::size_t i) {
        const Estimate e = value(series_.y[i]);
        const Interval v = interval_of(e);
        const std::string text = fmt::format("{}: {}", at(i), to_text(e));
        switch (check_.kind) {
            case CheckKind::positive:
                return say(positive(v), v, e.certain, text);
            case CheckKind::negative:
                return say(positive({-v.high, -v.low}), v, e.certain, text);
            case CheckKind::in_range:
                return say(inside(v, check_.range[0], check_.range[1]), v, e.certain, text);
            case CheckKind::resolved:
                return say(verdict(e.uncertainty <= check_.relative * std::abs(e.value), false), v, e.certain,
                           text);
            case CheckKind::within: {
                const double reference = reference_at(i);
                const double room = check_.relative * std::abs(reference);
                return say(inside({v.low - reference, v.high - reference}, -room, room),
                           {v.low - reference, v.high - reference}, e.certain,
                           text + fmt::format(", reference {:.6g}, off by {:+.3f} %", reference,
                                              100.0 * (e.value / reference - 1.0)));
            }
            case CheckKind::exceeds:
            case CheckKind::ratio:
                return compare(i, e);
            case CheckKind::falls:
            case CheckKind::rises:
                return;
        }
    }

    void compare(std::size_t i, const Estimate& e) {
        const ValueSeries& others =
            outcome_.of(check_.other_variant.empty() ? variant_ : check_.other_variant,
                        check_.other_metric.empty() ? check_.metric : check_.other_metric);
        const Estimate other = value(others.y[i]);  // every series has the whole sweep
        if (check_.kind == CheckKind::exceeds) {
            const Interval a = interval_of(e);
            const Interval b = interval_of(other);
            say(larger(a, b), {a.low + b.low, a.high + b.high}, e.certain && other.certain,
                fmt::format("{}: {}, the other {}", at(i), to_text(e), to_text(other)));
            return;
        }
        const Estimate ratio = quotient(e, other);
        const Interval v = interval_of(ratio);
        say(inside(v, check_.range[0], check_.range[1]), v, ratio.certain,
            fmt::format("{}: ratio {}, at least {:.7g}, at most {:.7g}", at(i), to_text(ratio), v.low,
                        v.high));
    }

    double reference_at(std::size_t i) const {
        const ReferenceCurve* curve = outcome_.experiment.reference(check_.reference);
        if (curve == nullptr) return outcome_.of(variant_, check_.reference).y[i].value;
        for (std::size_t k = 0; k < curve->x.size(); ++k)
            if (std::abs(curve->x[k] - series_.x[i]) < 1e-9) return curve->y[k];
        return std::numeric_limits<double>::quiet_NaN();  // the check fails
    }

    const ExperimentOutcome& outcome_;
    const CheckSpec& check_;
    const std::string& variant_;
    Findings& findings_;
    const ValueSeries& series_;
};

bool has_variant(const ExperimentOutcome& outcome, const std::string& name) {
    return std::ranges::any_of(outcome.series, [&](const ValueSeries& s) { return s.variant == name; });
}

}  // namespace

std::vector<CheckOutcome> judge(const ExperimentOutcome& outcome) {
    std::vector<CheckOutcome> results;
    for (const CheckSpec& check : outcome.experiment.checks) {
        // A quick subset has not all variants.
        if (!check.other_variant.empty() && !has_variant(outcome, check.other_variant)) continue;
        Findings findings;
        bool looked = false;
        for (const VariantSpec& variant : outcome.experiment.variants) {
            const bool named = check.variants.empty() ||
                               std::ranges::find(check.variants, variant.name) != check.variants.end();
            if (!named || !has_variant(outcome, variant.name)) continue;
            Judge(outcome, check, variant.name, findings).look();
            looked = true;
        }
        if (looked) results.push_back(findings.finish(check));
    }
    return results;
}

}  // namespace ruche

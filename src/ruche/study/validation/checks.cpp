#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/study/validation/validation.hpp"

namespace ruche {
namespace {

/// All numbers that a value may stand for.
struct Interval {
    double low = 0.0, high = 0.0;
};

Interval interval_of(const Estimate& e, bool absolute) {
    const Interval i{e.value - e.uncertainty, e.value + e.uncertainty};
    if (!absolute || i.low >= 0.0) return i;
    if (i.high <= 0.0) return {-i.high, -i.low};
    return {0.0, std::max(-i.low, i.high)};
}

/// Quotient; endless where the divisor may be zero.
Interval quotient(const Interval& a, const Interval& b) {
    if (b.low <= 0.0 && b.high >= 0.0) return {-infinity, infinity};
    const auto [low, high] = std::minmax({a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high});
    return {low, high};
}

/// Collects what is found at the values of a sweep.
class Verdict {
  public:
    explicit Verdict(const CheckSpec& check) { outcome_.check = check; }

    void add(bool holds, std::string text) {
        ++count_;
        if (holds)
            good_.push_back(std::move(text));
        else
            outcome_.details.push_back("not so: " + text);
    }

    CheckOutcome finish() {
        outcome_.holds = outcome_.details.empty() && count_ > 0;
        if (count_ == 0) outcome_.details.emplace_back("not so: there is no value to look at");
        outcome_.details.insert(outcome_.details.end(), good_.begin(), good_.end());
        return std::move(outcome_);
    }

  private:
    CheckOutcome outcome_;
    std::vector<std::string> good_;
    std::size_t count_ = 0;
};

/// One check of one variant.
class Judge {
  public:
    Judge(const ExperimentOutcome& outcome, const CheckSpec& check, const std::string& variant,
          Verdict& verdict)
        : outcome_(outcome),
          check_(check),
          variant_(variant),
          verdict_(verdict),
          series_(outcome.of(variant, check.metric)) {}

    void look() {
        std::vector<std::size_t> inside;
        for (std::size_t i = 0; i < series_.x.size(); ++i)
            if (series_.x[i] >= check_.where[0] - 1e-9 && series_.x[i] <= check_.where[1] + 1e-9)
                inside.push_back(i);
        if (check_.kind == CheckKind::falls || check_.kind == CheckKind::rises) {
            for (std::size_t k = 1; k < inside.size(); ++k) neighbours(inside[k - 1], inside[k]);
            return;
        }
        for (const std::size_t i : inside) single(i);
    }

  private:
    std::string at(std::size_t i) const {
        const std::string& key = outcome_.experiment.sweep.key;
        return key.empty() ? variant_ : fmt::format("{}, {} = {:g}", variant_, key, series_.x[i]);
    }

    void neighbours(std::size_t i, std::size_t k) {
        const Estimate& a = series_.y[i];
        const Estimate& b = series_.y[k];
        const Interval ia = interval_of(a, check_.absolute);
        const Interval ib = interval_of(b, check_.absolute);
        const bool follows = check_.kind == CheckKind::falls ? ib.high < ia.low : ib.low > ia.high;
        verdict_.add(follows && a.certain && b.certain,
                     fmt::format("{}: {}, then {}", at(i), to_text(a), to_text(b)));
    }

    void single(std::size_t i) {
        const Estimate& e = series_.y[i];
        const Interval v = interval_of(e, check_.absolute);
        const auto say = [&](bool holds, const std::string& more) {
            verdict_.add(holds && e.certain, fmt::format("{}: {}{}{}", at(i), to_text(e), more,
                                                         e.certain ? "" : " (no certified equilibrium)"));
        };
        switch (check_.kind) {
            case CheckKind::positive:
                return say(v.low > 0.0, "");
            case CheckKind::negative:
                return say(v.high < 0.0, "");
            case CheckKind::in_range:
                return say(v.low >= check_.range[0] && v.high <= check_.range[1], "");
            case CheckKind::resolved:
                return say(e.uncertainty <= check_.relative * std::abs(e.value), "");
            case CheckKind::within: {
                const double reference = reference_at(i);
                const double off = std::max(std::abs(v.low - reference), std::abs(v.high - reference));
                return say(off <= check_.relative * std::abs(reference),
                           fmt::format(", reference {:.6g}, off by {:+.3f} %", reference,
                                       100.0 * (e.value / reference - 1.0)));
            }
            case CheckKind::exceeds:
            case CheckKind::ratio:
                return compare(i, v);
            case CheckKind::falls:
            case CheckKind::rises:
                return;
        }
    }

    void compare(std::size_t i, const Interval& v) {
        const ValueSeries& others =
            outcome_.of(check_.other_variant.empty() ? variant_ : check_.other_variant,
                        check_.other_metric.empty() ? check_.metric : check_.other_metric);
        const Estimate& other = others.y[i];  // every series has the whole sweep
        const Interval o = interval_of(other, check_.absolute);
        const bool certain = series_.y[i].certain && other.certain;
        if (check_.kind == CheckKind::exceeds) {
            verdict_.add(v.low > o.high && certain,
                         fmt::format("{}: {}, the other {}", at(i), to_text(series_.y[i]), to_text(other)));
            return;
        }
        const Interval q = quotient(v, o);
        verdict_.add(q.low >= check_.range[0] && q.high <= check_.range[1] && certain,
                     fmt::format("{}: ratio {:.4g}, at least {:.4g}, at most {:.4g}", at(i),
                                 series_.y[i].value / other.value, q.low, q.high));
    }

    double reference_at(std::size_t i) const {
        const ReferenceCurve* curve = outcome_.experiment.reference(check_.reference);
        if (curve == nullptr) return outcome_.of(variant_, check_.reference).y[i].value;
        for (std::size_t k = 0; k < curve->x.size(); ++k)
            if (std::abs(curve->x[k] - series_.x[i]) < 1e-9) return curve->y[k];
        return std::numeric_limits<double>::quiet_NaN();  // compares false: the check fails
    }

    const ExperimentOutcome& outcome_;
    const CheckSpec& check_;
    const std::string& variant_;
    Verdict& verdict_;
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
        Verdict verdict(check);
        bool looked = false;
        for (const VariantSpec& variant : outcome.experiment.variants) {
            const bool named = check.variants.empty() ||
                               std::ranges::find(check.variants, variant.name) != check.variants.end();
            if (!named || !has_variant(outcome, variant.name)) continue;
            Judge(outcome, check, variant.name, verdict).look();
            looked = true;
        }
        if (looked) results.push_back(verdict.finish());
    }
    return results;
}

}  // namespace ruche

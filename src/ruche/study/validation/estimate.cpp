#include "ruche/study/validation/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace ruche {

Estimate estimate(std::span<const double> values, double refinement) {
    assert(values.size() >= 2 && refinement > 1.0);
    constexpr double safety = 1.25;
    const std::size_t n = values.size();
    const double fine = values[n - 1];
    const double step = fine - values[n - 2];
    Estimate result{.value = fine,
                    .order = std::numeric_limits<double>::quiet_NaN(),
                    .extrapolated = fine,
                    .values = {values.begin(), values.end()},
                    .refinement = refinement};
    if (n == 2) {
        const double gain = step / (refinement - 1.0);
        result.uncertainty = safety * std::abs(gain);
        result.extrapolated = fine + gain;
        return result;
    }
    const double before = values[n - 2] - values[n - 3];
    const double order = std::log(before / step) / std::log(refinement);  // NaN when the sign changes
    if (order >= 0.5 && order <= 3.0) {
        const double gain = step / (std::pow(refinement, order) - 1.0);
        result.order = order;
        result.uncertainty = safety * std::abs(gain);
        result.extrapolated = fine + gain;
    } else {
        result.uncertainty = safety * std::max({std::abs(step), std::abs(before), std::abs(step + before)});
    }
    return result;
}

Estimate quotient(const Estimate& a, const Estimate& b) {
    assert(a.values.size() == b.values.size() && a.refinement == b.refinement);
    std::vector<double> quotients;
    for (std::size_t i = 0; i < a.values.size(); ++i) quotients.push_back(a.values[i] / b.values[i]);
    Estimate result = estimate(quotients, a.refinement);
    result.certain = a.certain && b.certain;
    return result;
}

Estimate magnitude(const Estimate& e) {
    std::vector<double> magnitudes;
    magnitudes.reserve(e.values.size());
    for (const double value : e.values) magnitudes.push_back(std::abs(value));
    Estimate result = estimate(magnitudes, e.refinement);
    result.certain = e.certain;
    return result;
}

std::string to_text(const Estimate& e) { return fmt::format("{:.5g} ± {:.2g}", e.value, e.uncertainty); }

std::string to_html(const Estimate& e) {
    std::string html = to_text(e) + (e.certain ? "" : " (!)");
    if (std::isfinite(e.order))
        html += fmt::format("<br><small>order {:.2g}, limit {:.5g}</small>", e.order, e.extrapolated);
    return html;
}

}  // namespace ruche

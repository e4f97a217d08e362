#include "ruche/study/sheared_sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ruche/core/error.hpp"
#include "ruche/study/clamped_sheet.hpp"

namespace ruche {

ShearedResponse simulate_sheared(const ShearedSample& sample, const Material& material,
                                 std::span<const double> shears) {
    if (!(sample.length_mm > 0.0 && sample.width_mm > 0.0 && sample.element_size_mm > 0.0))
        throw InputError({.key = "sample"}, "length, width and element size must be positive",
                         "Measure the free length between the clamps and the width along them.");
    ModelInput sheet;
    sheet.mesh = clamped_rectangle(sample.length_mm, sample.width_mm, sample.element_size_mm);
    sheet.material = material;
    sheet.prestretch = {1.0, 1.0};
    sheet.fabric_axis_deg = -sample.angle_deg;
    ClampedSheet clamped(std::move(sheet));

    std::vector<std::size_t> order(shears.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return std::abs(shears[a]) < std::abs(shears[b]); });
    ShearedResponse response;
    response.force_N.resize(shears.size());
    for (const std::size_t i : order) {
        const ClampedSheet::State state = clamped.hold({0.0, shears[i] * sample.length_mm});
        response.force_N[i] = state.converged ? state.force.y() : std::numeric_limits<double>::quiet_NaN();
        response.converged = response.converged && state.converged;
    }
    return response;
}

}  // namespace ruche

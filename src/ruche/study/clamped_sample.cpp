#include "ruche/study/clamped_sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ruche/core/error.hpp"
#include "ruche/study/clamped_sheet.hpp"

namespace ruche {
namespace {

void check(const ClampedSample& sample, std::span<const double> strains) {
    const auto require = [](bool good, const char* key, const char* problem, const char* advice) {
        if (!good) throw InputError({.key = key}, problem, advice);
    };
    const bool has_size = sample.length_mm > 0.0 && sample.width_mm > 0.0 && sample.element_size_mm > 0.0;
    require(has_size, "sample", "length, width and element size must be positive",
            "Measure the free length between the clamps and the width.");
    require(sample.length_mm * sample.width_mm < 1e6 * sample.element_size_mm * sample.element_size_mm,
            "sample.element_size_mm", "gives more than a million squares", "A tenth of the width will do.");
    const bool straight = sample.grip_width_mm == 0.0;
    require(straight || (sample.grip_width_mm >= sample.width_mm && sample.gauge_length_mm > 0.0 &&
                         sample.gauge_length_mm < sample.length_mm),
            "sample.grip_width_mm", "is no dogbone's",
            "A dogbone is wider at the clamps, and its narrow part is shorter than the sample.");
    for (const double strain : strains)
        require(strain > -1.0 && std::isfinite(strain), "strain", "is not a finite number above -1",
                "Displacement over length: 0.7 is 70 %.");
}

/// Width at `x`: from the narrow part to the clamps it grows along a cosine, which stands for the fillets.
double width_at(const ClampedSample& sample, double x) {
    if (sample.grip_width_mm == 0.0) return sample.width_mm;
    const double shoulder = 0.5 * (sample.length_mm - sample.gauge_length_mm);
    const double beyond = std::abs(x - 0.5 * sample.length_mm) - 0.5 * sample.gauge_length_mm;
    const double rise = 0.5 - 0.5 * std::cos(M_PI * std::clamp(beyond / shoulder, 0.0, 1.0));
    return sample.width_mm + rise * (sample.grip_width_mm - sample.width_mm);
}

TriangleMesh mesh_of(const ClampedSample& sample) {
    TriangleMesh mesh = clamped_rectangle(sample.length_mm, sample.width_mm, sample.element_size_mm);
    const double axis = 0.5 * sample.width_mm;
    for (Vec2& p : mesh.vertices) p.y() = axis + (p.y() - axis) * width_at(sample, p.x()) / sample.width_mm;
    return mesh;
}

}  // namespace

ClampedResponse simulate_clamped(const ClampedSample& sample, const Material& material,
                                 std::span<const double> strains) {
    check(sample, strains);
    ModelInput sheet;
    sheet.mesh = mesh_of(sample);
    sheet.material = material;
    sheet.prestretch = {1.0, 1.0};  // the machine stretches it from its rest
    sheet.fabric_axis_deg = -sample.angle_deg;
    ClampedSheet clamped(std::move(sheet));

    std::vector<std::size_t> order(strains.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return strains[a] > strains[b]; });
    ClampedResponse response;
    response.force_N.resize(strains.size());
    response.mid_width_mm.resize(strains.size());
    for (const std::size_t i : order) {
        const ClampedSheet::State state = clamped.hold({strains[i] * sample.length_mm, 0.0});
        const double unknown = std::numeric_limits<double>::quiet_NaN();
        response.force_N[i] = state.converged ? state.force.x() : unknown;
        response.mid_width_mm[i] = state.converged ? state.mid_width : unknown;
        response.converged = response.converged && state.converged;
    }
    return response;
}

}  // namespace ruche

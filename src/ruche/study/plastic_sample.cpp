#include "ruche/study/plastic_sample.hpp"

#include <limits>

#include "ruche/core/error.hpp"
#include "ruche/study/clamped_sheet.hpp"

namespace ruche {

PlasticResponse simulate_plastic(const PlasticSample& sample, const Material& material,
                                 std::span<const double> strains) {
    if (!(sample.length_mm > 0.0 && sample.width_mm > 0.0 && sample.thickness_mm > 0.0 &&
          sample.element_size_mm > 0.0))
        throw InputError({.key = "sample"}, "length, width, thickness and element size must be positive",
                         "Measure the printed strip.");
    ModelInput sheet;
    sheet.mesh = clamped_rectangle(sample.length_mm, sample.width_mm, sample.element_size_mm);
    // The laminate without its fabric: half of the plastic on each side, so that pulling does not bend it.
    const double half = 0.5 * sample.thickness_mm;
    sheet.print.assign(sheet.mesh.triangles.size(), {.front = half, .back = half});
    sheet.material = material;
    sheet.material.fabric_youngs_modulus = 0.0;
    sheet.material.fabric_thickness = 1e-3;
    sheet.prestretch = {1.0, 1.0};
    ClampedSheet clamped(std::move(sheet));

    PlasticResponse response;
    for (const double strain : strains) {
        const ClampedSheet::State state = clamped.hold({strain * sample.length_mm, 0.0});
        response.force_N.push_back(state.converged ? state.force.x()
                                                   : std::numeric_limits<double>::quiet_NaN());
        response.converged = response.converged && state.converged;
    }
    return response;
}

}  // namespace ruche

#include "ruche/study/virtual_test/hung_weights.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ruche {

/// Displacement at which a branch carries `force`: forces grow with displacement, so halving finds it.
static double displacement_under(double force, const TestBranch& branch, double largest) {
    double low = 0.0;
    double high = largest;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (branch.force(middle) < force ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

std::string hung_weights_csv(const VirtualCurve& curve, double rest_length, const VirtualMachine& machine,
                             NoiseSource& noise) {
    constexpr int steps = 8;
    constexpr double newton_per_gram = 9.80665e-3;
    const double largest = curve.displacement.back();
    const double full_force = *std::max_element(curve.force.begin(), curve.force.end());
    const TestBranch loading(curve, machine, machine.cycles - 1, true);
    const TestBranch unloading(curve, machine, machine.cycles - 1, false);
    std::normal_distribution<double> normal;
    std::string text = "mass_g,length_mm,width_mm,branch\n";
    for (int i = 0; i <= 2 * steps; ++i) {
        const bool adding = i <= steps;
        const double force = full_force * (adding ? i : 2 * steps - i) / steps;
        const double displacement = displacement_under(force, adding ? loading : unloading, largest);
        const double length = rest_length + displacement + machine.noise * largest * normal(noise);
        const double width =
            loading.width(displacement) + machine.noise * curve.width.front() * normal(noise);
        text += fmt::format("{:.2f},{:.2f},{:.2f},{}\n", force / newton_per_gram, length, width,
                            adding ? "loading" : "unloading");
    }
    return text;
}

}  // namespace ruche

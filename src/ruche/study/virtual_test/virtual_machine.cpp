#include "ruche/study/virtual_test/virtual_machine.hpp"

#include <algorithm>
#include <boost/math/interpolators/barycentric_rational.hpp>
#include <cmath>

namespace ruche {

template <>
std::span<const Field<VirtualMachine>> fields<VirtualMachine>() {
    using M = VirtualMachine;
    static constexpr std::string_view formats[] = {"plain", "bluehill", "zwick", "weights"};
    static const Field<M> table[] = {
        {"format", choice<&M::format>(formats), "", -infinity, infinity,
         "Kind of the CSV files: plain; bluehill as Instron's program writes it (quotes, a row of units); "
         "zwick as testXpert does in German (semicolons, decimal commas, Latin-1); weights: tension as a "
         "table of "
         "hung masses, the rest plain."},
        {"cycles", &M::cycles, "", 1, 100, "Cycles of loading and unloading."},
        {"speed_mm_per_min", &M::speed, "mm/min", 0.01, 1e5, "Speed of the moving clamp."},
        {"plastic_speed_mm_per_min", &M::plastic_speed, "mm/min", 0.01, 1e5,
         "Speed of the moving clamp when plastic is pulled."},
        {"sampling_hz", &M::sampling, "Hz", 0.01, 1e4, "Readings per second."},
        {"noise", &M::noise, "", 0, 1,
         "Standard deviation of force and width over the largest value of the test, and of what is read at a "
         "cantilever over its length."},
        {"hysteresis", &M::hysteresis, "", 0, 1,
         "Widest gap between loading and unloading over the largest force; the first cycle's is twice that."},
        {"seed", &M::seed, "", 0, 2147483647, "Seed of the noise; the same seed gives the same files."},
    };
    return table;
}

namespace {

/// Where the clamp is.
struct Motion {
    int stroke;    // loading, unloading, loading, ...
    double share;  // of the largest displacement
};

Motion motion_at(double time, double stroke_seconds, int strokes) {
    const int stroke = std::min(static_cast<int>(time / stroke_seconds), strokes - 1);
    const double share = std::clamp(time / stroke_seconds - stroke, 0.0, 1.0);
    return {stroke, stroke % 2 == 0 ? share : 1.0 - share};
}

std::function<double(double)> interpolant(const std::vector<double>& x, const std::vector<double>& y) {
    constexpr std::size_t order = 3;
    return boost::math::barycentric_rational<double>(x.data(), y.data(), x.size(), order);
}

double full_force(const VirtualCurve& curve) {
    return *std::max_element(curve.force.begin(), curve.force.end());
}

bool is_plastic(const VirtualCurve& curve) { return curve.test == "plastic"; }

}  // namespace

TestBranch::TestBranch(const VirtualCurve& curve, const VirtualMachine& machine, int cycle, bool loading)
    : clean_force_(interpolant(curve.displacement, curve.force)),
      largest_(curve.displacement.back()),
      lift_(machine.hysteresis * full_force(curve)) {
    if (!curve.width.empty()) clean_width_ = interpolant(curve.displacement, curve.width);
    if (is_plastic(curve))
        lift_ *= loading ? 0.0 : -1.0;
    else
        lift_ *= loading ? 1.0 + std::pow(0.5, cycle) : 0.0;
}

double TestBranch::force(double displacement) const {
    const double share = displacement / largest_;
    return clean_force_(displacement) + lift_ * 4.0 * share * (1.0 - share);
}

double TestBranch::width(double displacement) const {
    return clean_width_ ? clean_width_(displacement) : 0.0;
}

MachineRecord record(const VirtualCurve& curve, const VirtualMachine& machine, NoiseSource& noise) {
    const int strokes = 2 * (is_plastic(curve) ? 1 : machine.cycles);
    std::vector<TestBranch> branches;
    branches.reserve(static_cast<std::size_t>(strokes));
    for (int stroke = 0; stroke < strokes; ++stroke)
        branches.emplace_back(curve, machine, stroke / 2, stroke % 2 == 0);
    const double largest = curve.displacement.back();
    const double stroke_seconds =
        largest / ((is_plastic(curve) ? machine.plastic_speed : machine.speed) / 60.0);
    const double force_noise = machine.noise * full_force(curve);
    std::normal_distribution<double> normal;
    MachineRecord record;
    const auto count = static_cast<long>(std::floor(strokes * stroke_seconds * machine.sampling + 1e-9));
    for (long i = 0; i <= count; ++i) {
        const double time = static_cast<double>(i) / machine.sampling;
        const Motion at = motion_at(time, stroke_seconds, strokes);
        const double displacement = largest * at.share;
        record.time.push_back(time);
        record.displacement.push_back(displacement);
        record.force.push_back(branches[at.stroke].force(displacement) + force_noise * normal(noise));
        if (curve.width.empty()) continue;
        record.width.push_back(branches[at.stroke].width(displacement) +
                               machine.noise * curve.width.front() * normal(noise));
    }
    return record;
}

}  // namespace ruche

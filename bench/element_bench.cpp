#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <random>

#include "energy/oracle.hpp"
#include "ruche/energy/laminate_term.hpp"
#include "ruche/material/laminate.hpp"

namespace ruche::bench {
namespace {

constexpr double poissons_ratio = 0.4;
constexpr int unknowns = 21;

/// A printed triangle with printed neighbours on all sides (vertices 0-2, flaps 3-5, edge unknowns 6-8): what
/// nearly all elements of a fine mesh are.
LaminateTerm::Element inner_element() {
    using Kind = LaminateTerm::EdgeSide::Kind;
    LaminateTerm::Element element{.vertices = {0, 1, 2},
                                  .layout = {Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(0.4, 0.9)},
                                  .sides = {},
                                  .plies = {}};
    for (int i = 0; i < 3; ++i)
        element.sides[i] = {.kind = Kind::hinged, .flap = 3 + i, .unknown = 6 + i, .mean_altitude = 0.8};
    Mat2 edges;
    edges << element.layout[1] - element.layout[0], element.layout[2] - element.layout[0];
    const Mat2 metric = edges.transpose() * edges;
    element.plies =
        printed_plies({.front = 0.6, .fabric = 0.46, .front_modulus = 72.3, .fabric_modulus = 1.05}, metric,
                      metric / (1.7 * 1.7));
    return element;
}

/// A state of it: the layout, each flap beyond its edge, every unknown moved by up to 0.1 mm.
std::vector<double> random_state(const LaminateTerm::Element& element, std::mt19937& random) {
    const std::array<Vec2, 3>& corner = element.layout;
    std::array<Vec2, 6> flat{corner[0], corner[1], corner[2]};
    for (int i = 0; i < 3; ++i) flat[3 + i] = corner[(i + 1) % 3] + corner[(i + 2) % 3] - corner[i];
    std::uniform_real_distribution<double> noise(-0.1, 0.1);
    std::vector<double> x(unknowns);
    for (int v = 0; v < 6; ++v) {
        x[3 * v] = flat[v].x() + noise(random);
        x[3 * v + 1] = flat[v].y() + noise(random);
        x[3 * v + 2] = noise(random);
    }
    for (int k = 18; k < unknowns; ++k) x[k] = noise(random);
    return x;
}

test::Jet<unknowns> by_oracle(const test::LaminateElement& oracle, const std::vector<double>& x) {
    std::array<test::Jet<unknowns>, unknowns> jets;
    for (int i = 0; i < unknowns; ++i) jets[i] = test::Jet<unknowns>::unknown(i, x[i]);
    return oracle.energy(std::span<const test::Jet<unknowns>>(jets));
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Processor time of this thread: the clock would charge the slower one with what other programs take.
double thread_seconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Value, gradient and Hessian of one printed element on one thread, and in the same run the same by the
/// tests' automatic differentiation: `times_faster` is the ratio. By turns, medians over all: whatever else
/// the machine does hits both.
void laminate_element(benchmark::State& state) {
    const LaminateTerm::Element element = inner_element();
    const LaminateTerm term(poissons_ratio, {element});
    const test::LaminateElement oracle{element, poissons_ratio};
    constexpr int batch = 64;
    std::mt19937 random(1);
    std::vector<std::vector<double>> states;
    states.reserve(batch);
    for (int i = 0; i < batch; ++i) states.push_back(random_state(element, random));
    std::vector<double> own_seconds;
    std::vector<double> oracle_seconds;
    for (auto _ : state) {
        const double begin = thread_seconds();
        for (const std::vector<double>& x : states)
            benchmark::DoNotOptimize(term.evaluate(0, {x.data(), 6}, Order::hessian));
        const double middle = thread_seconds();
        for (const std::vector<double>& x : states) benchmark::DoNotOptimize(by_oracle(oracle, x));
        own_seconds.push_back(middle - begin);
        oracle_seconds.push_back(thread_seconds() - middle);
    }
    for (const std::vector<double>& x : states) {
        const Local<unknowns> own = term.evaluate(0, {x.data(), 6}, Order::hessian);
        const test::Jet<unknowns> exact = by_oracle(oracle, x);
        if (!own.full_hessian().isApprox(exact.hessian, 1e-10) ||
            !own.gradient.isApprox(exact.gradient, 1e-10))
            state.SkipWithError("the element and the oracle disagree");
    }
    const double own = median(own_seconds) / batch;
    const double exact = median(oracle_seconds) / batch;
    state.counters["element_ns"] = 1e9 * own;
    state.counters["oracle_ns"] = 1e9 * exact;
    state.counters["times_faster"] = exact / own;
}

BENCHMARK(laminate_element)->Iterations(200)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ruche::bench

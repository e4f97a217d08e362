#include <benchmark/benchmark.h>

#include "ruche/energy/model.hpp"
#include "sheet.hpp"

namespace ruche::bench {
namespace {

constexpr double radius_mm = 10.0;

/// One evaluation of the whole energy as far as `order` asks; the argument is the number of triangles.
void evaluate(benchmark::State& state, Order order) {
    const Model model(staggered_sheet(static_cast<int>(state.range(0))));
    const Eigen::VectorXd x = rolled_state(model, radius_mm);
    AssembledSums sums;
    double energy = 0.0;
    for (auto _ : state) benchmark::DoNotOptimize(energy = model.evaluate(x, order, sums).total());
    state.counters["unknowns"] = model.size();
    state.counters["energy_mJ"] = energy;
}

void set_up(benchmark::State& state) {
    const ModelInput input = staggered_sheet(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        const Model model(input);
        benchmark::DoNotOptimize(model.size());
    }
}

void sizes(benchmark::internal::Benchmark* bench) {
    bench->Arg(5000)->Arg(20000)->Arg(80000)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK_CAPTURE(evaluate, energy, Order::value)->Name("energy")->Apply(sizes);
BENCHMARK_CAPTURE(evaluate, gradient, Order::gradient)->Name("gradient")->Apply(sizes);
BENCHMARK_CAPTURE(evaluate, hessian, Order::hessian)->Name("hessian")->Apply(sizes);
BENCHMARK_CAPTURE(evaluate, gauss_newton, Order::gauss_newton)->Name("gauss_newton")->Apply(sizes);
BENCHMARK(set_up)->Name("model_set_up")->Apply(sizes);

}  // namespace
}  // namespace ruche::bench

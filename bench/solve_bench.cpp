#include <benchmark/benchmark.h>
#include <cholmod.h>

#include "ruche/energy/model.hpp"
#include "ruche/statics/equilibrium.hpp"
#include "ruche/statics/sparse_cholesky.hpp"
#include "sheet.hpp"

namespace ruche::bench {
namespace {

/// The lower triangle's values of a positive definite matrix with the Hessian's pattern: the Gauss-Newton
/// form of the flat sheet, with a little stiffness against rigid motions on the diagonal.
std::vector<double> positive_definite_values(const Model& model) {
    AssembledSums sums;
    model.evaluate(model.initial(), Order::gauss_newton, sums);
    for (int column = 0; column < model.size(); ++column) {
        const int begin = model.pattern().column_start()[column];
        const int end = model.pattern().column_start()[column + 1];
        for (int k = begin; k < end; ++k) {
            if (model.pattern().row_index()[k] == column) sums.hessian[k] += 1e-3;
        }
    }
    return sums.hessian;
}

/// Ordering and symbolic analysis: once per mesh.
void analyse(benchmark::State& state) {
    const Model model(staggered_sheet(static_cast<int>(state.range(0))));
    for (auto _ : state) {
        const SparseCholesky cholesky(model, vertex_elimination_order(model.pattern()));
        benchmark::DoNotOptimize(&cholesky);
    }
}

/// One numerical factorisation: the floor of a Newton step.
void factorize(benchmark::State& state) {
    const Model model(staggered_sheet(static_cast<int>(state.range(0))));
    const std::vector<double> values = positive_definite_values(model);
    SparseCholesky cholesky(model, vertex_elimination_order(model.pattern()));
    for (auto _ : state) {
        if (!cholesky.factorize(values)) state.SkipWithError("the matrix is not positive definite");
    }
    state.counters["unknowns"] = model.size();
    state.counters["factor_MB"] = cholesky.factor_megabytes();
}

/// The same matrix by CHOLMOD alone, ordered by METIS, as most programs have it: what a floor is elsewhere.
void factorize_by_cholmod(benchmark::State& state) {
    const Model model(staggered_sheet(static_cast<int>(state.range(0))));
    std::vector<double> values = positive_definite_values(model);
    cholmod_sparse matrix{};
    matrix.nrow = matrix.ncol = static_cast<std::size_t>(model.size());
    matrix.nzmax = values.size();
    // CHOLMOD's interface has no const; it only reads.
    matrix.p = const_cast<int*>(model.pattern().column_start().data());
    matrix.i = const_cast<int*>(model.pattern().row_index().data());
    matrix.x = values.data();
    matrix.stype = -1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_REAL;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;
    cholmod_common common;
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    cholmod_factor* factor = cholmod_analyze(&matrix, &common);
    for (auto _ : state) {
        cholmod_factorize(&matrix, factor, &common);
        if (common.status != CHOLMOD_OK) state.SkipWithError("the matrix is not positive definite");
    }
    state.counters["unknowns"] = model.size();
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
}

/// From the flat printed state to the certified shape. `energy_mJ` tells whether two runs did the same work.
void release(benchmark::State& state) {
    const Model model(staggered_sheet(static_cast<int>(state.range(0))));
    Equilibrium last;
    for (auto _ : state) last = solve(model);
    if (last.status != SolveStatus::converged || !last.stable) state.SkipWithError(last.message.c_str());
    state.counters["iterations"] = last.iterations;
    state.counters["factorizations"] = last.factorizations;
    state.counters["energy_mJ"] = last.energy.total();
}

void sizes(benchmark::internal::Benchmark* bench) {
    bench->Arg(5000)->Arg(20000)->Arg(80000)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(analyse)->Name("analyse")->Apply(sizes);
BENCHMARK(factorize)->Name("factorize")->Apply(sizes);
BENCHMARK(factorize_by_cholmod)->Name("factorize_by_cholmod")->Apply(sizes);
BENCHMARK(release)->Name("release")->Apply(sizes)->Iterations(1);

}  // namespace
}  // namespace ruche::bench

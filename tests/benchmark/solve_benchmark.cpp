// SPDX-License-Identifier: GPL-3.0-or-later

// One static solve to 1e-6 from nothing: set-up, iterations, time and memory by solver, size and Poisson's ratio.

#include <benchmark/benchmark.h>

#include <chrono>

#include "bodies.h"
#include "mechanics/static_solve.h"

namespace glisson::mechanics::bench {
namespace {

enum Method { Auto, Multigrid, JacobiCg, BlockJacobiCg, PlainCg, Factorised };

SolverOptions optionsOf(Method method) {
  SolverOptions o;
  o.tolerance = 1e-6;
  o.kind = method == Auto         ? SolverKind::Auto
           : method == Multigrid  ? SolverKind::Multigrid
           : method == Factorised ? SolverKind::Factorised
                                  : SolverKind::Cg;
  o.preconditioner = method == PlainCg    ? Preconditioner::None
                     : method == JacobiCg ? Preconditioner::Jacobi
                                          : Preconditioner::BlockJacobi;
  return o;
}

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// First and second solve (another load) of one solver.
void measure(benchmark::State& state, const Problem& p, Method method) {
  const NodalField other = contacts(p, 3).back();
  SolveReport first, second;
  double setup = 0, peak = 0;
  int dofs = 0;
  for (auto _ : state) {
    resetPeak();
    const double before = resident_MB();
    const auto start = std::chrono::steady_clock::now();
    StaticSolver solver(p.body, p.supports, optionsOf(method));
    setup = since(start);
    first = solver.solve(p.f_N).report;
    state.SetIterationTime(since(start));
    peak = peak_MB() - before;
    second = solver.solve(other).report;
    dofs = solver.mesh().nodeCount() * 3;
  }
  state.SetLabel(first.kind + (first.converged() ? "" : ", NOT CONVERGED"));
  state.counters["dofs"] = dofs;
  state.counters["iterations"] = first.iterations;
  state.counters["residual"] = first.residual;
  state.counters["body_s"] = setup;
  state.counters["solve_s"] = first.seconds;
  state.counters["next_s"] = second.seconds;
  state.counters["peak_MB"] = peak;
}

template <Method method>
void solve(benchmark::State& state) {
  measure(state, liver(static_cast<int>(state.range(0)), 0.001 * static_cast<double>(state.range(1))), method);
}
template <Method method>
void slices(benchmark::State& state) {
  measure(state, liver(static_cast<int>(state.range(0)), 0.001 * static_cast<double>(state.range(1)), 0.010), method);
}
template <Method method>
void tumour(benchmark::State& state) {
  measure(state,
          liverWithTumour(static_cast<int>(state.range(0)), 0.001 * static_cast<double>(state.range(1)),
                          static_cast<double>(state.range(2))),
          method);
}

/// Multigrid on clamped boxes: edges in cells, Poisson's ratio in ten thousandths, element, contrast of a ball inside.
void sweep(benchmark::State& state) {
  const Problem p = clampedBox(static_cast<int>(state.range(0)), 1e-4 * static_cast<double>(state.range(1)),
                               static_cast<double>(state.range(3)));
  SolverOptions o = optionsOf(Multigrid);
  o.element = state.range(2) == 0 ? HexElement::Incompatible : state.range(2) == 1 ? HexElement::BBar : HexElement::H8;
  SolveReport report;
  for (auto _ : state) report = solveStatic(p, o).report;
  state.SetLabel(report.converged() ? "converged" : "NOT CONVERGED");
  state.counters["iterations"] = report.iterations;
  state.counters["residual"] = report.residual;
}
BENCHMARK(sweep)
    ->ArgNames({"cells", "nu_10000", "element", "contrast"})
    ->ArgsProduct({{16, 32, 48, 64, 72, 76, 96, 128},
                   {0, 3000, 3500, 4000, 4300, 4500, 4900, 4950, 4990, 4999},
                   {0, 1, 2},
                   {1, 10, 1000, 1000000}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

void named(benchmark::internal::Benchmark* b, int largest) {
  b->ArgNames({"dofs", "nu_1000"})->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(1);
  for (const int dofs : {1000, 3000, 6000, 10000, 30000, 45000, 100000, 300000, 1080000})
    for (const int nu : {300, 450, 490})
      if (dofs <= largest) b->Args({dofs, nu});
}
void upToAMillion(benchmark::internal::Benchmark* b) {
  named(b, 2000000);
}
void upTo60k(benchmark::internal::Benchmark* b) {
  named(b, 60000);
}
BENCHMARK(solve<Auto>)->Apply(upToAMillion);
BENCHMARK(solve<Multigrid>)->Apply(upToAMillion);
BENCHMARK(solve<JacobiCg>)->Apply(upToAMillion);
BENCHMARK(solve<BlockJacobiCg>)->Apply(upToAMillion);
BENCHMARK(solve<PlainCg>)->Apply(upToAMillion);
BENCHMARK(solve<Factorised>)->Apply(upTo60k);
BENCHMARK(slices<Multigrid>)->Apply([](benchmark::internal::Benchmark* b) { named(b, 300000); });

void hard(benchmark::internal::Benchmark* b) {
  b->ArgNames({"dofs", "nu_1000", "contrast"})->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(1);
  b->ArgsProduct({{1000, 5000, 20000, 45000, 150000}, {450, 490, 499}, {1, 100, 10000, 1000000}});
}
BENCHMARK(tumour<Auto>)->Apply(hard);
BENCHMARK(tumour<Multigrid>)->Apply(hard);

}  // namespace
}  // namespace glisson::mechanics::bench

// SPDX-License-Identifier: GPL-3.0-or-later

// Online part of the condensed model: one dense product per evaluation, and one reduced implicit Euler step.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "bodies.h"
#include "mechanics/condensed.h"

namespace glisson::mechanics::bench {
namespace {

constexpr int inputs = 12;

/// Every node where `landmarks` is 0, else that many nodes.
std::vector<Landmark> chosen(const VoxelMesh& mesh, int landmarks) {
  std::vector<Landmark> all = everyNode(mesh);
  if (landmarks == 0) return all;
  std::vector<Landmark> some;
  for (int l = 0; l < landmarks; ++l)
    some.push_back(all[static_cast<std::size_t>(l) * all.size() / static_cast<std::size_t>(landmarks)]);
  return some;
}

void evaluate(benchmark::State& state) {
  const Problem p = liver(static_cast<int>(state.range(0)), 0.45);
  SolverOptions o;
  o.tolerance = 1e-6;
  StaticSolver solver(p.body, p.supports, o);
  const CondensedModel model(solver, contacts(p, inputs), chosen(solver.mesh(), static_cast<int>(state.range(1))));
  Eigen::VectorXd amount = Eigen::VectorXd::LinSpaced(inputs, 0.1, 1.0);
  Eigen::VectorXd u(3 * model.landmarks());
  for (auto _ : state) {
    benchmark::DoNotOptimize(amount.data());
    model.evaluate(amount, u);
    benchmark::DoNotOptimize(u.data());
    benchmark::ClobberMemory();
  }
  const double bytes = 8.0 * static_cast<double>(model.response().size() + u.size());
  state.counters["landmarks"] = model.landmarks();
  state.counters["MB"] = 1e-6 * bytes;
  state.counters["GB/s"] = benchmark::Counter(1e-9 * bytes, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(evaluate)
    ->ArgNames({"dofs", "landmarks"})
    ->Unit(benchmark::kMicrosecond)
    ->Args({1000, 100})
    ->Args({30000, 2000})
    ->Args({142500, 2000})
    ->Args({142500, 0});

void dynamicStep(benchmark::State& state) {
  const Problem p = liver(static_cast<int>(state.range(0)), 0.45);
  SolverOptions o;
  o.tolerance = 1e-10;
  StaticSolver solver(p.body, p.supports, o);
  CondensedDynamicOptions dynamic;
  dynamic.h_s = 1e-2;
  CondensedDynamics model(solver, contacts(p, static_cast<int>(state.range(1))), chosen(solver.mesh(), 200), dynamic);
  const Eigen::VectorXd amount = Eigen::VectorXd::Constant(model.inputs(), 0.3);
  Eigen::VectorXd u;
  for (auto _ : state) {
    model.step(amount);
    model.evaluate(u);
    benchmark::DoNotOptimize(u.data());
  }
  state.counters["vectors"] = model.size();
}
BENCHMARK(dynamicStep)
    ->ArgNames({"dofs", "inputs"})
    ->Unit(benchmark::kMicrosecond)
    ->Args({1000, 1})
    ->Args({30000, 1})
    ->Args({30000, 12});

}  // namespace
}  // namespace glisson::mechanics::bench

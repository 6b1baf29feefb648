// SPDX-License-Identifier: GPL-3.0-or-later

// One implicit Euler step: of the mesh-free frames, and of the voxel FEM by solver and time step.

#include <benchmark/benchmark.h>

#include "bodies.h"
#include "mechanics/dynamics.h"

namespace glisson::mechanics::bench {
namespace {

constexpr int steps = 20;

/// Mean cost of a step after the load was applied at once; the first steps count as the others do.
void measure(benchmark::State& state, DynamicSystem& system, const Eigen::VectorXd& f, double h_s) {
  DynamicOptions options;
  options.h_s = h_s;
  options.end_s = steps * h_s;
  options.rayleighBeta_s = 1e-3;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  Trajectory t;
  for (auto _ : state) t = integrate(system, f, zero, zero, options);
  state.counters["step_ms"] =
      benchmark::Counter(1e-3 * steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["dofs"] = static_cast<double>(system.size());
  state.counters["iterations"] = t.worst.iterations;
  state.counters["residual"] = t.worst.residual;
  state.SetLabel(t.worst.kind + (t.worst.converged() ? "" : ", NOT CONVERGED"));
}

/// 200 frames as published (conjugate gradients, at most 200 iterations) and with the factor made once.
void frames(benchmark::State& state) {
  const Problem p = liver(40000, 0.45);
  MeshfreeOptions options;
  options.frames = static_cast<int>(state.range(0)) / 12;
  const MeshfreeModel model(p, options);
  SolverOptions solver;
  if (state.range(1) != 0) {
    solver.kind = SolverKind::Cg;
    solver.preconditioner = Preconditioner::None;
    solver.iterations = 200;
  }
  MatrixSystem system(model.K(), model.M(), solver, model.borders());
  measure(state, system, model.load(p.f_N), 1e-2);
}
BENCHMARK(frames)
    ->ArgNames({"dofs", "as_published"})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{1000, 2400}, {0, 1}});

enum Method { Auto, BlockJacobiCg, Multigrid };

template <Method method>
void voxels(benchmark::State& state) {
  const Problem p = liver(static_cast<int>(state.range(0)), 0.45);
  SolverOptions solver;
  solver.tolerance = 1e-6;
  solver.kind = method == Auto ? SolverKind::Auto : method == Multigrid ? SolverKind::Multigrid : SolverKind::Cg;
  solver.preconditioner = Preconditioner::BlockJacobi;
  VoxelSystem system(std::make_shared<const VoxelOperator>(p.body, solver.element, p.supports), solver);
  measure(state, system, Eigen::Map<const Eigen::VectorXd>(p.f_N.data(), p.f_N.size()),
          1e-3 * static_cast<double>(state.range(1)));
}
void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"dofs", "h_ms"})->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);
  for (const int dofs : {1000, 10000, 100000})
    for (const int h_ms : {1, 10, 100}) b->Args({dofs, h_ms});
}
/// A clamped cube under a sudden traction, edges in cells, processor time.
void voxelCube(benchmark::State& state) {
  const Problem p = clampedBox(static_cast<int>(state.range(0)), 0.45, 1);
  VoxelSystem system(std::make_shared<const VoxelOperator>(p.body, HexElement::Incompatible, p.supports));
  measure(state, system, Eigen::Map<const Eigen::VectorXd>(p.f_N.data(), p.f_N.size()),
          1e-3 * static_cast<double>(state.range(1)));
}
BENCHMARK(voxelCube)
    ->ArgNames({"cells", "h_ms"})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->ArgsProduct({{34}, {1, 10}});

BENCHMARK(voxels<Auto>)->Apply(sizes);
BENCHMARK(voxels<BlockJacobiCg>)->Apply(sizes);
BENCHMARK(voxels<Multigrid>)->Apply(sizes);

}  // namespace
}  // namespace glisson::mechanics::bench

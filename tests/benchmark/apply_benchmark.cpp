// SPDX-License-Identifier: GPL-3.0-or-later

// Products K u of the matrix-free voxel operator against the memory bandwidth of the machine.

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "bodies.h"
#include "mechanics/voxel_operator.h"

namespace glisson::mechanics::bench {
namespace {

template <class T>
void apply(benchmark::State& state) {
  setThreadCount(static_cast<int>(state.range(1)));
  const Problem p = liver(static_cast<int>(state.range(0)), 0.45);
  const VoxelOperator op(p.body, HexElement::Incompatible, p.supports);
  LatticeOperator<T> A;
  A.lattice = op.lattice().lattice;
  A.blocks = RowBlocks<T>(walshBlocks(op.K0()));
  A.E = cellSlotsOf<T>(*A.lattice, p.body.E_Pa, 1 / 6e3);
  std::vector<T> x(A.size(), T{1}), y(A.size());
  for (auto _ : state) {
    A.applyCells(x.data(), y.data());
    benchmark::DoNotOptimize(y.data());
    benchmark::ClobberMemory();
  }
  // Least traffic: x is read, y written, the moduli read, each once.
  const double bytes = static_cast<double>((2 * A.size() + A.E.size()) * sizeof(T));
  const auto rate = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["dofs"] = op.dofs();
  state.counters["Mdof/s"] = benchmark::Counter(1e-6 * op.dofs(), rate);
  state.counters["GB/s"] = benchmark::Counter(1e-9 * bytes, rate);
  const double bandwidth = triadBytesPerSecond();
  state.counters["triad_GB/s"] = 1e-9 * bandwidth;
  state.counters["bound_%"] = benchmark::Counter(100 * bytes / bandwidth, rate);
  setThreadCount(0);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"dofs", "threads"})->UseRealTime()->Unit(benchmark::kMicrosecond);
  for (const int dofs : {1000, 10000, 100000, 1080000})
    for (const int threads : {1, 2}) b->Args({dofs, threads});
}
BENCHMARK(apply<float>)->Apply(sizes);
BENCHMARK(apply<double>)->Apply(sizes);

}  // namespace
}  // namespace glisson::mechanics::bench

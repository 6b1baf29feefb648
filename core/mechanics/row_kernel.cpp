// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/row_kernel.h"

#include <utility>

#include "mechanics/vector_lanes.h"

namespace glisson::mechanics {
namespace {

template <class T, int Bytes, bool WithMass>
GLISSON_INLINE void addRowOf(const RowTask<T>& task, const RowBlocks<T>& blocks) {
  using V = typename VectorOf<T, Bytes>::type;
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(T);
  V carry[4][3] = {};
  for (std::size_t i = 0; i < task.n; i += lanes) {
    V w[2][4][3];
    loadRows(task, i, w);
    transformRows(w);
    const V E = load<V>(task.E + i);
    V rho = {};
    if constexpr (WithMass) rho = load<V>(task.rho + i);
#pragma GCC unroll 8
    for (int p = 0; p < 8; ++p) {
      const auto& B = blocks.b[static_cast<std::size_t>(p)];
      // Component c of block p is Walsh mode p ⊕ 2^c: bit 0 along x, bits 1 and 2 along y and z.
      V& x = w[(p ^ 1) & 1][(p ^ 1) >> 1][0];
      V& y = w[(p ^ 2) & 1][(p ^ 2) >> 1][1];
      V& z = w[(p ^ 4) & 1][(p ^ 4) >> 1][2];
      const V fx = B[0] * x + B[1] * y + B[2] * z;
      const V fy = B[1] * x + B[3] * y + B[4] * z;
      const V fz = B[2] * x + B[4] * y + B[5] * z;
      if constexpr (WithMass) {
        const auto at = static_cast<std::size_t>(p);
        x = E * fx + rho * (blocks.mass[at ^ 1] * x);
        y = E * fy + rho * (blocks.mass[at ^ 2] * y);
        z = E * fz + rho * (blocks.mass[at ^ 4] * z);
      } else {
        x = E * fx;
        y = E * fy;
        z = E * fz;
      }
    }
    transformRows(w);
    storeRows<lanes>(task, i, w, carry);
  }
  storeLastNode<lanes>(task, carry);
}

template <class T, int Bytes>
GLISSON_INLINE void addRowWith(const RowTask<T>& task, const RowBlocks<T>& blocks) {
  if (task.rho != nullptr)
    addRowOf<T, Bytes, true>(task, blocks);
  else
    addRowOf<T, Bytes, false>(task, blocks);
}

template <class T>
void addRowPortable(const RowTask<T>& task, const RowBlocks<T>& blocks) {
  addRowWith<T, 16>(task, blocks);
}

#if defined(__x86_64__)
template <class T>
__attribute__((target("arch=x86-64-v3"))) void addRowAvx2(const RowTask<T>& task, const RowBlocks<T>& blocks) {
  addRowWith<T, 32>(task, blocks);
}

template <class T>
GLISSON_AVX512 void addRowAvx512(const RowTask<T>& task, const RowBlocks<T>& blocks) {
  addRowWith<T, 64>(task, blocks);
}
#endif

template <class T>
auto fastestRow() {
#if defined(__x86_64__)
  switch (instructionSet()) {
    case InstructionSet::Avx512: return &addRowAvx512<T>;
    case InstructionSet::Avx2: return &addRowAvx2<T>;
    default: break;
  }
#endif
  return &addRowPortable<T>;
}

}  // namespace

template <class T>
RowBlocks<T>::RowBlocks(const std::array<Eigen::Matrix3d, 8>& walsh, const std::array<double, 8>& masses) {
  for (std::size_t p = 0; p < 8; ++p) {
    const Eigen::Matrix3d& B = walsh[p];
    const std::array<double, 6> values = {B(0, 0), B(0, 1), B(0, 2), B(1, 1), B(1, 2), B(2, 2)};
    for (std::size_t v = 0; v < 6; ++v) b[p][v] = static_cast<T>(values[v]);
    mass[p] = static_cast<T>(masses[p]);
  }
}

template <class T>
void addRow(const RowTask<T>& task, const RowBlocks<T>& blocks) {
  static const auto row = fastestRow<T>();
  row(task, blocks);
}

template struct RowBlocks<float>;
template struct RowBlocks<double>;
template void addRow<float>(const RowTask<float>&, const RowBlocks<float>&);
template void addRow<double>(const RowTask<double>&, const RowBlocks<double>&);

}  // namespace glisson::mechanics

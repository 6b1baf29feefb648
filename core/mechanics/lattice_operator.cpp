// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/lattice_operator.h"

#include <algorithm>

#include "base/parallel.h"
#include "mechanics/row_sweep.h"

namespace glisson::mechanics {

template <class T>
void LatticeOperator<T>::applyCells(const T* x, T* y) const {
  const RowLattice& L = *lattice;
  const std::size_t n = L.nodeSlots();
  const auto clear = [&](int from, int to) {  // node layers [from, to)
    const std::size_t a = L.layerBegin(from);
    const std::size_t b = L.layerBegin(to);
    for (std::size_t c = 0; c < 3; ++c) std::fill(y + c * n + a, y + c * n + b, T{0});
  };
  const auto addLayer = [&](int k) {
    RowTask<T> task;
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& row = L.cellRow(j, k);
      if (row.length == 0) continue;
      for (int r = 0; r < 4; ++r) {
        const std::size_t s = L.slot(row.begin, j + (r & 1), k + (r >> 1));
        for (std::size_t c = 0; c < 3; ++c) {
          task.in[r][c] = x + c * n + s;
          task.out[r][c] = y + c * n + s;
        }
      }
      task.E = E.data() + row.offset;
      task.rho = rho.empty() ? nullptr : rho.data() + row.offset;
      task.n = static_cast<std::size_t>(row.length);
      addRow(task, blocks);
    }
  };
  sweepLayers(L, clear, addLayer);
}

template <class T>
void LatticeOperator<T>::addSprings(const T* x, T* y) const {
  const std::size_t n = lattice->nodeSlots();
  parallelChunks(springs.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const auto& [slot, k] = springs[s];
      const T a = x[slot];
      const T b = x[n + slot];
      const T c = x[2 * n + slot];
      y[slot] += k[0] * a + k[1] * b + k[2] * c;
      y[n + slot] += k[1] * a + k[3] * b + k[4] * c;
      y[2 * n + slot] += k[2] * a + k[4] * b + k[5] * c;
    }
  });
}

template <class T>
void LatticeOperator<T>::project(T* y) const {
  for (const std::size_t f : fixed) y[f] = T{0};
}

template <class T>
std::vector<T> cellSlotsOf(const RowLattice& lattice, const std::vector<double>& E, double factor) {
  std::vector<T> slots(lattice.cellSlots(), T{0});
  const int nx = lattice.cells().x();
  std::size_t r = 0;
  for (int k = 0; k < lattice.cells().z(); ++k)
    for (int j = 0; j < lattice.cells().y(); ++j, ++r) {
      const RowLattice::Row& row = lattice.cellRow(j, k);
      const int count = std::min(row.length, nx - row.begin);
      for (int i = 0; i < count; ++i)
        slots[row.offset + static_cast<std::size_t>(i)] =
            static_cast<T>(factor * E[r * static_cast<std::size_t>(nx) + static_cast<std::size_t>(row.begin + i)]);
    }
  return slots;
}

template struct LatticeOperator<float>;
template struct LatticeOperator<double>;
template std::vector<float> cellSlotsOf<float>(const RowLattice&, const std::vector<double>&, double);
template std::vector<double> cellSlotsOf<double>(const RowLattice&, const std::vector<double>&, double);

}  // namespace glisson::mechanics

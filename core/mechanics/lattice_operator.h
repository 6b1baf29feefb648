// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "mechanics/row_kernel.h"
#include "mechanics/row_lattice.h"

namespace glisson::mechanics {

/// K of a voxel body on RowLattice storage, T = float or double: y = P (Σ (E_e K₀ + rho_e M₀) + springs) x, P = zero at
/// fixed degrees of freedom; the mass is there for implicit time steps. Arrays have 3 nodeSlots() values; x is 0 at
/// fixed degrees of freedom. Thread-parallel, the same bits with any number of threads.
template <class T>
struct LatticeOperator {
  /// A spring at a node slot: a symmetric 3 × 3 matrix.
  struct SlotSpring {
    std::size_t slot = 0;
    std::array<T, 6> k{};  ///< xx xy xz yy yz zz
  };

  std::shared_ptr<const RowLattice> lattice;
  RowBlocks<T> blocks;
  std::vector<T> E;                 ///< per cell slot
  std::vector<T> rho;               ///< likewise, or empty: no mass
  std::vector<SlotSpring> springs;  ///< at most one per slot, by slot
  std::vector<std::size_t> fixed;   ///< positions in the 3 nodeSlots() array, ascending

  std::size_t size() const { return 3 * lattice->nodeSlots(); }
  /// y = Σ (E_e K₀ + rho_e M₀) x, without supports.
  void applyCells(const T* x, T* y) const;
  /// y += springs x.
  void addSprings(const T* x, T* y) const;
  /// y = 0 at fixed degrees of freedom.
  void project(T* y) const;
  void apply(const T* x, T* y) const {
    applyCells(x, y);
    addSprings(x, y);
    project(y);
  }
};

/// Moduli of the body's cells laid out in the lattice's cell slots (padding 0), times a factor.
template <class T>
std::vector<T> cellSlotsOf(const RowLattice& lattice, const std::vector<double>& E, double factor);

}  // namespace glisson::mechanics

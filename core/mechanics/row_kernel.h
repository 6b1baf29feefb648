// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace glisson::mechanics {

/// The eight symmetric 3×3 Walsh blocks of K₀ as xx xy xz yy yz zz (see walshBlocks in hex_element.h), and the eight
/// Walsh values of a mass matrix that is the same for each component (see walshValues), by mode.
template <class T>
struct RowBlocks {
  std::array<std::array<T, 6>, 8> b{};
  std::array<T, 8> mass{};
  RowBlocks() = default;
  explicit RowBlocks(const std::array<Eigen::Matrix3d, 8>& walsh, const std::array<double, 8>& masses = {});
};

/// One row of cells along x and the four node rows it touches, at (j, k), (j + 1, k), (j, k + 1), (j + 1, k + 1).
template <class T>
struct RowTask {
  const T* in[4][3];  ///< per node row and component, at the row's first cell; n + 1 values
  T* out[4][3];       ///< the same for the result, which is added to
  const T* E;         ///< n moduli
  const T* rho;       ///< n densities, or null: no mass
  std::size_t n = 0;  ///< cells, a multiple of RowLattice::pad
};

/// out += Σ over the row's cells of (E_e K₀ + rho_e M₀) in. The instruction set is chosen once, at run time.
template <class T>
void addRow(const RowTask<T>& task, const RowBlocks<T>& blocks);

}  // namespace glisson::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mechanics/row_lattice.h"

namespace glisson::mechanics {

/// Which axes a coarser lattice halves; an odd count of cells is completed with an empty one.
using Halved = std::array<bool, 3>;

/// Cells of the coarser lattice, and its moduli: mean over the cells that a coarse cell covers, empty ones count as 0.
Eigen::Vector3i coarserCells(const Eigen::Vector3i& cells, const Halved& halved);
std::vector<double> coarserModuli(const Eigen::Vector3i& cells, const std::vector<double>& E, const Halved& halved);

/// Up to two coarse nodes that a fine one lies on or between along one axis, with their weights (1, or ½ and ½).
struct Parents {
  int count = 0;
  std::array<int, 2> node{};
  std::array<double, 2> weight{};
  Parents(int fine, bool halved);
};

/// Calls f(fine slot, coarse slot, weight) for every node slot of the fine lattice and each coarse node that it
/// interpolates from. A parent outside the coarse rows (of a slot without node) is passed over.
template <class F>
void forParentsOfNodes(const RowLattice& fine, const RowLattice& coarse, const Halved& halved, const F& f) {
  for (int k = 0; k <= fine.cells().z(); ++k)
    for (int j = 0; j <= fine.cells().y(); ++j) {
      const RowLattice::Row& row = fine.nodeRow(j, k);
      const Parents js(j, halved[1]), ks(k, halved[2]);
      for (int n = 0; n < row.length; ++n) {
        const Parents is(row.begin + n, halved[0]);
        for (std::size_t c = 0; c < static_cast<std::size_t>(ks.count); ++c)
          for (std::size_t b = 0; b < static_cast<std::size_t>(js.count); ++b) {
            const RowLattice::Row& parents = coarse.nodeRow(js.node[b], ks.node[c]);
            for (std::size_t a = 0; a < static_cast<std::size_t>(is.count); ++a)
              if (is.node[a] >= parents.begin && is.node[a] < parents.begin + parents.length)
                f(row.offset + static_cast<std::size_t>(n),
                  parents.offset + static_cast<std::size_t>(is.node[a] - parents.begin),
                  is.weight[a] * js.weight[b] * ks.weight[c]);
          }
      }
    }
}

/// coarse = Pᵀ fine (overwritten); P is trilinear interpolation. Arrays as LatticeOperator<float> has them.
void restrictTo(const RowLattice& coarse, const RowLattice& fine, const Halved& halved, const float* r_fine,
                float* r_coarse);

/// fine = P coarse where mask ≠ 0, else 0 (overwritten).
void prolongTo(const RowLattice& fine, const RowLattice& coarse, const Halved& halved, const float* x_coarse,
               const float* mask_fine, float* x_fine);

}  // namespace glisson::mechanics

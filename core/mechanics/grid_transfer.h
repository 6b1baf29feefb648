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

/// coarse = Pᵀ fine (overwritten); P is trilinear interpolation. Arrays as LatticeOperator<float> has them.
void restrictTo(const RowLattice& coarse, const RowLattice& fine, const Halved& halved, const float* r_fine,
                float* r_coarse);

/// fine = P coarse where mask ≠ 0, else 0 (overwritten).
void prolongTo(const RowLattice& fine, const RowLattice& coarse, const Halved& halved, const float* x_coarse,
               const float* mask_fine, float* x_fine);

}  // namespace glisson::mechanics

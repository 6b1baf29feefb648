// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "mechanics/grid_transfer.h"
#include "mechanics/hex_element.h"
#include "mechanics/lattice_operator.h"

namespace glisson::mechanics {

/// What the next coarser level is made from, scaled so that moduli and edges are of order 1.
struct LevelGeometry {
  Eigen::Vector3i cells = Eigen::Vector3i::Zero();
  Eigen::Vector3d h = Eigen::Vector3d::Zero();
  std::vector<double> E;
  std::vector<double> rho;  ///< per cell like E, or empty: no mass
};

/// One level of the hierarchy: operator, smoother, work arrays. Arrays have A.size() values.
struct MultigridLevel {
  LevelGeometry geometry;
  HexMatrix K0;
  Eigen::Matrix<double, 8, 8> M0;
  LatticeOperator<double> exact;  ///< kept for set-up and for the coarsest level only
  LatticeOperator<float> A;
  Halved halved{};                     ///< how the next level is made from this one
  std::vector<float> inverseDiagonal;  ///< 0 at fixed degrees of freedom and slots without a node
  double lambdaMax = 0;                ///< not below the largest eigenvalue of D⁻¹ A (spectral_bound.h)
  int dofs = 0;                        ///< active
  std::vector<float> x, r, d, y;

  /// Diagonal and float copies, from geometry and exact.{springs, fixed}.
  void finish();
  /// lambdaMax: the bound over single cells, which always holds, or the sharper one by iteration.
  void bound(bool byCells);
  /// x = smoother applied to r from 0, or continued from x; r becomes the residual; degree applications of A. The error
  /// along an eigenvector of D⁻¹ A is multiplied by a number between −1 and 1, so that a cycle made of smoothers is
  /// positive definite.
  void smooth(bool fromZero, int degree, double smoothed, bool keepResidual);
};

/// Lattice, moduli and element of a level; springs and fixed degrees of freedom still empty.
MultigridLevel makeLevel(LevelGeometry geometry, HexElement element, double poisson);

/// The next coarser level of `fine`; fine.halved is set. Fixed: coarse degrees of freedom that coincide with a fixed
/// one, or whose interpolation reaches no free one. Fixed nodes between coarse nodes become springs of their own
/// stiffness.
MultigridLevel coarsen(MultigridLevel& fine, HexElement element, double poisson);

}  // namespace glisson::mechanics

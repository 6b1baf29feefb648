// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "base/progress.h"
#include "mechanics/kernel.h"
#include "mechanics/meshfree_clamp.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Which shape functions are used: number of the function wᵢ P_b at [frame × functions + b], −1 where it was left out
/// because the voxel nodes cannot tell it from the others of its frame. Degrees of freedom are 3 × number + axis.
struct ActiveFunctions {
  std::vector<int> number;
  int count = 0;
};

/// Rank check by frame: Cholesky of the Gram matrix of P over the frame's free nodes, in the order of P; a function
/// whose pivot falls below 1e-10 of its square is a combination of the earlier ones there and is left out without loss.
ActiveFunctions activeFunctions(const VoxelMesh& mesh, const FrameBasis& basis, const Clamp& clamp);

/// Stiffness and mass of the active functions.
struct ReducedMatrices {
  Eigen::SparseMatrix<double> K_N_m;  ///< n × n, symmetric to the last bit, positive semi-definite, springs included
  Eigen::SparseMatrix<double> M_kg;   ///< n × n, symmetric to the last bit, positive definite
};

/// Galerkin projection of the voxel FEM: K_r = Φᵀ D K_h D Φ and M_r = Φᵀ D M_h D Φ, D = diag(clamp.d), element by
/// element; no voxel matrix is stored. Time grows as cells × overlapping frames². Same bits with any number of threads.
ReducedMatrices projectMatrices(const VoxelBody& body, const VoxelMesh& mesh, const std::vector<Spring>& springs,
                                const FrameBasis& basis, const ActiveFunctions& active, const Clamp& clamp,
                                HexElement element, const Progress& progress = {});

}  // namespace glisson::mechanics

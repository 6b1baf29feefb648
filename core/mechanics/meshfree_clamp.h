// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// How fixations enter a mesh-free displacement: u = lift + d ∘ (Φ q), axis by axis, d = 1 − (1 − s)₊³ with
/// s = distance to the nearest node fixed along that axis / h. Exact at every fixed node and free of any parameter to
/// tune.
struct Clamp {
  NodalField d;       ///< 3 × nodeCount in [0, 1]; 0 exactly at fixed degrees of freedom
  NodalField lift_m;  ///< 3 × nodeCount, (1 − d) × the prescribed value of the nearest fixed node
  Eigen::Matrix<int, 3, Eigen::Dynamic>
      nearest;                ///< 3 × nodeCount, nearest fixed node per axis, −1 where none is fixed
  bool lifted = false;        ///< some prescribed value is not zero
  bool sameOnAllAxes = true;  ///< the three rows of d agree everywhere
};

/// h_m > 0: the width of the transition, the mean spacing of the frames. Distances are Euclidean (exact transform on
/// the node lattice). Throws BadInput as readDirichlet does.
Clamp distanceClamp(const VoxelMesh& mesh, const Supports& supports, double h_m);

}  // namespace glisson::mechanics

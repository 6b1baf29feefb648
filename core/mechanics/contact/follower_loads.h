// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mechanics/contact/contact_solve.h"

namespace glisson::mechanics {

/// Trilinear shares of the nodes of the cell that carries a point (m, grid axes), with its place clamped into the cell:
/// none negative, together 1. Empty where no filled cell lies within three cells.
std::vector<std::pair<int, double>> sharesOf(const VoxelMesh& mesh, const Eigen::Vector3d& p_m);

/// Pressures that follow their faces as a potential: Σ p V, V the volume behind the faces as ∫ W (x − apex)·n dA with
/// W = diag(weight) of trace 1. Both are chosen so that the rim of the faces does no work.
struct PressurePotential {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  Eigen::Vector3d apex_m = Eigen::Vector3d::Zero();
};

/// Nothing where the loads have no potential: shears, or a rim (an edge on which the pressures of the faces do not
/// cancel) that may move other than along planes of the grid's axes.
std::optional<PressurePotential> potentialOf(const VoxelMesh& mesh, const std::vector<FollowerFace>& faces,
                                             const std::vector<Fixation>& fixations);

/// A triangle of a follower face where it is now: places (m), and the load per deformed area.
struct FollowerTriangle {
  std::array<Eigen::Vector3d, 3> x_m;
  double pressure_Pa = 0;
  double shear_Pa = 0;
  std::array<double, 2> along{};  ///< direction of the shear at rest, in edges 0→1 and 0→2

  /// Force of its load, N.
  Eigen::Vector3d force_N() const;
  /// Its derivatives by the three places, N/m.
  std::array<Eigen::Matrix3d, 3> stiffness_N_m() const;
  /// ∫ W (x − apex)·n dA, m³.
  double volume_m3(const PressurePotential& potential) const;
};

}  // namespace glisson::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "anatomy/surface_field.h"

namespace glisson::anatomy {

/// The smooth body of a mask as Delaunay refinement asks for it. Keeps a reference to the field.
class OrganDomain {
 public:
  explicit OrganDomain(const SurfaceField& field);

  /// Field above its level at a point (LPS mm), trilinear; negative beyond the lattice.
  double depth_mm(const Eigen::Vector3d& p_lps) const;

  /// Box in LPS that holds the lattice.
  const Eigen::Vector3d& low() const { return low_; }
  const Eigen::Vector3d& high() const { return high_; }

  /// Points spread over each connected part of the surface: 16 of them, and more until none is further than apart_mm
  /// from the next (2000 at most).
  std::vector<Eigen::Vector3d> pointsOnSurface(double apart_mm) const;

 private:
  const SurfaceField& field_;
  Eigen::Matrix3d toIndex_;
  Eigen::Vector3d low_, high_;
};

}  // namespace glisson::anatomy

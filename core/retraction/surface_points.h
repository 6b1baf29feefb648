// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mechanics/tet_mesh.h"

namespace glisson::retraction {

/// A place on the outer faces of a tetrahedral mesh.
struct SurfacePoint {
  mechanics::TetFace face;
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< barycentric, of the face's three corners; ≥ 0, sum 1
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
};

/// Nearest place on the surface for each of many points.
class SurfaceFinder {
 public:
  explicit SurfaceFinder(const mechanics::TetMesh& mesh);

  std::vector<SurfacePoint> nearest(const std::vector<Eigen::Vector3d>& points_m) const;

  /// Shares (≥ 0, sum 1) of the face's nodes at a place, linear over the triangle (T4) or over the four triangles
  /// between corners and middles (T10): what spreads forces and springs without changing their sum or sign.
  std::vector<std::pair<int, double>> shares(const SurfacePoint& place) const;

 private:
  struct Triangle {
    mechanics::TetFace face;
    std::array<Eigen::Vector3d, 3> corner;
    Eigen::Vector3d centre;
    double radius = 0.0;
  };
  SurfacePoint nearest(const Eigen::Vector3d& p) const;

  const mechanics::TetMesh& mesh_;
  std::vector<Triangle> triangles_;
};

}  // namespace glisson::retraction

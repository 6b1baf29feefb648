// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/progress.h"

namespace glisson::anatomy {

/// What Delaunay refinement is asked for.
struct DelaunayCriteria {
  std::function<double(const Eigen::Vector3d&)> size_mm;  ///< largest radius of a circumsphere at a point
  double facetAngle_deg = 28.0;                           ///< no smaller angle in a boundary triangle; below 30
  double distance_mm = 0.5;       ///< from the centre of a boundary triangle to the surface, at most
  double radiusEdge = 2.0;        ///< circumradius over shortest edge, at most
  double sliverAngle_deg = 12.0;  ///< slivers are perturbed and exuded until dihedral angles reach this
  bool cells = true;              ///< false: the surface alone is wanted; nothing is asked of the cells
};

/// Cells and points as the refinement left them.
struct DelaunayCells {
  Eigen::Matrix3Xd points;
  Eigen::Matrix4Xi cells;
};

/// Restricted Delaunay tetrahedra of {p : depth(p) > 0} inside the box low ... high. onSurface: points with depth 0,
/// some on every part of the surface; parts without one are not found. Sequential, fixed seeds: the same bits every
/// time. Throws Cancelled, and Error where CGAL gives up.
DelaunayCells delaunayCells(const std::function<double(const Eigen::Vector3d&)>& depth, const Eigen::Vector3d& low,
                            const Eigen::Vector3d& high, const std::vector<Eigen::Vector3d>& onSurface,
                            const DelaunayCriteria& criteria, const Progress& progress);

}  // namespace glisson::anatomy

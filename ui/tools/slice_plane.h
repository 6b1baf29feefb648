// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "image/grid.h"
#include "roi/contour_stack.h"

namespace glisson::tools {

/// One slice of a grid as a view shows it: the map between logical pixels of the view and LPS mm.
struct SlicePlane {
  image::Grid grid;
  int slice = 0;                                          ///< k of the grid
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();    ///< where the centre of voxel (0, 0, slice) is shown
  Eigen::Vector2d scale_px_mm = Eigen::Vector2d::Ones();  ///< logical pixels per mm along i, j; negative = flipped
  std::string sopInstanceUid;                             ///< of the image shown; empty where unknown

  Eigen::Vector2d toPixel(const Eigen::Vector3d& p_lps) const;
  Eigen::Vector3d toLps(const Eigen::Vector2d& p_px) const;  ///< a point exactly in the plane of the slice

  /// In-plane coordinates (mm along i and j from voxel (0, 0)), for geometry that must not depend on the zoom.
  Eigen::Vector2d toPlane_mm(const Eigen::Vector3d& p_lps) const;
  /// The reverse, for points (2 × n) exactly in the plane of the slice.
  Eigen::Matrix3Xd fromPlane(const Eigen::Matrix2Xd& plane_mm) const;

  /// Whether the polygon belongs to this slice: its plane is nearer to it than to any other slice of the grid.
  bool holds(const roi::Polygon& polygon) const;

  /// The slice alone, as a grid of one layer.
  image::Grid sliceGrid() const;
};

/// Slice index (k, not clamped) of the grid that a polygon belongs to. polygon: at least one point.
int sliceOf(const roi::Polygon& polygon, const image::Grid& grid);

}  // namespace glisson::tools

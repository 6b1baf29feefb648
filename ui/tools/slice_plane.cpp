// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/slice_plane.h"

#include <cmath>

namespace glisson::tools {

Eigen::Vector2d SlicePlane::toPlane_mm(const Eigen::Vector3d& p_lps) const {
  return (grid.direction.transpose() * (p_lps - grid.origin_lps_mm)).head<2>();
}

Eigen::Vector2d SlicePlane::toPixel(const Eigen::Vector3d& p_lps) const {
  return offset_px + scale_px_mm.cwiseProduct(toPlane_mm(p_lps));
}

Eigen::Vector3d SlicePlane::toLps(const Eigen::Vector2d& p_px) const {
  const Eigen::Vector2d plane_mm = (p_px - offset_px).cwiseQuotient(scale_px_mm);
  return grid.origin_lps_mm + grid.direction * Eigen::Vector3d(plane_mm.x(), plane_mm.y(), grid.spacing_mm.z() * slice);
}

Eigen::Matrix3Xd SlicePlane::fromPlane(const Eigen::Matrix2Xd& plane_mm) const {
  Eigen::Matrix3Xd points(3, plane_mm.cols());
  for (Eigen::Index i = 0; i < plane_mm.cols(); ++i)
    points.col(i) = grid.origin_lps_mm +
                    grid.direction * Eigen::Vector3d(plane_mm(0, i), plane_mm(1, i), grid.spacing_mm.z() * slice);
  return points;
}

bool SlicePlane::holds(const roi::Polygon& polygon) const {
  return polygon.points_lps_mm.cols() > 0 && sliceOf(polygon, grid) == slice;
}

image::Grid SlicePlane::sliceGrid() const {
  image::Grid one = grid;
  one.origin_lps_mm = grid.indexToLps({0.0, 0.0, static_cast<double>(slice)});
  one.size.z() = 1;
  return one;
}

int sliceOf(const roi::Polygon& polygon, const image::Grid& grid) {
  const Eigen::Vector3d centre = polygon.points_lps_mm.rowwise().mean();
  return static_cast<int>(std::lround(grid.lpsToIndex(centre).z()));
}

}  // namespace glisson::tools

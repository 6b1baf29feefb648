#pragma once

#include <Eigen/Core>
#include <vector>

#include "roi/contour_stack.h"

namespace glisson::roi {

/// A polygon in a frame of its own plane.
struct Plane {
  Eigen::Vector3d centre_lps_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns u, v (in the plane) and the normal, LPS
  bool wide = false;                                   ///< points span a plane (they are not all on one line)
};

/// Least-squares plane through the vertices. Throws BadInput where there are fewer than three vertices or a coordinate
/// is not finite or beyond 1e6 mm.
Plane planeOf(const Polygon& polygon);

/// Position along the slice axis of grid, in slices (k index, not rounded). Throws BadInput as planeOf, and where the
/// polygon is tilted by more than 1 degree or leaves its plane by more than half a slice.
double sliceOf(const Polygon& polygon, const image::Grid& grid);

/// Whether the polygon's plane is parallel to the slices of grid within 1 degree.
bool parallelTo(const Polygon& polygon, const image::Grid& grid);

/// Polygons (drafts left out) that rasterise() uses for each slice of grid: indices into contours.polygons.
std::vector<std::vector<std::size_t>> polygonsPerSlice(const ContourStack& contours, const image::Grid& grid);

/// Sets the voxels of slice k that the given polygons of contours hold, by the rule of rasterise().
void fillSlice(image::Mask& mask, int k, const ContourStack& contours, const std::vector<std::size_t>& polygons);

}  // namespace glisson::roi

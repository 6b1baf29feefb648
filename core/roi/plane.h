// SPDX-License-Identifier: GPL-3.0-or-later
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

/// Part of a slice by which the vertices of a polygon may lie off one height, however tilted its plane looks: the tilt
/// of a small polygon with rounded coordinates means nothing.
inline constexpr double levelWithin_slices = 0.1;

/// Position along the slice axis of grid, in slices (k index, not rounded). Throws BadInput as planeOf, and where the
/// polygon is not parallelTo the slices or leaves its plane by more than half a slice.
double sliceOf(const Polygon& polygon, const image::Grid& grid);

/// Whether the polygon's plane is parallel to the slices of grid within 1 degree, or its vertices lie within
/// levelWithin_slices of one height.
bool parallelTo(const Polygon& polygon, const image::Grid& grid);

/// Polygons that lie in one plane, seen from its normal.
struct FlatPolygons {
  std::vector<std::size_t> members;        ///< indices into contours.polygons, exclusions too
  std::vector<Eigen::Matrix2Xd> rings_mm;  ///< in the plane, in the order of members
};

/// The polygons that count (drafts do not) by planes, within 0.01 mm and about a degree; small ones whose vertices lie
/// within 0.1 mm of the plane of a larger one belong to it whatever their own tilt. Those whose points are all on one
/// line are left out where they lie in no other's plane. Throws BadInput as planeOf.
std::vector<FlatPolygons> flatPlanesOf(const ContourStack& contours);

/// Which polygons make each slice of a grid, and what becomes of the others.
struct SliceOutlines {
  std::vector<std::vector<std::size_t>> members;  ///< of each slice: indices into contours.polygons
  std::vector<std::size_t> beyond;                ///< nearest to no slice of the grid
  std::vector<std::size_t> offPlane;              ///< taken, though not at the height of the others of their slice
  std::vector<std::size_t> leftOut;               ///< overlap one of their slice that lies nearer its middle
  double farthestOffPlane_mm = 0.0;               ///< of offPlane and leftOut
};

/// Drafts do not count. Where polygons at several heights fall on one slice, the height nearest to its middle counts.
/// Another polygon of it is taken too (offPlane) where it overlaps none of them and lies nearer to their plane than
/// half the usual distance between planes: it is then a part of the same slice drawn at another height, and no plane
/// of its own. One that does overlap is left out; it is listed where it is no plane of a finer stack.
SliceOutlines outlinesOf(const ContourStack& contours, const image::Grid& grid);

/// SliceOutlines::members: what rasterise() uses.
std::vector<std::vector<std::size_t>> polygonsPerSlice(const ContourStack& contours, const image::Grid& grid);

/// Sets the voxels of slice k that the given polygons of contours hold, by the rule of rasterise().
void fillSlice(image::Mask& mask, int k, const ContourStack& contours, const std::vector<std::size_t>& polygons);

}  // namespace glisson::roi

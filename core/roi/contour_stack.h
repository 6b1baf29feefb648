// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "image/volume.h"

namespace glisson::roi {

/// Where a polygon stands in its life. Drafts are kept and never counted.
enum class PolygonState { Draft, Accepted, Interpolated };

/// How a polygon joins the others of its slice.
enum class Combine {
  Union,  ///< a set of points: overlapping ones are one region, one inside another is a hole (arrangement.h)
  Parity  ///< flips what it encloses (even-odd): DICOM's CLOSEDPLANAR_XOR
};

/// A closed polygon on one slice. Vertices are the master; every mask is derived from them.
struct Polygon {
  Eigen::Matrix3Xd points_lps_mm;  ///< 3 × n, n ≥ 3, not repeated at the end, in one plane
  bool exclude = false;            ///< a region to leave out (a large vessel, a cyst)
  PolygonState state = PolygonState::Accepted;
  Combine combine = Combine::Union;
  std::string sopInstanceUid;  ///< image it was drawn on; empty where unknown
};

/// All polygons of one reader on one image series.
struct ContourStack {
  std::string name = "liver";
  std::string frameOfReferenceUid;
  std::string seriesUid;
  std::vector<Polygon> polygons;
};

/// Masks the voxels whose centre lies inside, slice by slice: a polygon belongs to the one slice of the grid nearest to
/// its plane (within half a slice spacing; see polygonsPerSlice for several planes in one slice). The include polygons
/// of a slice are sets of points: what overlaps is joined, an inner polygon is a hole, a repeated one counts once
/// (arrangement.h); within one polygon the even-odd rule holds, so that keyholes are holes. Exclude polygons are taken
/// out afterwards. Tie rule: a centre exactly on an edge belongs to the polygon
/// whose interior lies towards growing column index (then row index), so that two polygons that share an edge never
/// both hold or both miss a voxel. Drafts do not count. Throws BadInput where no polygon meets the grid, or a polygon
/// is not parallel to the slices (> 1 degree, and more than a tenth of a slice off).
image::Mask rasterise(const ContourStack& contours, const image::Grid& grid);

/// The area that polygons enclose on their slice (as sets of points, minus exclusions), mm², summed over planes; exact
/// for crossing, nested and overlapping polygons. Drafts do not count. Throws BadInput as rasterise does for the
/// polygons themselves.
double area_mm2(const ContourStack& contours);

}  // namespace glisson::roi

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "image/grid.h"

namespace glisson::render {

/// The plane of one slice as it is shown: pixel (x, y), y down, lies at p_lps = corner_lps + mmPerPixel (x right + y
/// down). Pixels are square in millimetres whatever the voxels are. Radiological convention: axial and coronal slices
/// have the patient's right on the left of the picture; axial: anterior up; coronal and sagittal: superior up;
/// sagittal: anterior left.
struct SlicePlane {
  Eigen::Vector3d corner_lps;
  Eigen::Vector3d right, down;  ///< unit vectors, LPS
  double mmPerPixel = 1.0;
  int width = 0, height = 0;
  std::string leftLetter, rightLetter, topLetter, bottomLetter;  ///< R L A P S I

  Eigen::Vector3d toLps(double x, double y) const { return corner_lps + mmPerPixel * (x * right + y * down); }
  Eigen::Vector2d toPixel(const Eigen::Vector3d& p_lps) const {
    const Eigen::Vector3d d = (p_lps - corner_lps) / mmPerPixel;
    return {d.dot(right), d.dot(down)};
  }
  Eigen::Vector3d normal() const { return right.cross(down); }
};

/// The whole slice k of a grid, at pixelsPerVoxel pixels for the smaller in-plane voxel side.
/// Throws BadArgument where k is not a slice of the grid or pixelsPerVoxel is not in 1..64.
SlicePlane planeOfSlice(const image::Grid& grid, int k, int pixelsPerVoxel);

/// A square part of a plane around the projection of a point, side_mm wide, in pixels × pixels.
SlicePlane zoomOf(const SlicePlane& plane, const Eigen::Vector3d& centre_lps, double side_mm, int pixels);

/// The part of a plane between two pixel corners, rounded outwards and cut to the plane.
SlicePlane cropOf(const SlicePlane& plane, const Eigen::Vector2d& low, const Eigen::Vector2d& high);

}  // namespace glisson::render

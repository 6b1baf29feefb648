// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/slice_plane.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace glisson::render {
namespace {

std::string letterOf(const Eigen::Vector3d& direction_lps) {
  int axis = 0;
  direction_lps.cwiseAbs().maxCoeff(&axis);
  const bool positive = direction_lps[axis] > 0.0;
  constexpr const char* letters[3][2] = {{"R", "L"}, {"A", "P"}, {"I", "S"}};
  return letters[axis][positive ? 1 : 0];
}

void nameSides(SlicePlane& plane) {
  plane.leftLetter = letterOf(-plane.right);
  plane.rightLetter = letterOf(plane.right);
  plane.topLetter = letterOf(-plane.down);
  plane.bottomLetter = letterOf(plane.down);
}

}  // namespace

SlicePlane planeOfSlice(const image::Grid& grid, int k, int pixelsPerVoxel) {
  if (k < 0 || k >= grid.size.z())
    throw BadArgument("slice " + std::to_string(k) + " is not one of the " + std::to_string(grid.size.z()) +
                      " slices of the image");
  if (pixelsPerVoxel < 1 || pixelsPerVoxel > 64)
    throw BadArgument("pixels per voxel must lie in 1..64, not " + std::to_string(pixelsPerVoxel));

  int through = 0;
  grid.direction.col(2).cwiseAbs().maxCoeff(&through);
  const Eigen::Vector3d wishRight = through == 0 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d wishDown = through == 2 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());

  const int across =
      std::abs(grid.direction.col(0).dot(wishRight)) >= std::abs(grid.direction.col(1).dot(wishRight)) ? 0 : 1;
  const int along = 1 - across;
  const double signRight = grid.direction.col(across).dot(wishRight) < 0.0 ? -1.0 : 1.0;
  const double signDown = grid.direction.col(along).dot(wishDown) < 0.0 ? -1.0 : 1.0;

  SlicePlane plane;
  plane.right = signRight * grid.direction.col(across);
  plane.down = signDown * grid.direction.col(along);
  plane.mmPerPixel = std::min(grid.spacing_mm[0], grid.spacing_mm[1]) / pixelsPerVoxel;
  plane.width =
      std::max(1, static_cast<int>(std::lround(grid.size[across] * grid.spacing_mm[across] / plane.mmPerPixel)));
  plane.height =
      std::max(1, static_cast<int>(std::lround(grid.size[along] * grid.spacing_mm[along] / plane.mmPerPixel)));
  Eigen::Vector3d corner(0.0, 0.0, k);
  corner[across] = signRight > 0.0 ? -0.5 : grid.size[across] - 0.5;
  corner[along] = signDown > 0.0 ? -0.5 : grid.size[along] - 0.5;
  plane.corner_lps = grid.indexToLps(corner);
  nameSides(plane);
  return plane;
}

SlicePlane zoomOf(const SlicePlane& plane, const Eigen::Vector3d& centre_lps, double side_mm, int pixels) {
  SlicePlane zoom = plane;
  const Eigen::Vector2d c = plane.toPixel(centre_lps);
  const double half = 0.5 * side_mm / plane.mmPerPixel;
  zoom.corner_lps = plane.toLps(c.x() - half, c.y() - half);
  zoom.mmPerPixel = side_mm / pixels;
  zoom.width = pixels;
  zoom.height = pixels;
  return zoom;
}

SlicePlane cropOf(const SlicePlane& plane, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  const int x0 = std::clamp(static_cast<int>(std::floor(low.x())), 0, plane.width - 1);
  const int y0 = std::clamp(static_cast<int>(std::floor(low.y())), 0, plane.height - 1);
  const int x1 = std::clamp(static_cast<int>(std::ceil(high.x())), x0 + 1, plane.width);
  const int y1 = std::clamp(static_cast<int>(std::ceil(high.y())), y0 + 1, plane.height);
  SlicePlane part = plane;
  part.corner_lps = plane.toLps(x0, y0);
  part.width = x1 - x0;
  part.height = y1 - y0;
  return part;
}

}  // namespace glisson::render

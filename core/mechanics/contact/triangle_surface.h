// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace glisson::mechanics {

/// A closed surface of triangles whose corners run anticlockwise seen from outside. Unit and axes are the owner's:
/// metres and the grid's own axes inside mechanics.
struct TriangleSurface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

}  // namespace glisson::mechanics

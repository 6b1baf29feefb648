// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "render/overlay.h"

namespace glisson::render {

/// Where the eye is, what is up, and which faces of a box lie behind the scene. All unit vectors, LPS.
struct Viewpoint {
  Eigen::Vector3d fromEye;                  ///< into the picture
  Eigen::Vector3d up;                       ///< of the screen
  Eigen::Vector3d right;                    ///< of the screen
  std::vector<std::pair<int, bool>> walls;  ///< axis, at the upper end; the one that faces the eye most comes first
};

/// The viewpoint of the options: their camera where it is given, else their view.
/// Throws BadArgument where an angle is not finite or the elevation is outside −90..90.
Viewpoint viewpointOf(const SceneOptions3D& options);

/// An edge of the box along which centimetres are written.
struct LabelledEdge {
  int axis = 0;             ///< it runs along
  Eigen::Vector3d low;      ///< its lower end
  Eigen::Vector3d outward;  ///< unit, away from the box on the screen, LPS
};

/// One edge for every axis that is not seen end-on and runs along a wall: the lowest on the screen for an axis that
/// runs across it, the leftmost for one that runs up it.
std::vector<LabelledEdge> labelledEdges(const Viewpoint& view, const Eigen::AlignedBox3d& box);

}  // namespace glisson::render

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "anatomy/centreline.h"
#include "anatomy/triangle_mesh.h"

namespace glisson::anatomy {

/// A vessel between two forks, or from a fork to an end.
struct VesselBranch {
  int parent = -1;                             ///< branch that it leaves; −1: a root
  int order = 1;                               ///< 1 for a root, one more than the parent's otherwise
  std::vector<Eigen::Vector3d> points_lps_mm;  ///< away from the root; the first is the parent's last
  std::vector<double> radius_mm;               ///< per point
  double length_mm = 0.0;                      ///< of the polyline
  double meanRadius_mm = 0.0;                  ///< over the length
};

/// Vessels as trees. Parents come before their children.
struct VesselTree {
  std::vector<VesselBranch> branches;
  int roots = 0;
  int loopsCut = 0;  ///< edges taken out to open loops
  int pruned = 0;    ///< side branches left out
  double length_mm() const;
};

/// Trees from a centreline. Rules: a loop is opened where it is thinnest (the forest of widest edges stays); the root
/// of each connected part is the end with the largest radius (median of its first five points); an end branch shorter
/// than 1.5 radii at its fork does not leave the vessel and is left out; a piece between two forks that is shorter than
/// the radius there is one fork: what leaves it leaves its start. Ties: the lower index.
VesselTree treeOf(const Centreline& line);

/// Closed surface of the tubes: union of the cones between neighbouring points, with round ends. resolution_mm: of the
/// surface; 0: half the smallest radius, or 1/200 of the extent where that is more. An empty tree gives no triangles.
TriangleMesh tubesOf(const VesselTree& tree, double resolution_mm = 0.0);

}  // namespace glisson::anatomy

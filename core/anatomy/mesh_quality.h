// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

namespace glisson::anatomy {

/// Figures that say what a tetrahedral mesh is worth to a solver.
struct MeshQuality {
  double leastDihedral_deg = 0.0, largestDihedral_deg = 0.0;  ///< between two faces of a cell; regular: 70.5
  double worstRadiusEdge = 0.0;  ///< largest circumradius over shortest edge of a cell; regular: 0.61
  double longestEdge_mm = 0.0, shortestEdge_mm = 0.0;
  double volume_mm3 = 0.0;
  int flatOrInverted = 0;  ///< cells whose volume is at most 1e-9 of the cube of their longest edge
};

/// points: 3 × nPoints; cells: 4 × nCells, positively oriented ((1−0) × (2−0) looks to 3). Throws BadArgument where an
/// index is out of range or there is no cell.
MeshQuality qualityOf(const Eigen::Matrix3Xd& points_mm, const Eigen::Matrix4Xi& cells);

/// Triangles that belong to one cell only, counter-clockwise from outside, in the order of the cells. Throws
/// BadArgument where three cells share a triangle.
Eigen::Matrix3Xi boundaryOf(const Eigen::Matrix4Xi& cells);

/// "1234 cells, dihedral angles 11 to 160 degrees, ..."
std::string describe(const MeshQuality& quality, int cells);

}  // namespace glisson::anatomy

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "mechanics/loads.h"
#include "mechanics/tet_mesh.h"

namespace glisson::mechanics {

/// Voxel faces on a mesh of tetrahedra made from the voxels: the two triangles of the tetrahedra that each consists of.
class VoxelFacesOnTets {
 public:
  VoxelFacesOnTets(const VoxelMesh& voxels, const TetMesh& mesh);
  /// Nodes of the tetrahedra with their shares of what lies evenly on the face, which add up to 1: a third of each
  /// triangle's half to each corner (T4), to each middle node (T10, whose corners take none). Exact for a traction;
  /// for a foundation the row sums of its matrix. Throws BadArgument where the face is not made of two triangles.
  std::vector<std::pair<int, double>> shares(const Face& face) const;

 private:
  const VoxelMesh& voxels_;
  const TetMesh& mesh_;
  std::map<std::array<int, 3>, TetFace> triangles_;  ///< by their corners, ascending
};

}  // namespace glisson::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/tet_faces.h"

#include <algorithm>

#include "base/error.h"

namespace glisson::mechanics {
namespace {

std::array<int, 3> sorted(std::array<int, 3> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace

VoxelFacesOnTets::VoxelFacesOnTets(const VoxelMesh& voxels, const TetMesh& mesh) : voxels_(voxels), mesh_(mesh) {
  for (const TetFace& t : exteriorFaces(mesh)) {
    const std::vector<int> n = nodesOf(mesh, t);
    triangles_[sorted({n[0], n[1], n[2]})] = t;
  }
}

std::vector<std::pair<int, double>> VoxelFacesOnTets::shares(const Face& face) const {
  const std::array<int, 4> corners = faceNodes(voxels_, face);
  std::vector<std::pair<int, double>> out;
  int found = 0;
  for (std::size_t left = 0; left < 4; ++left) {
    std::array<int, 3> key{};
    std::size_t at = 0;
    for (std::size_t c = 0; c < 4; ++c)
      if (c != left) key[at++] = corners[c];
    const auto triangle = triangles_.find(sorted(key));
    if (triangle == triangles_.end()) continue;
    ++found;
    const std::vector<int> n = nodesOf(mesh_, triangle->second);
    for (std::size_t c = mesh_.quadratic() ? 3 : 0; c < n.size(); ++c) out.emplace_back(n[c], 1.0 / 6.0);
  }
  if (found != 2) throw BadArgument("a voxel face does not consist of two triangles of the tetrahedral mesh");
  return out;
}

}  // namespace glisson::mechanics

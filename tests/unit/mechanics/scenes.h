// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>

#include "mechanics/loads.h"
#include "mechanics/problem.h"

namespace glisson::mechanics::test {

/// A box of n cells and the given size with one modulus.
inline VoxelBody box(const Eigen::Vector3i& n, const Eigen::Vector3d& size_m, double E_Pa, double poisson) {
  VoxelBody body;
  body.cells = n;
  body.h_m = size_m.cwiseQuotient(n.cast<double>());
  body.E_Pa.assign(static_cast<std::size_t>(n.prod()), E_Pa);
  body.poisson = poisson;
  return body;
}

/// Sets the modulus of every cell from its centre (m) and its present modulus.
inline void paint(VoxelBody& body, const std::function<double(const Eigen::Vector3d& centre_m, double E_Pa)>& modulus) {
  for (int k = 0; k < body.cells.z(); ++k)
    for (int j = 0; j < body.cells.y(); ++j)
      for (int i = 0; i < body.cells.x(); ++i) {
        double& E = body.E_Pa[body.cell(i, j, k)];
        E = modulus(Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(body.h_m), E);
      }
}

/// Nodes with a property of their position (m).
inline std::vector<int> nodesWhere(const VoxelMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& chosen) {
  std::vector<int> nodes;
  for (int node = 0; node < mesh.nodeCount(); ++node)
    if (chosen(mesh.position_m(node))) nodes.push_back(node);
  return nodes;
}

/// Exterior faces on one side whose centre has a property.
inline std::vector<Face> facesWhere(const VoxelMesh& mesh, int side,
                                    const std::function<bool(const Eigen::Vector3d&)>& chosen) {
  std::vector<Face> faces;
  for (const Face& face : exteriorFaces(mesh))
    if (face.side == side && chosen(faceCentre_m(mesh, face))) faces.push_back(face);
  return faces;
}

}  // namespace glisson::mechanics::test

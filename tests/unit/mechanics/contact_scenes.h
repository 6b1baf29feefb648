// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mechanics/contact/contact_solve.h"

namespace glisson::mechanics {

inline VoxelBody box(const Eigen::Vector3i& cells, const Eigen::Vector3d& h_m, double E_Pa, double poisson) {
  VoxelBody b;
  b.cells = cells;
  b.h_m = h_m;
  b.E_Pa.assign(static_cast<std::size_t>(cells.prod()), E_Pa);
  b.poisson = poisson;
  return b;
}

/// Samples of the face y+ of a box, `perCell` to a cell's edge.
inline std::vector<SurfaceSample> topOf(const VoxelBody& b, int perCell) {
  const Eigen::Vector3d size = b.cells.cast<double>().cwiseProduct(b.h_m);
  const int nx = perCell * b.cells.x(), nz = perCell * b.cells.z();
  std::vector<SurfaceSample> samples;
  for (int k = 0; k < nz; ++k)
    for (int i = 0; i < nx; ++i)
      samples.push_back({{(i + 0.5) * size.x() / nx, size.y(), (k + 0.5) * size.z() / nz},
                         Eigen::Vector3d::UnitY(),
                         size.x() / nx * size.z() / nz});
  return samples;
}

/// A block that is clamped below.
inline ContactProblem onClampedBlock(const VoxelBody& body, int perCell) {
  ContactProblem p;
  p.problem.body = body;
  const VoxelMesh mesh(body);
  p.problem.f_N = NodalField::Zero(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n)
    if (mesh.latticeOf(n).y() == 0) p.problem.supports.fixations.push_back({n, {true, true, true}, {0, 0, 0}});
  p.surface = topOf(body, perCell);
  return p;
}

}  // namespace glisson::mechanics

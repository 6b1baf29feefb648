// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "mechanics/dynamics.h"
#include "mechanics/loads.h"
#include "mechanics/supports.h"
#include "scenes.h"

namespace glisson::mechanics::test {

/// One mass m (kg) on a spring k (N/m).
inline MatrixSystem oneMass(double m, double k) {
  return MatrixSystem(Eigen::MatrixXd::Constant(1, 1, k).sparseView(0.0, 0.0),
                      Eigen::MatrixXd::Constant(1, 1, m).sparseView());
}

/// A vector of one number.
inline Eigen::VectorXd one(double x) {
  return Eigen::VectorXd::Constant(1, x);
}

/// A cube of 30 mm and n³ cells under a hundredth of its own weight; held: by its face at x = 0.
inline Problem cube(int n, double poisson = 0.45, bool held = false) {
  Problem p;
  p.body = box({n, n, n}, {0.03, 0.03, 0.03}, 6e3, poisson);
  const VoxelMesh mesh(p.body);
  if (held) p.supports.fixations = fix(nodesWhere(mesh, [](const Eigen::Vector3d& x) { return x.x() == 0.0; }));
  p.f_N = bodyForce(mesh, {0.0, 0.0, -0.01 * p.body.density_kg_m3 * 9.81});
  return p;
}

}  // namespace glisson::mechanics::test

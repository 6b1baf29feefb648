// SPDX-License-Identifier: GPL-3.0-or-later

// A law and an element of one's own (stiffening_law.h on trilinear boxes): a cube of 64 cells is pulled to 1.3 of its
// length by Newton's method, with the project's assembled matrix and its factor.
//
// usage: 04_law       exit code 0 if the force on the moved face is the derivative of the energy by the stretch
#include <cmath>
#include <cstdio>

#include "mechanics/block_matrix.h"
#include "mechanics/problem.h"
#include "stiffening_law.h"

namespace {
using namespace glisson::mechanics;

/// Stretches the cube: energy (J), and force (N) on the face that is moved. Three faces are planes of symmetry.
std::pair<double, double> pull(const StiffeningLaw& law, const VoxelBody& body, double stretch) {
  const VoxelMesh mesh(body);
  Eigen::MatrixXi nodes(8, mesh.cellCount());
  for (int c = 0; c < mesh.cellCount(); ++c)
    for (int i = 0; i < 8; ++i) nodes(i, c) = mesh.nodesOf(c)[static_cast<std::size_t>(i)];
  Eigen::Array<bool, 3, Eigen::Dynamic> held(3, mesh.nodeCount());
  NodalField u(3, mesh.nodeCount());
  const double thin = 1 / std::sqrt(stretch);  // the first guess keeps the volume
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const Eigen::Vector3i at = mesh.latticeOf(n);
    held.col(n) << (at.x() == 0 || at.x() == body.cells.x()), at.y() == 0, at.z() == 0;
    u.col(n) = (Eigen::Vector3d(stretch - 1, thin - 1, thin - 1)).cwiseProduct(mesh.position_m(n));
  }
  BlockMatrix K(mesh.nodeCount(), nodes);
  BlockFactor factor(K, held);
  for (int iteration = 0;; ++iteration) {
    double energy_J = 0;
    NodalField r = NodalField::Zero(3, mesh.nodeCount());
    K.setZero();
    for (int c = 0; c < mesh.cellCount(); ++c) {
      Eigen::MatrixXd f;
      HexMatrix Ke;
      energy_J += element(law, body.h_m, u(Eigen::all, nodes.col(c)), f, Ke);
      r(Eigen::all, nodes.col(c)) += f;
      K.add(nodes.col(c).data(), Ke);
    }
    double force_N = 0;
    for (int n = 0; n < mesh.nodeCount(); ++n)
      if (mesh.latticeOf(n).x() == body.cells.x()) force_N += r(0, n);
    r = (held == true).select(0, r);
    std::printf("%s%.0e", iteration == 0 ? "residual (N): " : ", ", r.norm());
    if (r.norm() < 1e-10 * std::abs(force_N)) return {energy_J, force_N};
    if (iteration == 20 || !factor.factorise(K)) return {NAN, NAN};  // no equilibrium found
    Eigen::VectorXd du(u.size());
    factor.solve(-r.reshaped(), du);
    u += du.reshaped(3, mesh.nodeCount());
  }
}
}  // namespace

int main() {
  VoxelBody body;
  body.cells = {4, 4, 4};
  body.h_m.setConstant(0.005);
  body.E_Pa.assign(64, 1.0);  // filled; the law brings its own moduli
  bool right = true;
  for (const double a : {0.0, 1.0}) {
    const StiffeningLaw law{2100, 18900, a};
    const double d = 1e-4, edge_m = 0.02, force_N = pull(law, body, 1.3).second;
    const double slope_N = (pull(law, body, 1.3 + d).first - pull(law, body, 1.3 - d).first) / (2 * d * edge_m);
    std::printf("\na = %.0f: %.4f N, dW/ds = %.4f N\n", a, force_N, slope_N);
    right = right && std::abs(slope_N / force_N - 1) < 1e-5;
  }
  return right ? 0 : 1;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/condensed.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/error.h"

namespace glisson::mechanics {

Landmark landmarkAt(const VoxelMesh& mesh, const Eigen::Vector3d& p_m) {
  // A point on a face, edge or corner belongs to any filled cell there.
  const Eigen::Vector3d s = p_m.cwiseQuotient(mesh.h_m());
  if (s.allFinite()) {
    for (int b = 0; b < 8; ++b) {
      Eigen::Vector3i c;
      bool inside = true;
      for (int a = 0; a < 3; ++a) {
        const double shifted = s[a] + ((b >> a & 1) ? -1e-9 : 1e-9);
        inside = inside && shifted >= 0.0 && shifted < mesh.cells()[a];
        c[a] = inside ? static_cast<int>(shifted) : 0;
      }
      if (!inside) continue;
      Landmark landmark;
      for (int k = 0; k < 8 && inside; ++k) {
        const Eigen::Vector3i corner = c + Eigen::Vector3i(k & 1, k >> 1 & 1, k >> 2 & 1);
        double weight = 1.0;
        for (int a = 0; a < 3; ++a) weight *= 1.0 - std::min(1.0, std::abs(s[a] - corner[a]));
        landmark.nodes.push_back(mesh.nodeAt(corner.x(), corner.y(), corner.z()));
        landmark.weights.push_back(weight);
        inside = landmark.nodes.back() >= 0;
      }
      // All eight corners of an empty cell can exist: its neighbours decide, so ask the list of filled cells.
      if (!inside) continue;
      for (int filled = 0; filled < mesh.cellCount(); ++filled)
        if (mesh.cellOf(filled) == c) return landmark;
    }
  }
  throw BadInput("landmark (" + std::to_string(1e3 * p_m.x()) + ", " + std::to_string(1e3 * p_m.y()) + ", " +
                 std::to_string(1e3 * p_m.z()) + ") mm lies in no filled cell of the body; move it inside");
}

std::vector<Landmark> everyNode(const VoxelMesh& mesh) {
  std::vector<Landmark> all;
  for (int node = 0; node < mesh.nodeCount(); ++node) all.push_back({{node}, {1.0}});
  return all;
}

CondensedModel::CondensedModel(StaticSolver& solver, std::vector<NodalField> inputs,
                               const std::vector<Landmark>& landmarks, const Progress& progress) {
  const VoxelMesh& mesh = solver.mesh();
  if (!solver.voxels().prescribed_m().isZero(0.0))
    throw BadInput(
        "condensation: the supports prescribe displacements that are not zero; fix those nodes at 0 and give "
        "the motion as a tool input");
  for (const Landmark& l : landmarks) {
    if (l.nodes.size() != l.weights.size())
      throw BadArgument("condensation: a landmark's nodes and weights differ in number");
    for (const int node : l.nodes)
      if (node < 0 || node >= mesh.nodeCount())
        throw BadArgument("condensation: landmark at node " + std::to_string(node) + " of " +
                          std::to_string(mesh.nodeCount()));
  }
  const auto m = static_cast<Eigen::Index>(inputs.size());
  C_.resize(3 * static_cast<Eigen::Index>(landmarks.size()), m);
  Ctt_.resize(m, m);
  forceSum_N_.resize(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    progress.report(static_cast<double>(j) / static_cast<double>(m), "condensing tool inputs");
    const NodalField& f = inputs[static_cast<std::size_t>(j)];
    const Solution s = solver.solve(f, progress.part(static_cast<double>(j) / static_cast<double>(m),
                                                     static_cast<double>(j + 1) / static_cast<double>(m)));
    if (!s.report.converged())
      throw SolverFailed("condensation: the solve for tool input " + std::to_string(j) + " ended with " +
                             describe(s.report.status) + "; choose another solver or more iterations",
                         s.report.iterations, s.report.residual, s.report.tolerance);
    if (j == 0 || s.report.residual > worst_.residual) worst_ = s.report;
    for (std::size_t l = 0; l < landmarks.size(); ++l) {
      Eigen::Vector3d u = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < landmarks[l].nodes.size(); ++i)
        u += landmarks[l].weights[i] * s.u_m.col(landmarks[l].nodes[i]);
      C_.block<3, 1>(3 * static_cast<Eigen::Index>(l), j) = u;
    }
    for (Eigen::Index i = 0; i < m; ++i) Ctt_(i, j) = inputs[static_cast<std::size_t>(i)].cwiseProduct(s.u_m).sum();
    forceSum_N_[j] = f.colwise().norm().sum();
  }
  Ctt_ = (0.5 * (Ctt_ + Ctt_.transpose())).eval();
  progress.report(1.0, "condensing tool inputs");
}

Eigen::VectorXd CondensedModel::prescribe(const Eigen::VectorXd& mean_m) const {
  if (mean_m.size() != inputs())
    throw BadArgument("prescribe: " + std::to_string(mean_m.size()) + " values for " + std::to_string(inputs()) +
                      " inputs");
  const Eigen::VectorXd diagonal = Ctt_.diagonal();
  if (!(diagonal.array() > 0.0).all())
    throw BadInput("prescribe: a tool input acts on fixed nodes only and moves nothing");
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * Ctt_ * scale.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> factor(unit);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-10))
    throw BadInput(
        "prescribe: the tool inputs depend on each other, so their displacements cannot be chosen one by one");
  return scale.cwiseProduct(factor.solve(scale.cwiseProduct(forceSum_N_.cwiseProduct(mean_m))));
}

}  // namespace glisson::mechanics

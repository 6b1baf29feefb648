// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "mechanics/contact/equilibrium_parts.h"
#include "mechanics/hyperelastic.h"

namespace glisson::mechanics {

double MotionWeights::of(const EquilibriumMotion& motion) const {
  double sum = travel * motion.travel_m;
  if (node.size() > 0) sum += node.cwiseProduct(motion.u_m).sum();
  if (surface.size() > 0) sum += surface.cwiseProduct(motion.surface_u_m).sum();
  return sum;
}

/// Forces of one colour of cells at a time: no node belongs to two cells of one.
std::vector<double> Equilibrium::Parts::workOfCells(const std::vector<double>& lambda) {
  const VoxelBody& body = problem.problem.body;
  const double mu = lameMu(body.poisson), lame = lameLambda(body.poisson);
  const std::size_t n = level().nodes();
  std::vector<double> work(body.E_Pa.size(), 0.0), E(body.E_Pa.size());
  for (int colour = 0; colour < 8; ++colour) {
    const auto has = [&](const Eigen::Vector3i& q) {
      return q.x() % 2 == colour % 2 && q.y() % 2 == colour / 2 % 2 && q.z() % 2 == colour / 4;
    };
    std::fill(E.begin(), E.end(), 0.0);
    for (int c = 0; c < mesh.cellCount(); ++c)
      if (const Eigen::Vector3i q = mesh.cellOf(c); has(q)) {
        const std::size_t i = body.cell(q.x(), q.y(), q.z());
        E[i] = body.E_Pa[i];
      }
    Unbalance force = zero();
    addCells(E, mu, lame, 1, force);
    for (int c = 0; c < mesh.cellCount(); ++c) {
      const Eigen::Vector3i q = mesh.cellOf(c);
      if (!has(q)) continue;
      double& own = work[body.cell(q.x(), q.y(), q.z())];
      for (const int node : mesh.nodesOf(c)) {
        const std::size_t slot = slotOf(level(), mesh, node);
        for (std::size_t axis = 0; axis < 3; ++axis) own += lambda[axis * n + slot] * force[axis * n + slot];
      }
    }
  }
  return work;
}

std::optional<std::vector<double>> Equilibrium::gradientByModuli(const MotionWeights& figure, double tolerance,
                                                                 int limit) {
  Parts& p = *parts_;
  if (!p.usable || !p.energy.hasPotential()) return {};
  const std::size_t n = p.level().nodes();
  Unbalance w = figure.node.size() > 0 ? onNodeSlots(p.level(), p.mesh, figure.node) : std::vector<double>(3 * n, 0.0);
  w.push_back(figure.travel);
  if (figure.surface.size() > 0)
    for (std::size_t s = 0; s < p.kept.size(); ++s)
      p.level().points[s].add<double>(figure.surface.col(static_cast<Eigen::Index>(p.kept[s])), w.data(), n);
  w = p.free(std::move(w));
  std::vector<double> lambda;
  const TangentSolve solve = p.hierarchy.solve(0, w, lambda, tolerance, limit, false);
  if (solve.outcome != TangentOutcome::Converged) return {};
  lambda = p.free(std::move(lambda));
  std::vector<double> gradient = p.workOfCells(lambda);
  // The barrier goes with the mean modulus.
  const std::vector<double>& E = p.problem.problem.body.E_Pa;
  Unbalance contact = p.zero();
  p.addBarrier(E, contact);
  contact = p.free(std::move(contact));
  double all = 0, work = 0;
  for (std::size_t i = 0; i < contact.size(); ++i) work += lambda[i] * contact[i];
  for (const double e : E) all += std::max(e, 0.0);
  for (std::size_t c = 0; c < E.size(); ++c)
    if (E[c] > 0) gradient[c] = -(gradient[c] + work * E[c] / all);
  return gradient;
}

}  // namespace glisson::mechanics

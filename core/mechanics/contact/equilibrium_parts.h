// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mechanics/contact/contact_energy.h"
#include "mechanics/contact/contact_setup.h"
#include "mechanics/contact/equilibrium.h"
#include "mechanics/lattice_operator.h"

namespace glisson::mechanics {

/// A nodal field on the slots of a level: three arrays.
inline std::vector<double> onNodeSlots(const SolidLevel& level, const VoxelMesh& mesh, const NodalField& field) {
  std::vector<double> out(3 * level.nodes(), 0.0);
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const std::size_t slot = slotOf(level, mesh, node);
    for (std::size_t c = 0; c < 3; ++c) out[c * level.nodes() + slot] = field(static_cast<Eigen::Index>(c), node);
  }
  return out;
}

/// A problem on its cells with its potential.
struct Assembled {
  ContactProblem problem;
  VoxelMesh mesh;
  SolidHierarchy hierarchy;
  std::vector<std::size_t> kept;
  ContactEnergy energy;

  Assembled(ContactProblem p, const ContactOptions& options)
      : problem(std::move(p)),
        mesh(problem.problem.body),
        hierarchy(finestLevel(problem)),
        energy(hierarchy, carriedSurface(hierarchy, problem, kept), problem, options) {
    energy.setLoads(0, loadsOnLevels(hierarchy, problem).front());
  }
  const SolidLevel& level() const { return hierarchy.level(0); }
  bool travels() const { return problem.force_N.has_value() && energy.hasBar(); }
};

/// What an equilibrium keeps for the solves that follow it.
struct Equilibrium::Parts : Assembled {
  ContactOptions options;
  ContactEnergy::State at;
  bool usable = false;
  double residual = 0;
  SolidLevel cells;  ///< without springs and skin; its moduli are set for each use

  Parts(const ContactProblem& p, const ContactOptions& o, const NodalField& u_m, double travel_m,
        const std::optional<Eigen::Vector3d>& barStart_m)
      : Assembled(p, o), options(o), cells(level()) {
    if (u_m.cols() != mesh.nodeCount()) throw BadArgument("Equilibrium: the displacements are those of another body");
    cells.springs.clear();
    cells.membrane = {};
    at.u = onNodeSlots(level(), mesh, u_m);
    at.s = energy.hasBar() ? travel_m : 0;
    if (energy.hasBar() && barStart_m) energy.moveBar(*barStart_m - energy.bar().centreline_m.front());
    ContactEnergy::Value value;
    if (!energy.evaluate(at, problem.force_N, travels(), value)) return;
    double sum = 0;
    for (const double g : value.gradient) sum += g * g;
    residual = std::sqrt(sum) / std::max({std::abs(problem.force_N.value_or(value.contact_N)), value.loads_N, 1e-12});
    hierarchy.setFollowers(energy.followers(at));
    usable = hierarchy.linearise(0, energy.law(), at.u.data(), energy.stiffness(at), travels(),
                                 energy.hasBar() ? energy.bar().hoist : Eigen::Vector3d::Zero());
  }

  /// Forces of cells of Young's modulus (times cover) E in this state, by shares of Lamé's constants; factor: times
  /// them.
  void addCells(const std::vector<double>& E_Pa, double mu, double lambda, double factor, Unbalance& out) {
    const double volume = cells.moduli.h_m.prod();
    cells.mu = cellSlotsOf<double>(*cells.lattice, E_Pa, mu * volume);
    cells.lambda = cellSlotsOf<double>(*cells.lattice, E_Pa, lambda * volume);
    std::vector<double> force(out.size(), 0.0);
    double energy_J = 0;
    cells.forces(energy.law(), at.u.data(), energy_J, force.data());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += factor * force[i];
  }
  Unbalance zero() const { return Unbalance(level().size(), 0.0); }
  /// Held displacements feel nothing, nor does a travel that is given.
  Unbalance free(Unbalance u) const {
    const std::size_t n = 3 * level().nodes();
    for (std::size_t i = 0; i < n; ++i)
      if (!(level().active[i] > 0)) u[i] = 0;
    if (!travels()) u[n] = 0;
    return u;
  }
  /// Adds `factor` times the gradient of the contact with this bar and the samples `outward_m` further out.
  void addContact(const RigidBar& bar, double outward_m, double factor, Unbalance& out) const {
    const std::size_t n = level().nodes();
    const double near_m = energy.barrier().width_m + 1e-3;
    for (std::size_t p = 0; p < energy.surface().size(); ++p) {
      const SurfaceSample& sample = energy.surface()[p];
      if (gapTo(energy.bar(), energy.place(p, at), at.s).g_m > near_m) continue;
      CarriedPoint point = level().points[p];
      const Eigen::Vector3d rest = sample.p_m + outward_m * sample.normal;
      if (outward_m != 0) point = level().carry(*carrierCell(mesh, sample.p_m), rest);
      const Gap gap = gapTo(bar, rest + point.at(at.u.data(), n), at.s);
      if (!energy.barrier().acts(gap.g_m)) continue;
      const Eigen::Vector3d f = factor * sample.area_m2 * energy.barrier().at(gap.g_m).first * gap.n;
      point.add<double>(f, out.data(), n);
      out[3 * n] -= f.dot(bar.hoist);
    }
  }
  // ∂r/∂p of each entry of Change.
  Unbalance byModuli(const std::vector<double>& relative);
  Unbalance byPoisson(bool shearKept);
  Unbalance bySupports();
  Unbalance bySkin();
  /// The barrier goes with the mean modulus: adds what that does, where the cells' moduli rise by `more_Pa`.
  void addBarrier(const std::vector<double>& more_Pa, Unbalance& out) const {
    double rise = 0, sum = 0;
    for (std::size_t c = 0; c < more_Pa.size(); ++c) {
      if (!(problem.problem.body.E_Pa[c] > 0)) continue;
      rise += more_Pa[c];
      sum += problem.problem.body.E_Pa[c];
    }
    if (energy.hasBar()) addContact(energy.bar(), 0, rise / sum, out);
  }
  /// λ · force of each cell in this state, J; x fastest.
  std::vector<double> workOfCells(const std::vector<double>& lambda);
  Unbalance byBar(const Eigen::Vector3d& shift_m, const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& pivot_m);
  Unbalance bySurface(const std::vector<double>& growth_Pa_m);
  EquilibriumMotion motionOf(const std::vector<double>& d) const {
    EquilibriumMotion m;
    const std::size_t n = level().nodes();
    m.u_m.resize(3, mesh.nodeCount());
    for (int node = 0; node < mesh.nodeCount(); ++node) {
      const std::size_t slot = slotOf(level(), mesh, node);
      for (std::size_t c = 0; c < 3; ++c) m.u_m(static_cast<Eigen::Index>(c), node) = d[c * n + slot];
    }
    m.surface_u_m = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(problem.surface.size()));
    for (std::size_t p = 0; p < kept.size(); ++p)
      m.surface_u_m.col(static_cast<Eigen::Index>(kept[p])) = level().points[p].at(d.data(), n);
    m.travel_m = d[3 * n];
    m.found = true;
    return m;
  }
  std::optional<std::vector<double>> goTo(const Change& change, const std::vector<double>& from,
                                          const std::vector<double>* ahead, double tolerance, const Progress& progress,
                                          int& iterations) const;
};

}  // namespace glisson::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/contact_setup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "mechanics/hyperelastic.h"
#include "mechanics/measures.h"

namespace glisson::mechanics {
namespace {

constexpr int searchReach = 3;  ///< cells

}  // namespace

std::size_t slotOf(const SolidLevel& level, const VoxelMesh& mesh, int node) {
  const Eigen::Vector3i at = mesh.latticeOf(node);
  return level.lattice->slot(at.x(), at.y(), at.z());
}

std::optional<Eigen::Vector3i> carrierCell(const VoxelMesh& mesh, const Eigen::Vector3d& p_m) {
  const Eigen::Vector3d q = p_m.cwiseQuotient(mesh.h_m());
  const Eigen::Vector3i home = q.array().floor().cast<int>();
  if (mesh.isFilled(home.x(), home.y(), home.z())) return home;
  std::optional<Eigen::Vector3i> best;
  double nearest = std::numeric_limits<double>::infinity();
  const double shortest = mesh.h_m().minCoeff();
  for (int ring = 1; ring <= searchReach; ++ring) {
    for (int k = -ring; k <= ring; ++k)
      for (int j = -ring; j <= ring; ++j)
        for (int i = -ring; i <= ring; ++i) {
          if (std::max({std::abs(i), std::abs(j), std::abs(k)}) != ring) continue;
          const Eigen::Vector3i cell = home + Eigen::Vector3i(i, j, k);
          if (!mesh.isFilled(cell.x(), cell.y(), cell.z())) continue;
          const Eigen::Vector3d low = cell.cast<double>(), high = low + Eigen::Vector3d::Ones();
          const Eigen::Vector3d off = (q - q.cwiseMax(low).cwiseMin(high)).cwiseProduct(mesh.h_m());
          const Eigen::Vector3d middle = (q - 0.5 * (low + high)).cwiseProduct(mesh.h_m());
          const double d = off.squaredNorm() + 1e-6 * middle.squaredNorm();
          if (d < nearest) {
            nearest = d;
            best = cell;
          }
        }
    // Cells of the next ring are further away than this.
    if (nearest < std::pow(ring * shortest, 2)) break;
  }
  return best;
}

Eigen::Vector3i nearestCell(const VoxelMesh& mesh, const Eigen::Vector3d& p_m) {
  if (const auto cell = carrierCell(mesh, p_m)) return *cell;
  Eigen::Vector3i best = mesh.cellOf(0);
  double nearest = std::numeric_limits<double>::infinity();
  for (int c = 0; c < mesh.cellCount(); ++c) {
    const Eigen::Vector3i at = mesh.cellOf(c);
    const double d =
        ((at.cast<double>() + Eigen::Vector3d::Constant(0.5)).cwiseProduct(mesh.h_m()) - p_m).squaredNorm();
    if (d < nearest) nearest = d, best = at;
  }
  return best;
}

std::vector<double> rindOf(const VoxelBody& body, const std::vector<SurfaceSample>& surface, double stiffness_N_m,
                           double depth_m) {
  const VoxelMesh mesh(body);
  std::vector<double> rind(body.E_Pa.size(), 0.0);
  // Four places to a cell's edge, so that a cell takes its share of the layer.
  const int places = std::max(1, static_cast<int>(std::ceil(4 * depth_m / body.h_m.minCoeff())));
  const double share = stiffness_N_m / (places * body.h_m.prod());
  for (const SurfaceSample& s : surface)
    for (int i = 0; i < places; ++i)
      if (const auto cell = carrierCell(mesh, s.p_m - (i + 0.5) / places * depth_m * s.normal))
        rind[body.cell(cell->x(), cell->y(), cell->z())] += share * s.area_m2;
  return rind;
}

SolidLevel finestLevel(const ContactProblem& problem) {
  const VoxelBody& body = problem.problem.body;
  const VoxelMesh mesh(body);
  CellModuli moduli;
  moduli.cells = body.cells;
  moduli.h_m = body.h_m;
  moduli.mu_Pa.assign(body.E_Pa.size(), 0.0);
  moduli.lambda_Pa.assign(body.E_Pa.size(), 0.0);
  for (std::size_t c = 0; c < body.E_Pa.size(); ++c) {
    if (!(body.E_Pa[c] > 0)) continue;
    moduli.mu_Pa[c] = body.E_Pa[c] * lameMu(body.poisson);
    moduli.lambda_Pa[c] = body.E_Pa[c] * lameLambda(body.poisson);
    if (problem.rind_Pa.empty()) continue;
    moduli.mu_Pa[c] += problem.rind_Pa[c] * lameMu(problem.rindPoisson);
    moduli.lambda_Pa[c] += problem.rind_Pa[c] * lameLambda(problem.rindPoisson);
  }
  SolidLevel level(std::move(moduli));
  const std::size_t n = level.nodes();
  for (const Fixation& f : problem.problem.supports.fixations)
    for (std::size_t c = 0; c < 3; ++c)
      if (f.axis[c]) level.active[c * n + slotOf(level, mesh, f.node)] = 0;
  for (std::size_t i = 0; i < 3 * n; ++i)
    if (level.there[i % n] != 0 && !(level.active[i] > 0)) level.fixed.push_back(i);
  std::vector<Eigen::Matrix3d> sums(n, Eigen::Matrix3d::Zero());
  for (const Spring& s : problem.problem.supports.springs) sums[slotOf(level, mesh, s.node)] += s.k_N_m;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Matrix3d& k = sums[i];
    if (k.isZero(0)) continue;
    level.springs.push_back({i, {k(0, 0), k(0, 1), k(0, 2), k(1, 1), k(1, 2), k(2, 2)}});
  }
  return level;
}

std::vector<SurfaceSample> carriedSurface(SolidHierarchy& hierarchy, const ContactProblem& problem,
                                          std::vector<std::size_t>& kept) {
  std::vector<SurfaceSample> surface;
  std::vector<Eigen::Vector3i> cells;
  std::vector<Eigen::Vector3d> places;
  const VoxelMesh mesh(problem.problem.body);
  for (std::size_t p = 0; p < problem.surface.size(); ++p) {
    const auto cell = carrierCell(mesh, problem.surface[p].p_m);
    if (!cell) continue;
    kept.push_back(p);
    surface.push_back(problem.surface[p]);
    cells.push_back(*cell);
    places.push_back(problem.surface[p].p_m);
  }
  if (problem.skin && problem.skin->stiffness_N_m > 0) {
    std::vector<SkinSample> skin;
    for (std::size_t i = 0; i < surface.size(); ++i)
      skin.push_back({cells[i], surface[i].p_m, surface[i].normal, surface[i].area_m2});
    hierarchy.setSkin(skin, *problem.skin);
  }
  const auto carried = [&](const Eigen::Vector3d& p_m) {
    const auto cell = carrierCell(mesh, p_m);
    if (!cell) throw BadArgument("a face or bed of the surface is nowhere near a cell");
    cells.push_back(*cell);
    places.push_back(p_m);
  };
  for (const BedSample& b : problem.bed) carried(b.p_m);
  for (const Tether& t : problem.tethers) carried(t.p_m);
  for (const FollowerFace& f : problem.pressures)
    for (const Eigen::Vector3d& corner : f.corner_m) carried(corner);
  hierarchy.setPoints(cells, places);
  return surface;
}

std::vector<std::vector<double>> loadsOnLevels(const SolidHierarchy& hierarchy, const ContactProblem& problem) {
  std::vector<std::vector<double>> loads;
  const SolidLevel& finest = hierarchy.level(0);
  const VoxelMesh mesh(problem.problem.body);
  const NodalField& f = problem.problem.f_N;
  if (f.cols() == 0 || f.isZero(0)) return std::vector<std::vector<double>>(hierarchy.levels());
  loads.emplace_back(3 * finest.nodes(), 0.0);
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const std::size_t slot = slotOf(finest, mesh, node);
    for (std::size_t c = 0; c < 3; ++c) loads[0][c * finest.nodes() + slot] = f(static_cast<Eigen::Index>(c), node);
  }
  for (std::size_t l = 0; l + 1 < hierarchy.levels(); ++l) {
    const SolidLevel& fine = hierarchy.level(l);
    const SolidLevel& coarse = hierarchy.level(l + 1);
    std::vector<double> next(3 * coarse.nodes(), 0.0);
    forParentsOfNodes(*fine.lattice, *coarse.lattice, fine.halved, [&](std::size_t slot, std::size_t parent, double w) {
      for (std::size_t c = 0; c < 3; ++c) next[c * coarse.nodes() + parent] += w * loads[l][c * fine.nodes() + slot];
    });
    loads.push_back(std::move(next));
  }
  return loads;
}

std::size_t pathLevel(const SolidHierarchy& hierarchy, const ContactProblem& problem) {
  constexpr double coarsestOfRadius = 1.4;
  std::size_t l = 0;
  for (const Fixation& f : problem.problem.supports.fixations)
    if (!f.value_m.isZero(0)) return 0;
  while (problem.bar && l + 2 < hierarchy.levels() &&
         hierarchy.level(l + 1).moduli.h_m.maxCoeff() <= coarsestOfRadius * problem.bar->radius_m)
    ++l;
  return l;
}

std::vector<double> prescribedOnFinest(const SolidLevel& level, const ContactProblem& problem) {
  const VoxelMesh mesh(problem.problem.body);
  std::vector<double> u(3 * level.nodes(), 0.0);
  for (const Fixation& f : problem.problem.supports.fixations)
    for (std::size_t c = 0; c < 3; ++c)
      if (f.axis[c]) u[c * level.nodes() + slotOf(level, mesh, f.node)] = f.value_m[static_cast<Eigen::Index>(c)];
  return u;
}

namespace {

void describeContact(const ContactEnergy& energy, const std::vector<std::size_t>& kept, const ContactEnergy::State& at,
                     std::size_t samples, ContactSolution& out) {
  out.pressure_Pa.assign(samples, 0.0);
  out.surface_u_m = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(samples));
  const Eigen::Vector3d centre =
      energy.hasBar() ? Eigen::Vector3d(energy.bar().centre_m() + at.s * energy.bar().hoist) : Eigen::Vector3d::Zero();
  for (std::size_t p = 0; p < energy.surface().size(); ++p) {
    const SurfaceSample& sample = energy.surface()[p];
    const Eigen::Vector3d x = energy.place(p, at);
    out.surface_u_m.col(static_cast<Eigen::Index>(kept[p])) = x - sample.p_m;
    if (!energy.hasBar()) continue;
    const Gap gap = gapTo(energy.bar(), x, at.s);
    if (!energy.barrier().acts(gap.g_m)) continue;
    const double pressure = -energy.barrier().at(gap.g_m).first;
    const Eigen::Vector3d f = sample.area_m2 * pressure * gap.n;
    out.force_N += f;
    out.moment_Nm += (x - gap.g_m * gap.n - centre).cross(f);
    out.pressure_Pa[kept[p]] = pressure;
    out.pressureMax_Pa = std::max(out.pressureMax_Pa, pressure);
    out.penetrationMax_m = std::max(out.penetrationMax_m, -gap.g_m);
    out.area_m2 += sample.area_m2;
    out.footprint_m2 += sample.area_m2 * std::max(0.0, gap.n.dot(energy.bar().hoist));
  }
}

}  // namespace

void describe(const SolidHierarchy& hierarchy, const ContactEnergy& energy, const ContactProblem& problem,
              const std::vector<std::size_t>& kept, const ContactEnergy::State& at, ContactSolution& out) {
  const SolidLevel& level = hierarchy.level(energy.top());
  const std::size_t n = level.nodes();
  out.travel_m = energy.hasBar() ? at.s : 0;
  out.touch_m = 0.5 * energy.barrier().width_m;
  out.smallestJ = level.smallestVolumeRatio(at.u.data());
  describeContact(energy, kept, at, problem.surface.size(), out);
  if (energy.hasBar()) out.bar = energy.bar();
  if (energy.top() != 0) return;
  const VoxelMesh mesh(problem.problem.body);
  Solution& solution = out.solution;
  solution.u_m.resize(3, mesh.nodeCount());
  solution.reaction_N = NodalField::Zero(3, mesh.nodeCount());
  std::vector<double> force(level.size()), holding(3 * n, 0.0);
  level.forces(energy.law(), at.u.data(), solution.energy_J, force.data());
  ContactEnergy::Value value;
  energy.unbalanced(at, value);
  out.following_N = energy.following_N(at);
  out.tether_N.clear();
  solution.energy_J += energy.addHolding(at, holding.data(), out.tether_N);
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const std::size_t slot = slotOf(level, mesh, node);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto axis = static_cast<Eigen::Index>(c);
      const std::size_t i = c * n + slot;
      solution.u_m(axis, node) = at.u[i];
      solution.reaction_N(axis, node) = holding[i];
      if (!(level.active[i] > 0)) solution.reaction_N(axis, node) += value.gradient[i];
    }
  }
  for (const Spring& s : problem.problem.supports.springs)
    solution.reaction_N.col(s.node) -= s.k_N_m * solution.u_m.col(s.node);
}

}  // namespace glisson::mechanics

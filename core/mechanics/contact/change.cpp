// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/change.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mechanics/contact/contact_setup.h"

namespace glisson::mechanics {
namespace {

constexpr double mostPoisson = 0.497;
constexpr double leastLeft = 0.1;  ///< of a cell's modulus times cover, where the surface moves inwards

Eigen::Matrix3d rotation(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  if (!(angle > 0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix();
}

void changeModuli(const Change& c, VoxelBody& body) {
  for (std::size_t i = 0; i < c.logModuli.size(); ++i) body.E_Pa[i] *= std::exp(c.logModuli[i]);
  for (std::size_t i = 0; i < c.growth_Pa_m.size() && c.outward_m != 0; ++i)
    if (body.E_Pa[i] > 0)
      body.E_Pa[i] = std::max(leastLeft * body.E_Pa[i], body.E_Pa[i] + c.outward_m * c.growth_Pa_m[i]);
  if (c.poisson == 0) return;
  const double before = body.poisson;
  body.poisson = std::min(body.poisson + c.poisson, mostPoisson);
  if (c.shearKept)
    for (double& E : body.E_Pa) E *= (1 + body.poisson) / (1 + before);
}

}  // namespace

RigidBar moved(const RigidBar& bar, const Eigen::Vector3d& shift_m, const Eigen::Vector3d& turn_rad,
               const Eigen::Vector3d& pivot_m) {
  const Eigen::Matrix3d R = rotation(turn_rad);
  RigidBar out = bar;
  for (Eigen::Vector3d& p : out.centreline_m) p = R * (p - pivot_m) + pivot_m;
  out.hoist = R * bar.hoist;
  if (out.arc) {
    out.arc->centre_m = R * (out.arc->centre_m - pivot_m) + pivot_m;
    out.arc->middle = R * out.arc->middle;
    out.arc->along = R * out.arc->along;
  }
  out.shift(shift_m);
  return out;
}

ContactProblem changed(const ContactProblem& problem, const Change& change) {
  ContactProblem out = problem;
  changeModuli(change, out.problem.body);
  const double supports = std::exp(change.logSupports), skin = std::exp(change.logSkin);
  for (Spring& s : out.problem.supports.springs) s.k_N_m *= supports;
  for (BedSample& b : out.bed) b.k_N_m *= supports, b.tangential_N_m *= supports;
  for (Tether& t : out.tethers) t.k_N_m *= supports;
  if (out.skin) out.skin->stiffness_N_m *= skin;
  for (double& E : out.rind_Pa) E *= skin;
  if (out.force_N) *out.force_N += change.force_N;
  if (out.bar) out.bar = moved(*out.bar, change.barShift_m, change.barTurn_rad, change.pivot_m);
  for (SurfaceSample& s : out.surface) s.p_m += change.outward_m * s.normal;
  return out;
}

std::vector<double> growthOf(const ContactProblem& problem, const std::vector<float>& cover) {
  const VoxelBody& body = problem.problem.body;
  const VoxelMesh mesh(body);
  std::vector<double> growth(body.E_Pa.size(), 0.0);
  const double volume = body.h_m.prod();
  for (const SurfaceSample& s : problem.surface) {
    const auto cell = carrierCell(mesh, s.p_m);
    if (!cell) continue;
    const std::size_t c = body.cell(cell->x(), cell->y(), cell->z());
    const double f = static_cast<double>(cover[c]);
    if (f > 0 && f < 1) growth[c] += s.area_m2 / volume * body.E_Pa[c] / f;
  }
  return growth;
}

}  // namespace glisson::mechanics

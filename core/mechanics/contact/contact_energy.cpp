// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/contact_energy.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 1024;
/// The barrier's stiffness over the body's mean modulus, 20 kPa/mm at 6 kPa: bodies that differ in scale only have the
/// same answers at forces in proportion.
constexpr double perModulus_1_m = 1e4 / 3;
constexpr double widestOfRadius = 0.2;  ///< of a barrier, so that thin bars are thin

double meanModulus(const VoxelBody& body) {
  double sum = 0, count = 0;
  for (const double E : body.E_Pa)
    if (E > 0) {
      sum += E;
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

}  // namespace

ContactEnergy::ContactEnergy(const SolidHierarchy& hierarchy, std::vector<SurfaceSample> surface,
                             const ContactProblem& problem, const ContactOptions& options)
    : hierarchy_(hierarchy),
      surface_(std::move(surface)),
      bed_(problem.bed),
      tethers_(problem.tethers),
      pressures_(problem.pressures),
      law_(problem.law),
      bar_(problem.bar) {
  barrier_.width_m = bar_ ? std::min(options.zone_m, widestOfRadius * bar_->radius_m) : options.zone_m;
  barrier_.kappa_Pa_m = perModulus_1_m * meanModulus(problem.problem.body) * 1e-3 / barrier_.width_m;
  if (!pressures_.empty())
    potential_ = potentialOf(VoxelMesh(problem.problem.body), pressures_, problem.problem.supports.fixations);
  if (!bar_) return;
  barrier_.guard_m = 0.4 * bar_->radius_m;
  std::vector<Eigen::Vector3d> atRest;
  for (const SurfaceSample& s : surface_) atRest.push_back(s.p_m);
  bringToForce(atRest);
  sortIntoCubes();
}

void ContactEnergy::setLoads(std::size_t top, const std::vector<double>& loads) {
  top_ = top;
  loads_ = loads;
  near_ = {};
  spread_ = 1;
  for (const CarriedPoint& p : hierarchy_.level(top).points) {
    double sum = 0;
    for (const float w : p.weight) sum += std::abs(static_cast<double>(w));
    spread_ = std::max(spread_, sum);
  }
}

bool ContactEnergy::evaluate(const State& at, std::optional<double> force_N, bool travels, Value& value) const {
  if (!unbalanced(at, value)) return false;
  const SolidLevel& level = hierarchy_.level(top_);
  const std::size_t n = level.nodes();
  for (std::size_t i = 0; i < 3 * n; ++i)
    if (!(level.active[i] > 0)) value.gradient[i] = 0;
  if (travels && force_N) {
    value.potential -= *force_N * at.s;
    value.gradient[3 * n] = value.barForce_N - *force_N;
  }
  return std::isfinite(value.potential);
}

bool ContactEnergy::unbalanced(const State& at, Value& value) const {
  const SolidLevel& level = hierarchy_.level(top_);
  const std::size_t n = level.nodes();
  value.gradient.resize(level.size());
  if (!level.forces(law_, at.u.data(), value.potential, value.gradient.data())) return false;
  value.barForce_N = value.contact_N = value.loads_N = value.deepest_m = 0;
  if (bar_) {
    const std::vector<std::uint32_t>& samples = near(at);
    gaps_.resize(samples.size());
    parallelChunks(samples.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) gaps_[i] = gapTo(*bar_, place(samples[i], at), at.s);
    });
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Gap& gap = gaps_[i];
      if (!barrier_.acts(gap.g_m)) continue;
      value.deepest_m = std::max(value.deepest_m, -gap.g_m);
      if (!barrier_.feasible(gap.g_m)) return false;
      const Barrier::Value phi = barrier_.at(gap.g_m);
      const std::size_t p = samples[i];
      const double w = surface_[p].area_m2;
      value.potential += w * phi.energy;
      level.points[p].add<double>(w * phi.first * gap.n, value.gradient.data(), n);
      value.barForce_N -= w * phi.first * gap.n.dot(bar_->hoist);
      value.contact_N -= w * phi.first;
    }
  }
  addBed(at, value);
  addTethers(at, value);
  double pressed = value.loads_N;
  addPressures(at, value);
  pressed = value.loads_N - pressed;
  value.loads_N = 0;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    value.potential -= loads_[i] * at.u[i];
    value.gradient[i] -= loads_[i];
    value.loads_N += level.active[i] > 0 ? loads_[i] * loads_[i] : 0;
  }
  value.loads_N = std::sqrt(value.loads_N + pressed);
  value.gradient[3 * n] = 0;
  return true;
}

namespace {

/// Force of the bed on a place of the surface that has moved by u, N.
Eigen::Vector3d forceOf(const BedSample& bed, const Eigen::Vector3d& u) {
  const double along = u.dot(bed.outward);
  return -bed.k_N_m * std::max(0.0, along) * bed.outward - bed.tangential_N_m * (u - along * bed.outward);
}

/// A tether where it is now.
struct Pulled {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();  ///< unit, from its anchor
  double length_m = 0, longer_m = 0;

  Pulled(const Tether& tether, const Eigen::Vector3d& u) {
    const Eigen::Vector3d from = tether.p_m + u - tether.anchor_m;
    length_m = from.norm();
    if (length_m > 0) out = from / length_m;
    longer_m = length_m - tether.length_m;
    if (!tether.twoSided) longer_m = std::max(0.0, longer_m);
  }
};

}  // namespace

void ContactEnergy::addBed(const State& at, Value& value) const {
  const SolidLevel& level = hierarchy_.level(top_);
  for (std::size_t b = 0; b < bed_.size(); ++b) {
    const CarriedPoint& point = level.points[surface_.size() + b];
    const Eigen::Vector3d u = point.at(at.u.data(), level.nodes());
    const Eigen::Vector3d force = forceOf(bed_[b], u);
    if (force.isZero(0)) continue;
    value.potential -= 0.5 * force.dot(u);
    point.add<double>(-force, value.gradient.data(), level.nodes());
  }
}

void ContactEnergy::addTethers(const State& at, Value& value) const {
  const SolidLevel& level = hierarchy_.level(top_);
  for (std::size_t t = 0; t < tethers_.size(); ++t) {
    const CarriedPoint& point = level.points[surface_.size() + bed_.size() + t];
    const Pulled pulled(tethers_[t], point.at(at.u.data(), level.nodes()));
    value.potential += 0.5 * tethers_[t].k_N_m * pulled.longer_m * pulled.longer_m;
    point.add<double>(tethers_[t].k_N_m * pulled.longer_m * pulled.out, value.gradient.data(), level.nodes());
  }
}

double ContactEnergy::addHolding(const State& at, double* forces, std::vector<Eigen::Vector3d>& tether_N) const {
  const SolidLevel& level = hierarchy_.level(top_);
  double energy_J = 0;
  for (std::size_t b = 0; b < bed_.size(); ++b) {
    const CarriedPoint& point = level.points[surface_.size() + b];
    const Eigen::Vector3d u = point.at(at.u.data(), level.nodes()), force = forceOf(bed_[b], u);
    energy_J -= 0.5 * force.dot(u);
    point.add<double>(force, forces, level.nodes());
  }
  for (std::size_t t = 0; t < tethers_.size(); ++t) {
    const CarriedPoint& point = level.points[surface_.size() + bed_.size() + t];
    const Pulled pulled(tethers_[t], point.at(at.u.data(), level.nodes()));
    energy_J += 0.5 * tethers_[t].k_N_m * pulled.longer_m * pulled.longer_m;
    tether_N.push_back(-tethers_[t].k_N_m * pulled.longer_m * pulled.out);
    point.add<double>(tether_N.back(), forces, level.nodes());
  }
  return energy_J;
}

template <class F>
void ContactEnergy::forTriangles(const State& at, const F& f) const {
  constexpr std::array<std::array<std::size_t, 3>, 4> triangles = {{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};
  const SolidLevel& level = hierarchy_.level(top_);
  for (std::size_t p = 0; p < pressures_.size(); ++p) {
    const FollowerFace& face = pressures_[p];
    const std::size_t first = surface_.size() + bed_.size() + tethers_.size() + 4 * p;
    std::array<Eigen::Vector3d, 4> x;
    for (std::size_t c = 0; c < 4; ++c)
      x[c] = face.corner_m[c] + level.points[first + c].at(at.u.data(), level.nodes());
    for (const auto& t : triangles) {
      FollowerTriangle triangle{{x[t[0]], x[t[1]], x[t[2]]}, 0.5 * pressureShare_ * face.pressure_Pa, 0, {}};
      if (!face.shear_Pa.isZero(0)) {
        Eigen::Matrix<double, 3, 2> edges;
        edges << face.corner_m[t[1]] - face.corner_m[t[0]], face.corner_m[t[2]] - face.corner_m[t[0]];
        const Eigen::Vector2d along =
            (edges.transpose() * edges).inverse() * (edges.transpose() * face.shear_Pa.normalized());
        triangle.shear_Pa = 0.5 * pressureShare_ * face.shear_Pa.norm();
        triangle.along = {along[0], along[1]};
      }
      f(std::array<std::size_t, 3>{first + t[0], first + t[1], first + t[2]}, triangle);
    }
  }
}

void ContactEnergy::addPressures(const State& at, Value& value) const {
  const SolidLevel& level = hierarchy_.level(top_);
  forTriangles(at, [&](const auto& points, const FollowerTriangle& triangle) {
    if (potential_) value.potential += triangle.pressure_Pa * triangle.volume_m3(*potential_);
    const Eigen::Vector3d force = triangle.force_N();
    for (const std::size_t p : points)
      level.points[p].template add<double>(-force / 3, value.gradient.data(), level.nodes());
    value.loads_N += force.squaredNorm();
  });
}

Eigen::Vector3d ContactEnergy::following_N(const State& at) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  forTriangles(at, [&](const auto&, const FollowerTriangle& triangle) { sum += triangle.force_N(); });
  return sum;
}

std::vector<FollowerStiffness> ContactEnergy::followers(const State& at) const {
  std::vector<FollowerStiffness> out;
  forTriangles(at, [&](const auto& points, const FollowerTriangle& triangle) {
    const std::array<Eigen::Matrix3d, 3> stiffness = triangle.stiffness_N_m();
    FollowerStiffness& f = out.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      f.point[i] = static_cast<std::uint32_t>(points[i]);
      f.share[i] = (-stiffness[i] / 3).template cast<float>();
    }
  });
  return out;
}

std::vector<PointStiffness> ContactEnergy::stiffness(const State& at) const {
  std::vector<PointStiffness> out;
  const SolidLevel& level = hierarchy_.level(top_);
  const auto holds = [&](std::size_t point, const Eigen::Matrix3d& exact, const Eigen::Matrix3d& positive) {
    PointStiffness& k = out.emplace_back();
    k.point = static_cast<std::uint32_t>(point);
    k.bar = false;
    k.exact = exact.cast<float>();
    k.positive = positive.cast<float>();
  };
  for (std::size_t b = 0; b < bed_.size(); ++b) {
    const std::size_t point = surface_.size() + b;
    const Eigen::Matrix3d nn = bed_[b].outward * bed_[b].outward.transpose();
    Eigen::Matrix3d K = bed_[b].tangential_N_m * (Eigen::Matrix3d::Identity() - nn);
    // At rest the bed is there already: a body that only lies on it is held.
    if (level.points[point].at(at.u.data(), level.nodes()).dot(bed_[b].outward) >= 0) K += bed_[b].k_N_m * nn;
    if (!K.isZero(0)) holds(point, K, K);
  }
  for (std::size_t t = 0; t < tethers_.size(); ++t) {
    const std::size_t point = surface_.size() + bed_.size() + t;
    const Pulled pulled(tethers_[t], level.points[point].at(at.u.data(), level.nodes()));
    // So are tethers that are not slack.
    if (!tethers_[t].twoSided && pulled.length_m < (1 - 1e-9) * tethers_[t].length_m) continue;
    const Eigen::Matrix3d nn = pulled.out * pulled.out.transpose();
    const double turn = pulled.length_m > 0 ? pulled.longer_m / pulled.length_m : 0;
    const Eigen::Matrix3d across = tethers_[t].k_N_m * turn * (Eigen::Matrix3d::Identity() - nn);
    const Eigen::Matrix3d along = tethers_[t].k_N_m * nn;
    holds(point, along + across, turn > 0 ? Eigen::Matrix3d(along + across) : along);
  }
  if (!bar_) return out;
  for (const std::uint32_t p : near(at)) {
    const Gap gap = gapTo(*bar_, place(p, at), at.s);
    if (!barrier_.acts(gap.g_m) || !barrier_.feasible(gap.g_m)) continue;
    const Barrier::Value phi = barrier_.at(gap.g_m);
    const Eigen::Matrix3d nn = gap.n * gap.n.transpose();
    PointStiffness k;
    k.point = p;
    k.positive = (surface_[p].area_m2 * phi.second * nn).cast<float>();
    k.exact = (surface_[p].area_m2 * (phi.second * nn + phi.first * gap.curvature())).cast<float>();
    out.push_back(k);
  }
  return out;
}

}  // namespace glisson::mechanics

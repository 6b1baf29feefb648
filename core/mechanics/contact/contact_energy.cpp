#include "mechanics/contact/contact_energy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 1024;
constexpr double reach_m = 0.02;  ///< samples within this of the bar are looked at, until something has moved as far
/// The barrier of soft tissue: 20 kPa/mm, or the mean modulus over a millimetre where the body is stiffer.
constexpr double softest_Pa_m = 2e7;

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
      pressures_(problem.pressures),
      law_(problem.law), bar_(problem.bar) {
  barrier_.width_m = options.zone_m;
  barrier_.kappa_Pa_m = std::max(softest_Pa_m, 1e3 * meanModulus(problem.problem.body)) * 1e-3 / options.zone_m;
  for (const FollowerFace& f : pressures_) middle_ += f.corner_m[0] / static_cast<double>(pressures_.size());
  if (bar_) barrier_.guard_m = 0.4 * bar_->radius_m;
  if (bar_) bringToTouch();
}

void ContactEnergy::bringToTouch() {
  constexpr double far_m = 0.5;
  const auto nearest = [&](double s) {
    double g = std::numeric_limits<double>::infinity();
    for (const SurfaceSample& p : surface_) g = std::min(g, gapTo(*bar_, p.p_m, s).g_m);
    return g;
  };
  // Sphere tracing: a bar moved by no more than its distance from the surface cannot pass it.
  double s = -far_m;
  for (int step = 0; step < 1000 && s < far_m; ++step) {
    const double g = nearest(s);
    if (g < 1e-7) {
      bar_->shift(s * bar_->hoist);
      return;
    }
    s += g;
  }
  throw BadInput(
      "no contact: the retractor moved along its hoist does not meet the surface; move its point onto the surface");
}

Eigen::Vector3d ContactEnergy::place(std::size_t sample, const State& at) const {
  const SolidLevel& level = hierarchy_.level(top_);
  return surface_[sample].p_m + level.points[sample].at(at.u.data(), level.nodes());
}

void ContactEnergy::moveBar(const Eigen::Vector3d& by_m) {
  bar_->shift(by_m);
  near_.barMoved_m += by_m.norm();
}

Eigen::Vector3d ContactEnergy::force(const State& at) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t p : near(at)) {
    const Gap gap = gapTo(*bar_, place(p, at), at.s);
    if (barrier_.acts(gap.g_m)) sum -= surface_[p].area_m2 * barrier_.at(gap.g_m).first * gap.n;
  }
  return sum;
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

double ContactEnergy::movedSince(const State& at) const {
  if (near_.top != top_ || near_.at.u.size() != at.u.size()) return std::numeric_limits<double>::infinity();
  const std::size_t n = at.u.size() / 3;
  const double *a = at.u.data(), *b = near_.at.u.data();
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = a[i] - b[i], y = a[n + i] - b[n + i], z = a[2 * n + i] - b[2 * n + i];
    largest = std::max(largest, x * x + y * y + z * z);
  }
  return spread_ * std::sqrt(largest) + std::abs(at.s - near_.at.s) + near_.barMoved_m;
}

const std::vector<std::uint32_t>& ContactEnergy::near(const State& at) const {
  if (movedSince(at) < reach_m - barrier_.width_m) return near_.samples;
  gaps_.resize(surface_.size());
  parallelChunks(surface_.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) gaps_[p] = gapTo(*bar_, place(p, at), at.s);
  });
  near_.top = top_;
  near_.at = at;
  near_.barMoved_m = 0;
  near_.samples.clear();
  for (std::size_t p = 0; p < surface_.size(); ++p)
    if (gaps_[p].g_m < reach_m) near_.samples.push_back(static_cast<std::uint32_t>(p));
  return near_.samples;
}

bool ContactEnergy::evaluate(const State& at, std::optional<double> force_N, bool travels, Value& value) const {
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
  for (std::size_t i = 0; i < 3 * n; ++i)
    if (!(level.active[i] > 0)) value.gradient[i] = 0;
  value.gradient[3 * n] = 0;
  if (travels && force_N) {
    value.potential -= *force_N * at.s;
    value.gradient[3 * n] = value.barForce_N - *force_N;
  }
  return std::isfinite(value.potential);
}

void ContactEnergy::addBed(const State& at, Value& value) const {
  const SolidLevel& level = hierarchy_.level(top_);
  for (std::size_t b = 0; b < bed_.size(); ++b) {
    const CarriedPoint& point = level.points[surface_.size() + b];
    const double into = point.at(at.u.data(), level.nodes()).dot(bed_[b].outward);
    if (into <= 0) continue;
    value.potential += 0.5 * bed_[b].k_N_m * into * into;
    point.add<double>(bed_[b].k_N_m * into * bed_[b].outward, value.gradient.data(), level.nodes());
  }
}

template <class F>
void ContactEnergy::forTriangles(const State& at, const F& f) const {
  constexpr std::array<std::array<std::size_t, 3>, 4> triangles = {{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};
  const SolidLevel& level = hierarchy_.level(top_);
  for (std::size_t p = 0; p < pressures_.size(); ++p) {
    const std::size_t first = surface_.size() + bed_.size() + 4 * p;
    std::array<Eigen::Vector3d, 4> x;
    for (std::size_t c = 0; c < 4; ++c)
      x[c] = pressures_[p].corner_m[c] - middle_ + level.points[first + c].at(at.u.data(), level.nodes());
    const double share = pressureShare_ * pressures_[p].pressure_Pa / 12;
    for (const auto& t : triangles)
      f(std::array<std::size_t, 3>{first + t[0], first + t[1], first + t[2]},
        std::array<Eigen::Vector3d, 3>{x[t[0]], x[t[1]], x[t[2]]}, share);
  }
}

/// Pressure times the volume behind the faces; its gradient is pressure times deformed area.
void ContactEnergy::addPressures(const State& at, Value& value) const {
  const SolidLevel& level = hierarchy_.level(top_);
  forTriangles(at, [&](const auto& point, const auto& x, double share) {
    value.potential += share * x[0].dot(x[1].cross(x[2]));
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d g = share * x[(i + 1) % 3].cross(x[(i + 2) % 3]);
      level.points[point[i]].template add<double>(g, value.gradient.data(), level.nodes());
    }
    const double force = 6 * share * (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2;
    value.loads_N += force * force;
  });
}

std::vector<FollowerStiffness> ContactEnergy::followers(const State& at) const {
  std::vector<FollowerStiffness> out;
  forTriangles(at, [&](const auto& point, const auto& x, double share) {
    FollowerStiffness t;
    for (std::size_t i = 0; i < 3; ++i) {
      t.point[i] = static_cast<std::uint32_t>(point[i]);
      t.scaled[i] = (share * x[i]).template cast<float>();
    }
    out.push_back(t);
  });
  return out;
}

bool ContactEnergy::passes(const State& from, const State& to) const {
  if (!bar_) return true;
  const double shift = std::abs(to.s - from.s);
  // On a straight way nothing moves further from the state of near_ than at one of its ends.
  const std::vector<std::uint32_t>& close = near(to);
  const bool all = movedSince(from) >= reach_m;
  const std::size_t count = all ? surface_.size() : close.size();
  std::vector<char> bad((count + chunk - 1) / chunk, 0);
  parallelChunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t p = all ? i : close[i];
      const Eigen::Vector3d a = place(p, from), b = place(p, to);
      const double way = (b - a).norm() + shift;
      if (way < bar_->radius_m) continue;  // the ends of the step are judged by evaluate()
      if (gapTo(*bar_, a, from.s).g_m > way) continue;
      const int parts = static_cast<int>(std::ceil(2 * way / bar_->radius_m));
      for (int part = 1; part < parts; ++part) {
        const double t = static_cast<double>(part) / parts;
        if (!barrier_.feasible(gapTo(*bar_, a + t * (b - a), from.s + t * (to.s - from.s)).g_m)) bad[begin / chunk] = 1;
      }
    }
  });
  return std::none_of(bad.begin(), bad.end(), [](char c) { return c != 0; });
}

std::vector<PointStiffness> ContactEnergy::stiffness(const State& at) const {
  std::vector<PointStiffness> out;
  const SolidLevel& level = hierarchy_.level(top_);
  for (std::size_t b = 0; b < bed_.size(); ++b) {
    const std::size_t point = surface_.size() + b;
    // At rest the bed is there already: a body that only lies on it is held.
    if (level.points[point].at(at.u.data(), level.nodes()).dot(bed_[b].outward) < 0) continue;
    PointStiffness k;
    k.point = static_cast<std::uint32_t>(point);
    k.bar = false;
    k.positive = k.exact = (bed_[b].k_N_m * bed_[b].outward * bed_[b].outward.transpose()).cast<float>();
    out.push_back(k);
  }
  if (!bar_) return out;
  for (const std::uint32_t p : near(at)) {
    const Gap gap = gapTo(*bar_, place(p, at), at.s);
    if (!barrier_.acts(gap.g_m) || !barrier_.feasible(gap.g_m)) continue;
    const Barrier::Value phi = barrier_.at(gap.g_m);
    const Eigen::Matrix3d nn = gap.n * gap.n.transpose();
    const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity() - nn - gap.t * gap.t.transpose();
    PointStiffness k;
    k.point = p;
    k.positive = (surface_[p].area_m2 * phi.second * nn).cast<float>();
    k.exact = (surface_[p].area_m2 * (phi.second * nn + phi.first / gap.rho_m * turn)).cast<float>();
    out.push_back(k);
  }
  return out;
}

}  // namespace glisson::mechanics

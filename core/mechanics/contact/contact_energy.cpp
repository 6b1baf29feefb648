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
    : hierarchy_(hierarchy), surface_(std::move(surface)), law_(problem.law), bar_(problem.bar) {
  barrier_.width_m = options.zone_m;
  barrier_.kappa_Pa_m = std::max(softest_Pa_m, 1e3 * meanModulus(problem.problem.body)) * 1e-3 / options.zone_m;
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
      for (Eigen::Vector3d& p : bar_->centreline_m) p += s * bar_->hoist;
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

bool ContactEnergy::evaluate(const State& at, std::optional<double> force_N, bool travels, Value& value) const {
  const SolidLevel& level = hierarchy_.level(top_);
  const std::size_t n = level.nodes();
  value.gradient.resize(level.size());
  if (!level.forces(law_, at.u.data(), value.potential, value.gradient.data())) return false;
  value.barForce_N = value.contact_N = value.loads_N = 0;
  if (bar_) {
    gaps_.resize(surface_.size());
    parallelChunks(surface_.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) gaps_[p] = gapTo(*bar_, place(p, at), at.s);
    });
    for (std::size_t p = 0; p < surface_.size(); ++p) {
      if (!barrier_.acts(gaps_[p].g_m)) continue;
      if (!barrier_.feasible(gaps_[p].g_m)) return false;
      const Barrier::Value phi = barrier_.at(gaps_[p].g_m);
      const double w = surface_[p].area_m2;
      value.potential += w * phi.energy;
      level.points[p].add<double>(w * phi.first * gaps_[p].n, value.gradient.data(), n);
      value.barForce_N -= w * phi.first * gaps_[p].n.dot(bar_->hoist);
      value.contact_N -= w * phi.first;
    }
  }
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    value.potential -= loads_[i] * at.u[i];
    value.gradient[i] -= loads_[i];
    value.loads_N += level.active[i] > 0 ? loads_[i] * loads_[i] : 0;
  }
  value.loads_N = std::sqrt(value.loads_N);
  for (std::size_t i = 0; i < 3 * n; ++i)
    if (!(level.active[i] > 0)) value.gradient[i] = 0;
  value.gradient[3 * n] = 0;
  if (travels && force_N) {
    value.potential -= *force_N * at.s;
    value.gradient[3 * n] = value.barForce_N - *force_N;
  }
  return std::isfinite(value.potential);
}

bool ContactEnergy::passes(const State& from, const State& to) const {
  if (!bar_) return true;
  const double shift = std::abs(to.s - from.s);
  std::vector<char> bad((surface_.size() + chunk - 1) / chunk, 0);
  parallelChunks(surface_.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Eigen::Vector3d a = place(p, from), b = place(p, to);
      const double way = (b - a).norm() + shift;
      if (way < bar_->radius_m) continue;  // the ends of the step are judged by evaluate()
      if (gapTo(*bar_, a, from.s).g_m > way) continue;
      const int parts = static_cast<int>(std::ceil(2 * way / bar_->radius_m));
      for (int i = 1; i < parts; ++i) {
        const double t = static_cast<double>(i) / parts;
        if (!barrier_.feasible(gapTo(*bar_, a + t * (b - a), from.s + t * (to.s - from.s)).g_m)) bad[begin / chunk] = 1;
      }
    }
  });
  return std::none_of(bad.begin(), bad.end(), [](char c) { return c != 0; });
}

std::vector<PointStiffness> ContactEnergy::stiffness(const State& at) const {
  std::vector<PointStiffness> out;
  if (!bar_) return out;
  for (std::size_t p = 0; p < surface_.size(); ++p) {
    const Gap gap = gapTo(*bar_, place(p, at), at.s);
    if (!barrier_.acts(gap.g_m) || !barrier_.feasible(gap.g_m)) continue;
    const Barrier::Value phi = barrier_.at(gap.g_m);
    const Eigen::Matrix3d nn = gap.n * gap.n.transpose();
    const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity() - nn - gap.t * gap.t.transpose();
    PointStiffness k;
    k.point = static_cast<std::uint32_t>(p);
    k.positive = (surface_[p].area_m2 * phi.second * nn).cast<float>();
    k.exact = (surface_[p].area_m2 * (phi.second * nn + phi.first / gap.rho_m * turn)).cast<float>();
    out.push_back(k);
  }
  return out;
}

}  // namespace glisson::mechanics

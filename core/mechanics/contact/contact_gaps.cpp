// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/contact/contact_energy.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 1024;
constexpr double reach_m = 0.02;  ///< samples within this of the bar are looked at, until something has moved as far
/// Neighbours on the surface at rest are at most this many mean spacings of the samples apart.
constexpr double neighbourhood = 2.0;
/// Depth of the surface between two neighbouring samples, in radii of the bar, from where the bar has cut into it.
constexpr double cutOfRadius = 0.5;
constexpr double deepOfGuard = 0.9;  ///< where steps end that would go deeper

std::array<int, 3> cubeOf(const Eigen::Vector3d& p_m, double edge_m) {
  const Eigen::Vector3i c = (p_m / edge_m).array().floor().cast<int>();
  return {c.x(), c.y(), c.z()};
}

}  // namespace

void ContactEnergy::bringToForce(const State& at) {
  std::vector<Eigen::Vector3d> places;
  for (std::size_t p = 0; p < surface_.size(); ++p) places.push_back(place(p, at));
  bringToForce(places);
  near_ = {};
}

void ContactEnergy::bringToForce(const std::vector<Eigen::Vector3d>& places_m) {
  constexpr double far_m = 0.5;
  const auto nearest = [&](double s) {
    double g = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : places_m) g = std::min(g, gapTo(*bar_, p, s).g_m);
    return g - 0.5 * barrier_.width_m;
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

void ContactEnergy::sortIntoCubes() {
  double area = 0;
  for (const SurfaceSample& s : surface_) area += s.area_m2;
  const auto count = static_cast<double>(std::max<std::size_t>(1, surface_.size()));
  neighbourhood_m_ = neighbourhood * std::sqrt(area / count);
  cubes_.reserve(surface_.size());
  for (std::size_t p = 0; p < surface_.size(); ++p)
    cubes_.emplace_back(cubeOf(surface_[p].p_m, neighbourhood_m_), static_cast<std::uint32_t>(p));
  std::sort(cubes_.begin(), cubes_.end());
  neighbours_.assign(surface_.size(), {});
}

const std::vector<std::uint32_t>& ContactEnergy::neighboursOf(std::uint32_t sample) const {
  std::optional<std::vector<std::uint32_t>>& found = neighbours_[sample];
  if (found) return *found;
  found.emplace();
  const SurfaceSample& own = surface_[sample];
  const std::array<int, 3> at = cubeOf(own.p_m, neighbourhood_m_);
  for (int n = 0; n < 27; ++n) {
    const std::array<int, 3> cube = {at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
    auto entry = std::lower_bound(cubes_.begin(), cubes_.end(), std::pair(cube, std::uint32_t{0}));
    for (; entry != cubes_.end() && entry->first == cube; ++entry) {
      const SurfaceSample& other = surface_[entry->second];
      if (entry->second != sample && (other.p_m - own.p_m).norm() < neighbourhood_m_ &&
          other.normal.dot(own.normal) > 0)
        found->push_back(entry->second);
    }
  }
  return *found;
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

bool ContactEnergy::deep(const State& at) const {
  if (!bar_) return false;
  const std::vector<std::uint32_t>& samples = near(at);
  return std::any_of(samples.begin(), samples.end(), [&](std::uint32_t p) {
    return gapTo(*bar_, place(p, at), at.s).g_m < -deepOfGuard * barrier_.guard_m;
  });
}

bool ContactEnergy::cuts(const State& at) const {
  if (!bar_) return false;
  const double part_m = cutOfRadius * bar_->radius_m;
  const std::vector<std::uint32_t>& samples = near(at);
  for (const std::uint32_t p : samples) neighboursOf(p);
  std::vector<char> cut((samples.size() + chunk - 1) / chunk, 0);
  parallelChunks(samples.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d a = place(samples[i], at);
      for (const std::uint32_t other : *neighbours_[samples[i]]) {
        const Eigen::Vector3d way = place(other, at) - a;
        const int parts = static_cast<int>(std::ceil(way.norm() / part_m));
        for (int part = 1; part < parts; ++part)
          if (gapTo(*bar_, a + static_cast<double>(part) / parts * way, at.s).g_m < -part_m) cut[begin / chunk] = 1;
      }
    }
  });
  return std::any_of(cut.begin(), cut.end(), [](char c) { return c != 0; });
}

}  // namespace glisson::mechanics

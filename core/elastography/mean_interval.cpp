// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/mean_interval.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace glisson::elastography {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int lengths = 24;
constexpr double negligible = 3.0;  // correlation lengths; exp(-3) and less is left out beyond

/// The voxels that count, slice by slice.
struct Slice {
  int k = 0;
  double n = 0.0, sum = 0.0;
};

std::vector<Slice> slicesOf(const image::ScalarVolume& values, const image::Mask& counts) {
  std::vector<Slice> out;
  const std::size_t perSlice = values.grid.linear(0, 0, 1);
  for (int k = 0; k < values.grid.size.z(); ++k) {
    Slice s{k, 0.0, 0.0};
    for (std::size_t v = static_cast<std::size_t>(k) * perSlice; v < static_cast<std::size_t>(k + 1) * perSlice; ++v)
      if (counts.values[v] != 0) {
        s.n += 1.0;
        s.sum += static_cast<double>(values.values[v]);
      }
    if (s.n > 0.0) out.push_back(s);
  }
  return out;
}

/// Pairs of voxels at one in-plane shift.
struct Pairs {
  double distance_mm = 0.0, n = 0.0;
  double halfSquares = 0.0;  ///< Σ ½ (a − b)²
};

/// Stretches of voxels that count, along x; by slice and row.
struct Stretch {
  int first = 0, end = 0;  ///< indices along x
};

std::vector<std::vector<Stretch>> stretchesOf(const image::Mask& counts) {
  const Eigen::Vector3i n = counts.grid.size;
  std::vector<std::vector<Stretch>> rows(static_cast<std::size_t>(n.y()) * static_cast<std::size_t>(n.z()));
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (int i = 0; i < n.x(); ++i) {
      if (counts.values[row * static_cast<std::size_t>(n.x()) + static_cast<std::size_t>(i)] == 0) continue;
      if (rows[row].empty() || rows[row].back().end < i) rows[row].push_back({i, i});
      rows[row].back().end = i + 1;
    }
  return rows;
}

/// Every shift within reach_mm, one of the two signs.
std::vector<Pairs> pairsWithin(const image::ScalarVolume& values, const image::Mask& counts, double reach_mm) {
  const image::Grid& g = values.grid;
  const std::vector<std::vector<Stretch>> rows = stretchesOf(counts);
  const Eigen::Vector2i reach = (reach_mm / g.spacing_mm.head<2>().array()).floor().cast<int>();
  std::vector<Pairs> out;
  for (int dj = 0; dj <= std::min(reach.y(), g.size.y() - 1); ++dj)
    for (int di = -std::min(reach.x(), g.size.x() - 1); di <= std::min(reach.x(), g.size.x() - 1); ++di) {
      if (dj == 0 && di <= 0) continue;
      Pairs p;
      p.distance_mm = std::hypot(di * g.spacing_mm.x(), dj * g.spacing_mm.y());
      if (p.distance_mm > reach_mm) continue;
      for (int k = 0; k < g.size.z(); ++k)
        for (int j = 0; j + dj < g.size.y(); ++j) {
          const std::size_t row =
              static_cast<std::size_t>(k) * static_cast<std::size_t>(g.size.y()) + static_cast<std::size_t>(j);
          const float* a = values.values.data() + g.linear(0, j, k);
          const float* b = values.values.data() + g.linear(0, j + dj, k);
          for (const Stretch& here : rows[row])
            for (const Stretch& there : rows[row + static_cast<std::size_t>(dj)])
              for (int i = std::max(here.first, there.first - di); i < std::min(here.end, there.end - di); ++i) {
                const auto difference = static_cast<double>(a[i]) - static_cast<double>(b[i + di]);
                p.n += 1.0;
                p.halfSquares += 0.5 * difference * difference;
              }
        }
      if (p.n > 0.0) out.push_back(p);
    }
  return out;
}

struct Covariance {
  double nugget = 0.0, sill = 0.0, length_mm = 0.0, exponent = 2.0;
  double at(double distance_mm) const { return sill * std::exp(-std::pow(distance_mm / length_mm, exponent)); }
};

/// nugget + sill (1 − exp(−(d/ℓ)^p)) through the variogram by least squares, a shift counting as often as it has pairs.
Covariance fitted(const std::vector<Pairs>& pairs, double shortest_mm, double longest_mm) {
  Covariance best;
  double least = std::numeric_limits<double>::infinity();
  for (const double exponent : {1.0, 2.0})
    for (int l = 0; l < lengths; ++l) {
      Covariance c{0.0, 1.0, shortest_mm * std::pow(longest_mm / shortest_mm, l / (lengths - 1.0)), exponent};
      double n = 0, x = 0, xx = 0, y = 0, xy = 0, yy = 0;
      for (const Pairs& p : pairs) {
        const double rise = 1.0 - c.at(p.distance_mm), value = p.halfSquares / p.n;
        n += p.n, x += p.n * rise, xx += p.n * rise * rise, y += p.halfSquares;
        xy += p.halfSquares * rise, yy += p.halfSquares * value;
      }
      const double spread = n * xx - x * x;
      c.sill = spread > 0.0 ? std::max(0.0, (n * xy - x * y) / spread) : 0.0;
      c.nugget = (y - c.sill * x) / n;
      if (c.nugget < 0.0) {
        c.nugget = 0.0;
        c.sill = xx > 0.0 ? xy / xx : 0.0;
      }
      const double misfit = yy - 2.0 * (c.nugget * y + c.sill * xy) + c.nugget * c.nugget * n +
                            2.0 * c.nugget * c.sill * x + c.sill * c.sill * xx;
      if (misfit < least) {
        least = misfit;
        best = c;
      }
    }
  return best;
}

/// Pairs up to half the radius of the mean slice say how values vary: beyond it they are few and depend on one another.
MeanInterval::Correlation byCorrelation(const image::ScalarVolume& values, const image::Mask& counts,
                                        const std::vector<Slice>& slices) {
  MeanInterval::Correlation out;
  out.se_kPa = nan;
  double n = 0.0;
  for (const Slice& s : slices) n += s.n;
  const image::Grid& g = values.grid;
  const double pixel_mm = g.spacing_mm.head<2>().maxCoeff();
  const double radius_mm =
      std::sqrt(n / static_cast<double>(slices.size()) * g.spacing_mm.head<2>().prod() / std::numbers::pi);
  const double reach_mm = std::max(0.5 * radius_mm, 3.0 * pixel_mm);
  const std::vector<Pairs> pairs = pairsWithin(values, counts, reach_mm);
  if (n < 2.0 || pairs.empty()) return out;
  const Covariance c = fitted(pairs, 0.5 * pixel_mm, 2.0 * reach_mm);
  const double variance = c.nugget + c.sill;
  double covariance = n * variance;
  if (c.sill > 0.0)
    for (const Pairs& p : pairsWithin(values, counts, c.length_mm * std::pow(negligible, 1.0 / c.exponent)))
      covariance += 2.0 * p.n * c.at(p.distance_mm);
  out.length_mm = c.sill > 0.0 ? c.length_mm : 0.0;
  out.exponent = c.exponent;
  out.se_kPa = std::sqrt(covariance) / n;
  out.effective = covariance > 0.0 ? std::clamp(n * n * variance / covariance, 1.0, n) : n;
  return out;
}

}  // namespace

MeanInterval meanInterval(const image::ScalarVolume& values_kPa, const image::Mask& counts) {
  if (!counts.grid.sameGeometry(values_kPa.grid)) throw BadArgument("meanInterval: the mask lies on another grid");
  const std::vector<Slice> slices = slicesOf(values_kPa, counts);
  MeanInterval out;
  out.slices = slices.size();
  out.mean.value = out.mean.se = out.mean.low = out.mean.high = nan;
  out.bySlices = bootstrapSlices(slices.size(), [&](const std::vector<std::size_t>& drawn) {
    double n = 0.0, sum = 0.0;
    for (const std::size_t s : drawn) {
      n += slices[s].n;
      sum += slices[s].sum;
    }
    return sum / n;
  });
  out.correlation.se_kPa = nan;
  if (slices.empty()) return out;
  out.correlation = byCorrelation(values_kPa, counts, slices);
  out.mean.value = out.bySlices.value;
  const double within = out.correlation.se_kPa, between = out.bySlices.se;
  const bool slicesCount = std::isfinite(between) && !(within >= between);
  out.mean.se = slicesCount ? between : within;
  if (!std::isfinite(out.mean.se)) return out;
  const double freedom =
      slicesCount ? static_cast<double>(slices.size()) - 1.0 : std::max(1.0, out.correlation.effective - 1.0);
  const double half = quantileT(0.975, freedom) * out.mean.se;
  out.mean.low = out.mean.value - half;
  out.mean.high = out.mean.value + half;
  return out;
}

}  // namespace glisson::elastography

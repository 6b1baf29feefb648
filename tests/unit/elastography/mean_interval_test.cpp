// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/mean_interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "elastography/statistics.h"

namespace glisson::elastography {
namespace {

image::Grid grid(int nx, int ny, int nz) {
  image::Grid g;
  g.size = {nx, ny, nz};
  g.spacing_mm = {2.0, 2.0, 10.0};
  return g;
}

/// Normal, standard deviation sd, correlated by exp(-d^2/length^2) within slices: white noise under a Gaussian of
/// sigma = length/2.
image::ScalarVolume field(const image::Grid& g, double length_mm, double sd, Random& random) {
  image::ScalarVolume out(g);
  const double sigma = 0.5 * length_mm / g.spacing_mm.x();
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> weight;
  double squares = 0.0;
  for (int d = -reach; d <= reach; ++d) weight.push_back(sigma > 0.0 ? std::exp(-0.5 * d * d / (sigma * sigma)) : 1.0);
  for (const double w : weight) squares += w * w;
  for (double& w : weight) w /= std::sqrt(squares);
  const int wx = g.size.x() + 2 * reach, wy = g.size.y() + 2 * reach;
  std::vector<double> white(static_cast<std::size_t>(wx * wy)), rows(static_cast<std::size_t>(g.size.x() * wy));
  for (int k = 0; k < g.size.z(); ++k) {
    for (double& w : white) w = random.normal();
    for (int j = 0; j < wy; ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        double sum = 0.0;
        for (int d = 0; d <= 2 * reach; ++d)
          sum += weight[static_cast<std::size_t>(d)] * white[static_cast<std::size_t>(j * wx + i + d)];
        rows[static_cast<std::size_t>(j * g.size.x() + i)] = sum;
      }
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        double sum = 0.0;
        for (int d = 0; d <= 2 * reach; ++d)
          sum += weight[static_cast<std::size_t>(d)] * rows[static_cast<std::size_t>((j + d) * g.size.x() + i)];
        out.at(i, j, k) = static_cast<float>(sd * sum);
      }
  }
  return out;
}

image::Mask disc(const image::Grid& g, double radius_mm) {
  image::Mask m(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        m.at(i, j, k) = std::hypot((i - g.size.x() / 2) * 2.0, (j - g.size.y() / 2) * 2.0) < radius_mm ? 1 : 0;
  return m;
}

struct Coverage {
  double share = 0.0, voxels = 0.0, length_mm = 0.0;  ///< of the intervals, of mean +- 1.96 SD/sqrt(n), median
};

Coverage coverage(const image::Grid& g, double length_mm, double sliceSd, int maps, Random& random) {
  const image::Mask roi = disc(g, 30.0);
  Coverage c;
  std::vector<double> found;
  for (int m = 0; m < maps; ++m) {
    image::ScalarVolume map = field(g, length_mm, 0.3, random);
    std::vector<double> all;
    for (int k = 0; k < g.size.z(); ++k) {
      const auto shift = static_cast<float>(2.5 + sliceSd * random.normal());
      for (int j = 0; j < g.size.y(); ++j)
        for (int i = 0; i < g.size.x(); ++i) {
          map.at(i, j, k) += shift;
          if (roi.at(i, j, k) != 0) all.push_back(static_cast<double>(map.at(i, j, k)));
        }
    }
    const MeanInterval u = meanInterval(map, roi);
    const Statistics s = statisticsOf(all, 4.0);
    EXPECT_NEAR(u.mean.value, s.mean_kPa, 1e-6);
    c.share += u.mean.low <= 2.5 && 2.5 <= u.mean.high ? 1.0 / maps : 0.0;
    c.voxels += std::abs(s.mean_kPa - 2.5) <= 1.96 * s.sd_kPa / std::sqrt(static_cast<double>(s.n)) ? 1.0 / maps : 0.0;
    found.push_back(u.correlation.length_mm);
  }
  std::nth_element(found.begin(), found.begin() + maps / 2, found.end());
  c.length_mm = found[static_cast<std::size_t>(maps / 2)];
  std::printf(
      "correlated over %.0f mm, slices of their own %.2f kPa, %d slices: 95 %% intervals hold the mean in %.1f %%, "
      "SD/sqrt(n) in %.1f %%; length found %.1f mm\n",
      length_mm, sliceSd, g.size.z(), 100 * c.share, 100 * c.voxels, c.length_mm);
  return c;
}

// Random fields of known correlation length: 95 % intervals hold the true mean in 95 %. The share over 150 maps is
// itself known to 1.8 %; three of these below, and above as the larger one of two errors is taken.
TEST(MeanInterval, HoldsTheMeanOfCorrelatedFields) {
  Random random(11);
  for (const double length_mm : {0.0, 6.0, 12.0}) {
    const Coverage c = coverage(grid(34, 34, 4), length_mm, 0.0, 150, random);
    EXPECT_GE(c.share, 0.896);
    if (length_mm > 0.0) {
      EXPECT_NEAR(c.length_mm, length_mm, 0.3 * length_mm);
      EXPECT_LT(c.voxels, 0.8);  // what counting every voxel as independent would claim
    }
  }
}

TEST(MeanInterval, HoldsTheMeanOfOneSliceByItsCorrelation) {
  Random random(12);
  EXPECT_GE(coverage(grid(34, 34, 1), 6.0, 0.0, 150, random).share, 0.88);
}

// What all voxels of a slice share is not seen within slices, but from slice to slice.
TEST(MeanInterval, HoldsTheMeanWhereSlicesDiffer) {
  Random random(13);
  EXPECT_GE(coverage(grid(34, 34, 6), 6.0, 0.2, 150, random).share, 0.896);
}

TEST(MeanInterval, WhereNothingCanBeSaid) {
  const image::Grid g = grid(8, 8, 2);
  image::Mask one(g);
  const image::ScalarVolume map(g, 2.0F);
  EXPECT_TRUE(std::isnan(meanInterval(map, one).mean.value));
  one.at(3, 4, 1) = 1;
  EXPECT_TRUE(std::isnan(meanInterval(map, one).mean.se));
  EXPECT_EQ(meanInterval(map, disc(g, 30.0)).mean.se, 0.0);
  EXPECT_THROW(meanInterval(map, image::Mask(grid(8, 9, 2), 1)), BadArgument);
}

// Of a mean of normal figures, one for each slice: the interval of Student's t, which holds it in 95 %.
TEST(BootstrapSlices, HoldsTheMeanOfSlices) {
  for (const std::size_t n : {5u, 12u}) {
    Random random(14);
    constexpr int studies = 400;
    double share = 0.0;
    for (int s = 0; s < studies; ++s) {
      std::vector<double> figures(n);
      for (double& f : figures) f = 1.0 + 0.2 * random.normal();
      const Interval i = bootstrapSlices(n, [&](const std::vector<std::size_t>& drawn) {
        double sum = 0.0;
        for (const std::size_t d : drawn) sum += figures[d];
        return sum / static_cast<double>(n);
      });
      share += i.low <= 1.0 && 1.0 <= i.high ? 1.0 / studies : 0.0;
    }
    std::printf("bootstrap over %zu slices: %.1f %%\n", n, 100 * share);
    EXPECT_GE(share, 0.917);  // 95 % less three standard deviations of 400 studies
    EXPECT_LE(share, 0.983);
  }
  const auto nothing = [](const std::vector<std::size_t>&) { return 1.0; };
  EXPECT_TRUE(std::isnan(bootstrapSlices(1, nothing).se));
  EXPECT_TRUE(std::isnan(bootstrapSlices(0, nothing).value));
}

}  // namespace
}  // namespace glisson::elastography

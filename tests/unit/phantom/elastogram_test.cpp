// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shared_patient.h"

namespace glisson::phantom {
namespace {

struct Sums {
  double sum = 0.0;
  double squares = 0.0;
  std::size_t n = 0;
  void add(double v) {
    sum += v;
    squares += v * v;
    ++n;
  }
  double mean() const { return sum / static_cast<double>(n); }
  double sd() const { return std::sqrt(squares / static_cast<double>(n) - mean() * mean()); }
};

TEST(Elastogram, NoiseFreeMeanEqualsTheTruth) {
  const PhantomPatient& p = test::sharedPatient();
  Sums confident, whole;
  for (std::size_t v = 0; v < p.liverMre.values.size(); ++v) {
    if (!p.liverMre.values[v]) continue;
    whole.add(static_cast<double>(p.cleanShear_kPa.values[v]));
    if (p.confidence.values[v] >= 950) confident.add(static_cast<double>(p.cleanShear_kPa.values[v]));
  }
  EXPECT_EQ(confident.n, p.truth.confidentVoxels);
  EXPECT_EQ(whole.n, p.truth.liverVoxels);
  EXPECT_NEAR(confident.mean(), p.truth.shear_kPa, 1e-9);
  EXPECT_NEAR(whole.mean(), p.truth.wholeLiverShear_kPa, 1e-9);
}

TEST(Elastogram, TheMeanThatWasAskedForIsTheTruth) {
  PhantomOptions o;
  o.shear_kPa = 4.4;
  const PhantomPatient p = makePhantom(2, o);
  EXPECT_NEAR(p.truth.shear_kPa, 4.4, 1e-6);
}

TEST(Elastogram, MeasuredMapScattersAroundTheCleanOneByTheStatedNoise) {
  const PhantomPatient& p = test::sharedPatient();
  Sums error;
  for (std::size_t v = 0; v < p.liverMre.values.size(); ++v)
    if (p.liverMre.values[v] && p.confidence.values[v] >= 950)
      error.add(p.stiffness_Pa.values[v] / 1000.0 - static_cast<double>(p.cleanShear_kPa.values[v]));
  const double standardError = p.truth.noise_kPa / std::sqrt(static_cast<double>(error.n));
  EXPECT_LT(std::abs(error.mean()), 4.0 * standardError);
  EXPECT_NEAR(error.sd(), p.truth.noise_kPa, 0.03 * p.truth.noise_kPa);
}

TEST(Elastogram, TheConfidenceMaskMatters) {
  const PhantomPatient& p = test::sharedPatient();
  Sums masked, all, low;
  for (std::size_t v = 0; v < p.liverMre.values.size(); ++v) {
    EXPECT_GE(p.confidence.values[v], 0);
    EXPECT_LE(p.confidence.values[v], 999);
    // Nothing near the threshold: a reader may take 950 of 999 or 0.95 of full scale.
    EXPECT_FALSE(p.confidence.values[v] > 940 && p.confidence.values[v] < 955);
    if (!p.liverMre.values[v]) {
      EXPECT_LT(p.confidence.values[v], 950);
      continue;
    }
    all.add(p.stiffness_Pa.values[v] / 1000.0);
    (p.confidence.values[v] >= 950 ? masked : low).add(p.stiffness_Pa.values[v] / 1000.0);
  }
  EXPECT_GT(masked.n, all.n / 2);
  EXPECT_GT(low.n, all.n / 10);
  EXPECT_GT(std::abs(all.mean() - p.truth.shear_kPa), 0.04 * p.truth.shear_kPa);
  EXPECT_LT(std::abs(masked.mean() - p.truth.shear_kPa), 0.005 * p.truth.shear_kPa);
}

TEST(Elastogram, StiffnessVariesSmoothlyWithinItsBounds) {
  const PhantomPatient& p = test::sharedPatient();
  Sums spread;
  for (std::size_t v = 0; v + 1 < p.liverMre.values.size(); ++v)
    if (p.liverMre.values[v] && p.liverMre.values[v + 1]) {
      const double here = static_cast<double>(p.cleanShear_kPa.values[v]) / p.truth.shear_kPa;
      const double next = static_cast<double>(p.cleanShear_kPa.values[v + 1]) / p.truth.shear_kPa;
      EXPECT_LT(std::abs(next - here), 0.04);  // per 1.64 mm
      EXPECT_GT(here, 0.75);
      EXPECT_LT(here, 1.5);
      spread.add(here);
    }
  EXPECT_GT(spread.sd(), 0.02);
}

TEST(Elastogram, MreGridHoldsTheLiverAndSharesItsPlanesWithTheMri) {
  const PhantomPatient& p = test::sharedPatient();
  const image::Grid& mre = p.stiffness_Pa.grid;
  const image::Grid& mri = p.mri.grid;
  for (int k = 0; k < mre.size.z(); ++k) {
    const double plane = mri.lpsToIndex(mre.indexToLps({0, 0, static_cast<double>(k)})).z();
    EXPECT_NEAR(plane, std::round(plane), 1e-9);
  }
  const double low = mre.origin_lps_mm.z() - 0.5 * mre.spacing_mm.z();
  const double high = low + mre.spacing_mm.z() * mre.size.z();
  for (int k = 0; k < mri.size.z(); ++k)
    for (int j = 0; j < mri.size.y(); ++j)
      for (int i = 0; i < mri.size.x(); ++i) {
        if (!p.liver.at(i, j, k)) continue;
        const double z = mri.indexToLps({0, 0, static_cast<double>(k)}).z();
        ASSERT_GT(z, low);
        ASSERT_LT(z, high);
      }
}

TEST(Elastogram, WaveIsShorterInASofterLiver) {
  // Zero crossings along rows through the right lobe: their density is proportional to 1 / wavelength = f sqrt(rho /
  // mu).
  auto crossings = [](double shear_kPa) {
    PhantomOptions o;
    o.shear_kPa = shear_kPa;
    const PhantomPatient p = makePhantom(3, o);
    double count = 0.0;
    double voxels = 0.0;
    const std::vector<std::int16_t>& wave = p.wave.front().values;
    for (std::size_t v = 0; v + 256 < wave.size(); ++v)
      if (p.liverMre.values[v] && p.liverMre.values[v + 256] && p.confidence.values[v] >= 950) {
        voxels += 1.0;
        count += (wave[v] < 0) != (wave[v + 256] < 0) ? 1.0 : 0.0;
      }
    return count / voxels;
  };
  const double ratio = crossings(2.0) / crossings(6.0);
  EXPECT_GT(ratio, 1.25);  // sqrt(3) = 1.73 for a lone plane wave without noise
  EXPECT_LT(ratio, 2.1);
}

TEST(Elastogram, WaveStepsAreEqualPartsOfOnePeriod) {
  const PhantomPatient& p = test::sharedPatient();
  ASSERT_EQ(p.wave.size(), 4U);
  // Half a period apart a harmonic wave is its own opposite; a quarter apart it is neither that nor the same. Noise of
  // 0.05 rad in each step leaves 0.05 √2 of their sum.
  const double rad = std::numbers::pi / (PhantomPatient::waveWindowWidth / 2.0);
  const auto rms = [&](std::size_t s, std::size_t t, double sign) {
    double sum = 0.0, n = 0.0;
    for (std::size_t v = 0; v < p.liverMre.values.size(); ++v) {
      if (!p.liverMre.values[v]) continue;
      const double x = rad * p.wave[s].values[v], y = rad * p.wave[t].values[v];
      if (std::max(std::abs(x), std::abs(y)) > 3.0) continue;  // cut off
      sum += (x + sign * y) * (x + sign * y);
      n += 1.0;
    }
    return std::sqrt(sum / n);
  };
  EXPECT_NEAR(rms(0, 2, 1.0), 0.05 * std::sqrt(2.0), 0.002);
  EXPECT_NEAR(rms(1, 3, 1.0), 0.05 * std::sqrt(2.0), 0.002);
  EXPECT_GT(rms(0, 1, 1.0), 0.3);
  EXPECT_GT(rms(0, 1, -1.0), 0.3);
}

}  // namespace
}  // namespace glisson::phantom

// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/waves.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/morphology.h"
#include "inversion/detail/stencil.h"
#include "simulated.h"

namespace glisson::inversion {
namespace {

using namespace test;

double worstError(const Waves& w, const Field& wave) {
  double worst = 0.0;
  for (int k = 0; k < w.grid.size.z(); ++k)
    for (int j = 0; j < w.grid.size.y(); ++j)
      for (int i = 0; i < w.grid.size.x(); ++i)
        worst = std::max(worst, std::abs(Complex(w.directions.front().wave.at(i, j, k)) -
                                         wave(w.grid.indexToLps({double(i), double(j), double(k)}))));
  return worst;
}

TEST(FirstHarmonic, AmplitudeAndPhaseComeBackWhateverDoesNotMove) {
  Random random(1);
  const image::Grid g = lattice(30, 25, 3, 2, 2, 10);
  const Field wave = planeWave(g, std::polar(2.0, 0.2), 60, inPlane(0.4), 1.0);
  for (const int n : {3, 4, 5, 8}) {
    const Waves w = firstHarmonic({phases(g, wave, n, 0.0, random)});
    EXPECT_LT(worstError(w, wave), 2e-6) << n;
    EXPECT_EQ(w.directions.front().jumping, 0.0);
    EXPECT_EQ(w.directions.front().noise.size(), n < 4 ? 0u : n == 8 ? 2u : 1u);
    for (const ComplexVolume& noise : w.directions.front().noise)
      for (const auto& v : noise.values) ASSERT_LT(std::abs(v), 2e-6);
  }
}

TEST(FirstHarmonic, NoiseIsMeasured) {
  Random random(2);
  const image::Grid g = lattice(60, 60, 3, 2, 2, 10);
  for (const int n : {4, 8}) {
    const Waves w = firstHarmonic({phases(g, planeWave(g, 2.0, 60, inPlane(0.4)), n, 0.1, random)});
    EXPECT_NEAR(w.directions.front().noise_rad, 0.1, 0.003);
  }
}

// A step of the wave from one offset to the next is 2 A sin(π/N): beyond π it is wrapped.
TEST(FirstHarmonic, LargeAmplitudesAreUnwrappedInSpace) {
  Random random(3);
  const image::Grid g = lattice(50, 40, 2, 1.64, 1.64, 10);
  const Field wave = planeWave(g, 5.0, 60, inPlane(0.4), 5.0);  // steps up to 7.1 rad
  const std::vector<PhaseOffsets> p = {phases(g, wave, 4, 0.02, random)};
  WaveOptions o;
  o.mask = image::Mask(g, 1);
  const Waves automatic = firstHarmonic(p, o);
  EXPECT_TRUE(automatic.directions.front().spatiallyUnwrapped);
  EXPECT_GT(automatic.directions.front().jumping, 0.02);
  EXPECT_LT(worstError(automatic, wave), 0.15);
  ASSERT_EQ(automatic.warnings.size(), 1u);
  o.unwrapping = Unwrapping::Temporal;
  EXPECT_GT(worstError(firstHarmonic(p, o), wave), 2.0);
}

TEST(UnwrapSlices, ARampComesBackUpToWholeTurns) {
  const image::Grid g = lattice(40, 30, 2, 1, 1, 5);
  image::ScalarVolume phase(g);
  image::Mask mask(g, 1);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 30; ++j)
      for (int i = 0; i < 40; ++i) {
        phase.at(i, j, k) = static_cast<float>(std::remainder(0.9 * i - 0.5 * j, 2 * std::numbers::pi));
        if (i > 10 && i < 20 && j == 15) mask.at(i, j, k) = 0;
      }
  unwrapSlices(phase, mask);
  const double shift = static_cast<double>(phase.at(0, 0, 0));
  EXPECT_NEAR(std::remainder(shift, 2 * std::numbers::pi), 0.0, 1e-5);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 30; ++j)
      for (int i = 0; i < 40; ++i)
        if (mask.at(i, j, k) != 0) {
          ASSERT_NEAR(phase.at(i, j, k), 0.9 * i - 0.5 * j + shift, 1e-4);
        }
}

TEST(PhaseScale, IsToldFromTheLargestValue) {
  const image::Grid g = lattice(4, 4, 1, 1, 1, 1);
  const auto scale = [&](float low, float high) {
    image::ScalarVolume v(g);
    v.values[0] = low;
    v.values[1] = high;
    const PhaseScale s = phaseScale({v});
    toRadians(v, s);
    return std::pair(v.values[0], v.values[1]);
  };
  const auto pi = static_cast<float>(std::numbers::pi);
  EXPECT_NEAR(scale(-4096, 4094).first, -pi, 1e-5F);
  EXPECT_NEAR(scale(0, 4095).first, -pi, 1e-5F);
  EXPECT_NEAR(scale(-3141, 3141).second, pi, 1e-3F);
  EXPECT_NEAR(scale(-3.0F, 2.0F).second, 2.0F, 1e-6F);
  EXPECT_THROW(scale(-900, 900), BadInput);
  EXPECT_THROW(scale(0, 255), BadInput);
}

TEST(FirstHarmonic, RefusesWhatIsNoWave) {
  Random random(4);
  const image::Grid g = lattice(10, 10, 1, 2, 2, 10);
  std::vector<PhaseOffsets> p = {phases(g, planeWave(g, 2.0, 60, inPlane(0)), 4, 0, random)};
  EXPECT_THROW(firstHarmonic({}), BadInput);
  p.push_back(phases(g, planeWave(g, 2.0, 60, inPlane(0)), 5, 0, random));
  EXPECT_THROW(firstHarmonic(p), BadInput);
  p[1] = phases(lattice(10, 10, 1, 2, 2.5, 10), planeWave(g, 2.0, 60, inPlane(0)), 4, 0, random);
  EXPECT_THROW(firstHarmonic(p), BadInput);
  p.pop_back();
  p[0].offsets_rad[2].values[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(firstHarmonic(p), BadInput);
  p[0].offsets_rad.resize(2);
  EXPECT_THROW(firstHarmonic(p), BadInput);
}

// A quadratic polynomial is its own fit, on any spacing.
TEST(Stencil, IsExactForQuadraticFieldsAndUndoesItsOwnResponse) {
  for (const int dimensions : {2, 3}) {
    const Eigen::Vector3d spacing(1.2, 1.9, 2.3);
    const Stencil s(spacing, 6.0, dimensions);
    double value = 0.0, laplacian = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (const Stencil::Tap& t : s.taps()) {
      const Eigen::Vector3d x = spacing.cwiseProduct(t.offset.cast<double>());
      const double f = 3 - x.x() + 2 * x.y() + 0.5 * x.x() * x.x() - 0.7 * x.y() * x.y() + x.x() * x.y() +
                       (dimensions == 3 ? 0.3 * x.z() + 0.4 * x.z() * x.z() : 0.0);
      value += t.value * f;
      gradient += t.gradient * f;
      laplacian += t.laplacian * f;
    }
    EXPECT_NEAR(value, 3.0, 1e-12);
    EXPECT_NEAR(laplacian, dimensions == 3 ? 0.4 : -0.4, 1e-12);
    EXPECT_LT((gradient - Eigen::Vector3d(-1, 2, dimensions == 3 ? 0.3 : 0.0)).norm(), 1e-12);
    for (const double turn : {0.0, 0.3, -0.5}) {
      const Complex q = std::polar(0.6 * s.largestResolved_mm2(), turn);
      const auto back = s.squaredWavenumber(s.response(q));
      ASSERT_TRUE(back);
      EXPECT_LT(std::abs(*back - q), 1e-10 * std::abs(q));
    }
    EXPECT_FALSE(s.squaredWavenumber(-0.01));
    EXPECT_FALSE(s.squaredWavenumber(10.0));
  }
  EXPECT_THROW(Stencil({2, 2, 10}, 6.0, 3), BadInput);
}

TEST(Waves, ClippedPhasesAreFittedThroughWhatIsLeft) {
  Random random(23);
  const image::Grid g = lattice(40, 40, 1, 1.64, 1.64, 10);
  const Field wave = planeWave(g, std::polar(2.1, 0.1), 60, inPlane(0.3), 3.9);
  PhaseOffsets p = phases(
      g, [](const Eigen::Vector3d&) { return Complex(0.0); }, 8, 0.0, random);
  std::size_t clipped = 0;
  for (std::size_t v = 0; v < g.voxelCount(); ++v) {
    const Complex u = wave(g.indexToLps({double(v % 40), double(v / 40), 0.0}));
    for (int t = 0; t < 8; ++t) {
      const double phase = (u * std::polar(1.0, 2.0 * std::numbers::pi * t / 8)).real();
      clipped += std::abs(phase) > std::numbers::pi ? 1 : 0;
      p.offsets_rad[static_cast<std::size_t>(t)].values[v] =
          static_cast<float>(std::clamp(phase, -std::numbers::pi, std::numbers::pi));
    }
  }
  ASSERT_GT(clipped, 100u);
  WaveOptions o;
  o.mask = image::Mask(g, 1);
  const Waves w = firstHarmonic({p}, o);
  ASSERT_EQ(w.warnings.size(), 1u);
  EXPECT_EQ(image::count(w.mask), g.voxelCount());
  double worst = 0.0;
  for (std::size_t v = 0; v < g.voxelCount(); ++v)
    worst = std::max(worst, std::abs(Complex(w.directions.front().wave.values[v]) -
                                     wave(g.indexToLps({double(v % 40), double(v / 40), 0.0}))));
  EXPECT_LT(worst, 1e-4);
}

}  // namespace
}  // namespace glisson::inversion

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "image/morphology.h"
#include "simulated.h"

namespace glisson::inversion {
namespace {

using namespace test;

Inversion run(const std::vector<PhaseOffsets>& phases, const image::Mask& mask, BulkFilter filter = BulkFilter::Auto) {
  WaveOptions w;
  w.mask = mask;
  InversionOptions o;
  o.frequency_Hz = 60.0;
  o.dimensions = 2;
  o.filter = filter;
  return invert(firstHarmonic(phases, w), o);
}

/// Three waves that cross, and motion that is affine in the slice (a compression wave is metres long).
Field crossing(const image::Grid& g, Complex G) {
  const Field a = planeWave(g, G, 60, inPlane(0.3), 0.8), b = planeWave(g, G, 60, inPlane(1.9), 0.5),
              c = planeWave(g, G, 60, inPlane(4.0), 0.4);
  return [=](const Eigen::Vector3d& p) {
    const Eigen::Vector3d index_mm = g.direction.transpose() * (p - g.origin_lps_mm);
    return a(p) + b(p) + c(p) + Complex(0.6, -0.3) * (1.0 + 0.008 * index_mm.x() - 0.005 * index_mm.y());
  };
}

image::Mask disc(const image::Grid& g, double radius) {
  image::Mask m(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        m.at(i, j, k) = std::hypot(i - 0.5 * g.size.x(), j - 0.5 * g.size.y()) < radius ? 1 : 0;
  return m;
}

/// Σ over confident voxels of a map whose truth is known.
struct Calibration {
  double all = 0, confident = 0, within = 0, squares = 0, spreads = 0;
  void add(double value, double truth, double spread, double confidence) {
    all += 1;
    if (confidence < 0.95 || !std::isfinite(spread)) return;
    confident += 1;
    within += std::abs(value - truth) <= 1.96 * spread ? 1 : 0;
    squares += (value - truth) * (value - truth);
    spreads += spread * spread;
  }
  void print(const char* what) const {
    std::printf("%s: %.0f %% confident; of those %.1f %% within 1.96 spreads; error %.3f kPa, spread %.3f\n", what,
                100 * confident / all, 100 * within / confident, std::sqrt(squares / confident),
                std::sqrt(spreads / confident));
  }
};

// Affine motion is told from waves by the wave equation itself: the modulus is right in all
// but the outermost voxels of the mask.
TEST(Background, CrossingWavesOnAffineMotionGiveTheirModulusUpToTheBorder) {
  Random random(21);
  const image::Grid g = lattice(56, 56, 1, 1.64, 1.64, 10);
  const image::Mask mask = disc(g, 27.0);
  for (const double mu : {1.5, 2.1, 5.0, 8.0}) {
    const Complex G = std::polar(mu, 0.15);
    const std::vector<PhaseOffsets> p = {phases(g, crossing(g, G), 4, 0.0, random)};
    const Inversion r = run(p, mask), without = run(p, mask, BulkFilter::None);
    const Summary all = summarise(r.magnitude_kPa, r.confidence, 0.0, &mask);
    std::printf("crossing waves, %.1f kPa: %.4f +- %.4f over %zu of %zu voxels, loss %.4f of %.4f\n", mu, all.mean,
                all.sd, all.n, image::count(mask), summarise(r.loss_kPa, r.confidence, 0.0, &mask).mean, G.imag());
    EXPECT_EQ(r.used.filter, BulkFilter::HighPass);
    EXPECT_GT(static_cast<double>(all.n), 0.95 * static_cast<double>(image::count(mask)));
    EXPECT_NEAR(all.mean, mu, 0.03 * mu);
    EXPECT_GT(std::abs(summarise(without.magnitude_kPa, without.confidence, 0.0, &mask).mean - mu), 0.1 * mu);
  }
}

// Noise of the wave itself, smooth over neighbours as after interpolation, leaves no trace in other harmonics. Of the
// voxels at .95, 95 % lie within 1.96 spreads; and most voxels are.
TEST(Background, SpreadHoldsForNoiseThatNoHarmonicShows) {
  const image::Grid g = lattice(56, 56, 1, 1.64, 1.64, 10);
  const image::Mask mask = disc(g, 27.0);
  const Field wave = crossing(g, std::polar(2.1, 0.15));
  for (const int smooth : {0, 1}) {
    Random random(22);
    Calibration c;
    for (int map = 0; map < 4; ++map) {
      std::vector<Complex> white(g.voxelCount()), noise(g.voxelCount());
      for (Complex& w : white) w = 0.05 * Complex(random.normal(), random.normal());
      for (int j = 0; j < 56; ++j)
        for (int i = 0; i < 56; ++i) {
          Complex sum = 0.0;
          for (int b = -smooth; b <= smooth; ++b)
            for (int a = -smooth; a <= smooth; ++a) sum += white[g.linear((i + a + 56) % 56, (j + b + 56) % 56, 0)];
          noise[g.linear(i, j, 0)] = sum / (2.0 * smooth + 1.0);
        }
      const Field noisy = [&](const Eigen::Vector3d& p) {
        const Eigen::Vector3d index = (g.direction.transpose() * (p - g.origin_lps_mm)).cwiseQuotient(g.spacing_mm);
        return wave(p) +
               noise[g.linear(static_cast<int>(std::lround(index.x())), static_cast<int>(std::lround(index.y())), 0)];
      };
      const Inversion r = run({phases(g, noisy, 8, 0.0, random)}, mask);
      for (std::size_t v = 0; v < mask.values.size(); ++v)
        if (std::isfinite(r.magnitude_kPa.values[v]))
          c.add(r.magnitude_kPa.values[v], 2.1, r.spread_kPa.values[v], r.confidence.values[v]);
    }
    c.print(smooth == 0 ? "white noise" : "noise over 3 pixels");
    ASSERT_GT(c.confident, 0.6 * c.all);
    EXPECT_GE(c.within / c.confident, 0.95);
    EXPECT_LE(c.spreads, 4.0 * c.squares);
  }
}

/// (G u')' + ρω²u = 0 from x = 0 on, a wave that begins to go towards growing x; Runge and Kutta's method, 0.05 mm.
std::vector<Complex> throughLayers(const std::function<Complex(double)>& modulus_kPa, double length_mm) {
  constexpr double h = 0.05;
  const double inertia = 1000.0 * std::pow(2.0 * std::numbers::pi * 60.0, 2) * 1e-9;
  Complex u = 1.0, flux = Complex(0, -1) * std::sqrt(inertia / modulus_kPa(0.0)) * modulus_kPa(0.0);
  std::vector<Complex> out;
  for (double x = 0.0; x < length_mm; x += h) {
    out.push_back(u);
    const auto slope = [&](double at, Complex a, Complex b) { return std::pair(b / modulus_kPa(at), -inertia * a); };
    const auto [a1, b1] = slope(x, u, flux);
    const auto [a2, b2] = slope(x + h / 2, u + h / 2 * a1, flux + h / 2 * b1);
    const auto [a3, b3] = slope(x + h / 2, u + h / 2 * a2, flux + h / 2 * b2);
    const auto [a4, b4] = slope(x + h, u + h * a3, flux + h * b3);
    u += h / 6 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    flux += h / 6 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
  }
  return out;
}

// Stiffness that changes within a wavelength breaks the assumption of a locally homogeneous body. The error is seen,
// and the spread says so, without any noise.
TEST(Background, SpreadHoldsWhereStiffnessChangesWithinAWavelength) {
  Random random(23);
  const image::Grid g = lattice(72, 40, 1, 1.64, 1.64, 10);
  Calibration c;
  for (const double period_mm : {30.0, 50.0, 90.0})
    for (const double phase : {0.0, 1.6, 3.2, 4.8}) {
      const auto modulus = [=](double x) {
        return std::polar(2.5 * std::exp(0.3 * std::sin(2.0 * std::numbers::pi * x / period_mm + phase)), 0.15);
      };
      const std::vector<Complex> wave = throughLayers(modulus, 72 * 1.64);
      const Field field = [&](const Eigen::Vector3d& p) {
        return wave[static_cast<std::size_t>(
            std::lround((g.direction.transpose() * (p - g.origin_lps_mm)).x() / 0.05))];
      };
      const Inversion r = run({phases(g, field, 8, 0.01, random)}, image::Mask(g, 1));
      for (std::size_t v = 0; v < g.voxelCount(); ++v)
        if (std::isfinite(r.magnitude_kPa.values[v]))
          c.add(r.magnitude_kPa.values[v], std::abs(modulus(1.64 * static_cast<double>(v % 72))),
                r.spread_kPa.values[v], r.confidence.values[v]);
    }
  c.print("layers");
  ASSERT_GT(c.confident, 0.6 * c.all);
  EXPECT_GE(c.within / c.confident, 0.95);
  EXPECT_LE(c.spreads, 6.0 * c.squares);
}

}  // namespace
}  // namespace glisson::inversion

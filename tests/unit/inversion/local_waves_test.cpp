#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "image/morphology.h"
#include "simulated.h"

namespace glisson::inversion {
namespace {

using namespace test;

Inversion run(const std::vector<PhaseOffsets>& phases, const image::Mask& mask,
              BulkFilter filter = BulkFilter::Auto) {
  WaveOptions w;
  w.mask = mask;
  InversionOptions o;
  o.frequency_Hz = 60.0;
  o.dimensions = 2;
  o.method = Method::LocalWaves;
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

// The fit is right for such motion but for the orders left out, up to the border of the mask.
TEST(LocalWaves, CrossingWavesOnAffineMotionGiveTheirModulusUpToTheBorder) {
  Random random(21);
  const image::Grid g = lattice(40, 40, 1, 1.64, 1.64, 10);
  const image::Mask mask = disc(g, 19.0);
  for (const double mu : {1.5, 2.1, 5.0, 8.0}) {
    const Complex G = std::polar(mu, 0.15);
    const Inversion r = run({phases(g, crossing(g, G), 4, 0.0, random)}, mask);
    EXPECT_EQ(r.used.filter, BulkFilter::Local);
    EXPECT_EQ(r.confidenceMeans, ConfidenceMeaning::ProbabilityWithin);
    const Summary all = summarise(r.magnitude_kPa, r.confidence, 0.0, &mask);
    std::printf("crossing waves, %.1f kPa: %.4f +- %.4f over %zu of %zu voxels, loss %.4f of %.4f\n", mu, all.mean, all.sd,
                all.n, image::count(mask), summarise(r.loss_kPa, r.confidence, 0.0, &mask).mean, G.imag());
    EXPECT_GT(static_cast<double>(all.n), 0.98 * static_cast<double>(image::count(mask)));
    EXPECT_NEAR(all.mean, mu, 0.02 * mu);
    EXPECT_LT(all.sd, 0.03 * mu);
    EXPECT_NEAR(summarise(r.loss_kPa, r.confidence, 0.0, &mask).mean, G.imag(), 0.03 * mu);
  }
}

// Noise of the wave itself, smooth over neighbours as after interpolation, leaves no trace in other harmonics: only what
// the fit leaves over tells of it. Where the confidence is .95, 95 % lie within 19 % of the truth, and within
// 1.96 spreads; and most voxels are.
TEST(LocalWaves, ConfidenceAndSpreadHoldForNoiseThatNoHarmonicShows) {
  const image::Grid g = lattice(40, 40, 1, 1.64, 1.64, 10);
  const image::Mask mask = disc(g, 19.0);
  const Complex G = std::polar(2.1, 0.15);
  const Field wave = crossing(g, G);
  constexpr double noise_rad = 0.05;
  for (const int smooth : {0, 1}) {
    Random random(22);
    double confident = 0, near = 0, within = 0, all = 0, spread = 0, errors = 0;
    for (int map = 0; map < 4; ++map) {
      std::vector<Complex> white(g.voxelCount()), noise(g.voxelCount());
      for (Complex& w : white) w = noise_rad * Complex(random.normal(), random.normal());
      for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) {
          Complex sum = 0.0;
          for (int b = -smooth; b <= smooth; ++b)
            for (int a = -smooth; a <= smooth; ++a) sum += white[g.linear((i + a + 40) % 40, (j + b + 40) % 40, 0)];
          noise[g.linear(i, j, 0)] = sum / (2.0 * smooth + 1.0);
        }
      const Field noisy = [&](const Eigen::Vector3d& p) {
        const Eigen::Vector3d index = (g.direction.transpose() * (p - g.origin_lps_mm)).cwiseQuotient(g.spacing_mm);
        return wave(p) + noise[g.linear(static_cast<int>(std::lround(index.x())), static_cast<int>(std::lround(index.y())), 0)];
      };
      const Inversion r = run({phases(g, noisy, 8, 0.0, random)}, mask);
      for (std::size_t v = 0; v < mask.values.size(); ++v) {
        if (!std::isfinite(r.magnitude_kPa.values[v])) continue;
        const double value = static_cast<double>(r.magnitude_kPa.values[v]), off = std::abs(value - 2.1);
        all += 1, spread += static_cast<double>(r.spread_kPa.values[v]), errors += off * off;
        if (r.confidence.values[v] < 0.95F) continue;
        confident += 1;
        near += off <= 0.19 * 2.1 ? 1 : 0;
        within += off <= 1.96 * static_cast<double>(r.spread_kPa.values[v]) ? 1 : 0;
      }
    }
    std::printf("noise %.2f rad over %d pixels: error %.3f kPa, spread %.3f; confident %.0f %%, of those %.1f %% within 19 %%, "
                "%.1f %% within 1.96 spreads\n",
                noise_rad, 2 * smooth + 1, std::sqrt(errors / all), spread / all, 100 * confident / all,
                100 * near / confident, 100 * within / confident);
    ASSERT_GT(confident, (smooth == 0 ? 0.8 : 0.6) * all);
    EXPECT_GE(near / confident, 0.95);
    EXPECT_GE(within / confident, 0.95);
    EXPECT_GE(spread / all, 0.9 * std::sqrt(errors / all));
  }
}

TEST(LocalWaves, ClippedPhasesAreFittedThroughWhatIsLeft) {
  Random random(23);
  const image::Grid g = lattice(40, 40, 1, 1.64, 1.64, 10);
  const Field wave = planeWave(g, std::polar(2.1, 0.1), 60, inPlane(0.3), 3.9);
  PhaseOffsets p = phases(g, [](const Eigen::Vector3d&) { return Complex(0.0); }, 8, 0.0, random);
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

TEST(LocalWaves, AffineMotionIsFittedSliceBySliceOnly) {
  Random random(24);
  const image::Grid g = lattice(24, 24, 20, 2, 2, 2);
  InversionOptions o;
  o.frequency_Hz = 60.0;
  o.dimensions = 3;
  o.filter = BulkFilter::Local;
  const Waves waves = firstHarmonic({phases(g, planeWave(g, 2.1, 60, inPlane(0.3)), 4, 0.0, random)});
  EXPECT_THROW(invert(waves, o), BadInput);
  o.filter = BulkFilter::Auto;
  o.method = Method::LocalWaves;
  EXPECT_THROW(invert(waves, o), BadInput);
}

}  // namespace
}  // namespace glisson::inversion

// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/invert.h"

#include <gtest/gtest.h>

#include <cstring>

#include "base/error.h"
#include "base/parallel.h"
#include "image/morphology.h"
#include "simulated.h"

namespace glisson::inversion {
namespace {

using namespace test;

InversionOptions at(double frequency_Hz, BulkFilter filter = BulkFilter::None) {
  InversionOptions o;
  o.frequency_Hz = frequency_Hz;
  o.filter = filter;
  return o;
}

Inversion run(const std::vector<PhaseOffsets>& phases, const InversionOptions& options) {
  WaveOptions w;
  w.mask = image::Mask(phases.front().offsets_rad.front().grid, 1);
  return invert(firstHarmonic(phases, w), options);
}

// ρω²u + G∇²u = 0 holds for a plane wave of any direction, and the window's response is undone for it: G comes back.
TEST(Invert, PlaneWavesOfAnyDirectionGiveTheirModulus) {
  Random random(1);
  double worst = 0.0;
  for (const Eigen::Vector3d& spacing : {Eigen::Vector3d(1.64, 1.64, 10), Eigen::Vector3d(1.2, 1.9, 10)})
    for (const double mu : {1.0, 2.1, 5.0, 8.0})
      for (const double angle : {0.0, 0.5, 1.9}) {
        const image::Grid g = lattice(48, 44, 1, spacing.x(), spacing.y(), spacing.z());
        const Complex G = std::polar(mu, 0.3);
        const Inversion r = run({phases(g, planeWave(g, G, 60, inPlane(angle)), 4, 0.0, random)}, at(60));
        EXPECT_EQ(r.used.dimensions, 2);
        const Summary magnitude = summarise(r.magnitude_kPa, r.confidence, 0.5);
        const Summary storage = summarise(r.storage_kPa, r.confidence, 0.5),
                      loss = summarise(r.loss_kPa, r.confidence, 0.5);
        const Summary shear = summarise(r.shear_kPa, r.confidence, 0.5);
        EXPECT_EQ(magnitude.n, r.resolved);
        ASSERT_GT(magnitude.n, 400u);
        worst = std::max(worst, std::abs(magnitude.mean / mu - 1.0));
        EXPECT_NEAR(magnitude.mean, mu, 0.01 * mu);
        EXPECT_LT(magnitude.sd, 0.01 * mu);
        EXPECT_NEAR(storage.mean, G.real(), 0.01 * mu);
        EXPECT_NEAR(loss.mean, G.imag(), 0.01 * mu);
        // ρ c² = 2 |G|² / (G' + |G|)
        EXPECT_NEAR(shear.mean, 2 * mu * mu / (G.real() + mu), 0.01 * mu);
      }
  RecordProperty("worst_relative_error", std::to_string(worst));
}

struct NoiseCase {
  double noise_rad, mostBias;
};

// Without taking the noise harmonics off, stiffness falls with noise; the spread that is announced is the one seen.
TEST(Invert, NoiseNeitherPullsTheMeanNorSurprises) {
  for (const double mu : {2.1, 5.0})
    for (const NoiseCase c : {NoiseCase{0.02, 0.01}, NoiseCase{0.05, 0.01}, NoiseCase{0.1, 0.02}}) {
      Random random(7);
      const image::Grid g = lattice(60, 60, 2, 1.64, 1.64, 10);
      std::vector<PhaseOffsets> p;
      for (int d = 0; d < 3; ++d)
        p.push_back(phases(g, planeWave(g, std::polar(mu, 0.1), 60, inPlane(0.3 + 2.0 * d)), 8, c.noise_rad, random));
      const Inversion r = run(p, at(60));
      const Summary m = summarise(r.magnitude_kPa, r.confidence, 0.0), s = summarise(r.spread_kPa, r.confidence, 0.0);
      std::printf("mu %.1f kPa, noise %.2f rad: mean %.4f, SD %.4f, announced %.4f, confidence %.3f\n", mu, c.noise_rad,
                  m.mean, m.sd, s.mean, summarise(r.confidence, r.confidence, 1e-6).mean);
      EXPECT_NEAR(m.mean, mu, c.mostBias * mu);
      EXPECT_GT(s.mean, 0.6 * m.sd);
      EXPECT_LT(s.mean, 1.6 * m.sd);
    }
}

TEST(Invert, ConfidenceFallsWithNoiseAndNoiseAloneIsNotTrusted) {
  const image::Grid g = lattice(60, 60, 1, 1.64, 1.64, 10);
  double last = 1e300;
  for (const double noise : {0.0, 0.1, 0.3, 1.0}) {
    Random random(5);
    const Inversion r = run({phases(g, planeWave(g, 3.0, 60, inPlane(1.0)), 4, noise, random)}, at(60));
    double mean = 0.0;
    for (const float c : r.confidence.values) mean += static_cast<double>(c);
    EXPECT_LT(mean, last);
    last = mean;
  }
  Random random(6);
  const auto nothing = [](const Eigen::Vector3d&) { return Complex(0.0); };
  const Inversion r = run({phases(g, nothing, 4, 5.0, random)}, at(60));
  std::size_t trusted = 0;
  for (const float c : r.confidence.values) trusted += c >= 0.95F ? 1 : 0;
  EXPECT_LT(static_cast<double>(trusted), 0.02 * static_cast<double>(g.voxelCount()));
  EXPECT_THROW(invert(firstHarmonic({phases(g, nothing, 4, 5.0, random)}), at(60)), BadInput);
}

// Noise that is smooth over neighbours obeys a wave equation about as well as waves do; that it is there in other
// harmonics too tells it. Without those a warning says so.
TEST(Invert, SmoothNoiseIsToldByItsHarmonics) {
  Random random(11);
  const image::Grid g = lattice(72, 72, 1, 1.64, 1.64, 10);
  for (const int width : {3, 5}) {
    PhaseOffsets p;
    for (int t = 0; t < 8; ++t) {
      image::ScalarVolume white(g), smooth(g);
      for (float& w : white.values) w = static_cast<float>(random.normal());
      for (int j = 0; j < 72; ++j)
        for (int i = 0; i < 72; ++i)
          for (int b = 0; b < width; ++b)
            for (int a = 0; a < width; ++a)
              smooth.at(i, j, 0) += 0.3F / static_cast<float>(width) * white.at((i + a) % 72, (j + b) % 72, 0);
      p.offsets_rad.push_back(smooth);
    }
    const Inversion r = run({p}, at(60, BulkFilter::HighPass));
    double trusted = 0.0;
    for (const float c : r.confidence.values) trusted += c >= 0.95F ? 1.0 : 0.0;
    std::printf("noise over %d pixels: %.1f %% trusted\n", width, 100 * trusted / static_cast<double>(g.voxelCount()));
    EXPECT_LT(trusted, 0.05 * static_cast<double>(g.voxelCount()));
    const auto warned = [](const Inversion& i) {
      return std::any_of(i.warnings.begin(), i.warnings.end(),
                         [](const std::string& w) { return w.find("no noise beside the wave") != std::string::npos; });
    };
    EXPECT_FALSE(warned(r));
    EXPECT_TRUE(warned(run({phases(g, planeWave(g, 2.1, 60, inPlane(0.3)), 8, 0.0, random)}, at(60))));
  }
}

TEST(Invert, ObliqueWaveNeedsThreeDimensions) {
  Random random(2);
  const double tilt = 1.0;  // from the slice normal
  const Eigen::Vector3d along(std::sin(tilt), 0, std::cos(tilt));
  const image::Grid g = lattice(30, 28, 24, 2, 2, 2.4);
  InversionOptions o = at(60);
  o.averaging_mm = 2.0;
  const std::vector<PhaseOffsets> p = {phases(g, planeWave(g, 2.1, 60, along), 4, 0.0, random)};
  const Inversion space = run(p, o);
  EXPECT_EQ(space.used.dimensions, 3);
  ASSERT_GT(space.resolved, 500u);
  EXPECT_NEAR(summarise(space.magnitude_kPa, space.confidence, 0.5).mean, 2.1, 0.02);
  o.dimensions = 2;
  const Inversion plane = run(p, o);
  const double apparent = 2.1 / (std::sin(tilt) * std::sin(tilt));
  EXPECT_NEAR(summarise(plane.magnitude_kPa, plane.confidence, 0.5).mean, apparent, 0.02 * apparent);
  EXPECT_FALSE(plane.warnings.empty());
}

// exp(−ikr)/r solves the same equation in space, with an amplitude that changes from voxel to voxel.
TEST(Invert, SphericalWave) {
  Random random(3);
  const image::Grid g = lattice(30, 28, 22, 2, 2, 2);
  const Eigen::Vector3d source = g.indexToLps({-14, 13, 10});
  const Complex G = std::polar(2.5, 0.2), k = wavenumber(G, 60);
  const Field wave = [=](const Eigen::Vector3d& p) {
    const double r = (p - source).norm();
    return 30.0 * std::exp(Complex(0, -1) * k * r) / r;
  };
  InversionOptions o = at(60);
  o.dimensions = 3;
  const Inversion r = run({phases(g, wave, 6, 0.0, random)}, o);
  ASSERT_GT(r.resolved, 500u);
  EXPECT_NEAR(summarise(r.storage_kPa, r.confidence, 0.9).mean, G.real(), 0.03 * std::abs(G));
  EXPECT_NEAR(summarise(r.loss_kPa, r.confidence, 0.9).mean, G.imag(), 0.03 * std::abs(G));
}

// Compression (here: a motion that grows linearly along its own direction) has no curl; a shear wave has one.
TEST(Invert, CurlAndHighPassTakeCompressionAway) {
  Random random(4);
  const image::Grid g = lattice(64, 60, 1, 1.64, 1.64, 10);
  const Eigen::Vector3d along = inPlane(0.6), across(-along.y(), along.x(), 0);
  const Field shear = planeWave(g, std::polar(2.1, 0.1), 60, along);
  std::vector<PhaseOffsets> p;
  for (int d = 0; d < 3; ++d) {
    const Field motion = [&, d](const Eigen::Vector3d& x) {
      const Eigen::Vector3d index_mm = g.direction.transpose() * (x - g.origin_lps_mm);
      return shear(x) * across[d] + Complex(0.5, 0.3) * along[d] * (1.0 + 0.01 * index_mm.dot(along));
    };
    p.push_back(phases(g, motion, 8, 0.0, random, g.direction.col(d)));
  }
  const Inversion plain = run(p, at(60)), curled = run(p, at(60, BulkFilter::Curl)),
                  high = run(p, at(60, BulkFilter::HighPass));
  EXPECT_EQ(curled.waves.size(), 1u);
  const Summary c = summarise(curled.magnitude_kPa, curled.confidence, 0.5);
  ASSERT_GT(c.n, 800u);
  EXPECT_NEAR(c.mean, 2.1, 0.02);
  EXPECT_LT(c.sd, 0.05);
  const Summary h = summarise(high.magnitude_kPa, high.confidence, 0.95);
  EXPECT_NEAR(h.mean, 2.1, 0.15);
  EXPECT_GT(summarise(plain.magnitude_kPa, plain.confidence, 0.0).sd, 5 * c.sd);
  std::vector<PhaseOffsets> unknown = p;
  unknown[1].encoding_lps.setZero();
  EXPECT_THROW(run(unknown, at(60, BulkFilter::Curl)), BadInput);
  unknown.pop_back();
  EXPECT_THROW(run(unknown, at(60, BulkFilter::Curl)), BadInput);
}

TEST(Invert, SameBitsWithAnyNumberOfThreadsAndRefusals) {
  Random random(8);
  const image::Grid g = lattice(40, 40, 2, 1.64, 1.64, 10);
  const std::vector<PhaseOffsets> p = {phases(g, planeWave(g, 2.1, 60, inPlane(0.3)), 4, 0.1, random)};
  setThreadCount(1);
  const Inversion one = run(p, at(60, BulkFilter::HighPass));
  setThreadCount(3);
  const Inversion three = run(p, at(60, BulkFilter::HighPass));
  setThreadCount(0);
  EXPECT_EQ(0, std::memcmp(one.magnitude_kPa.values.data(), three.magnitude_kPa.values.data(), 4 * g.voxelCount()));
  EXPECT_EQ(0, std::memcmp(one.spread_kPa.values.data(), three.spread_kPa.values.data(), 4 * g.voxelCount()));
  EXPECT_THROW(run(p, at(0)), BadInput);
  InversionOptions o = at(60);
  o.density_kg_m3 = -1;
  EXPECT_THROW(run(p, o), BadInput);
  o = at(60);
  o.dimensions = 3;  // two slices of 10 mm
  EXPECT_THROW(run(p, o), BadInput);
  o = at(60);
  o.window_mm = 200;
  EXPECT_THROW(run(p, o), BadInput);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(invert(firstHarmonic(p), at(60), Progress({}, stop.get_token())), Cancelled);
}

TEST(Invert, ThreeOffsetsAreEnough) {
  Random random(9);
  const image::Grid g = lattice(48, 44, 1, 1.64, 1.64, 10);
  const Inversion r = run({phases(g, planeWave(g, 2.1, 60, inPlane(0.3)), 3, 0.0, random)}, at(60));
  EXPECT_NEAR(summarise(r.magnitude_kPa, r.confidence, 0.5).mean, 2.1, 0.02);
  EXPECT_LT(summarise(r.spread_kPa, r.confidence, 0.5).mean, 0.05);
}

}  // namespace
}  // namespace glisson::inversion

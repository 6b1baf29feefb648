// SPDX-License-Identifier: GPL-3.0-or-later
#include "phantom/detail/elastogram.h"

#include <numbers>

#include "base/parallel.h"
#include "base/quantity.h"

namespace glisson::phantom {
namespace {

constexpr double frequency_Hz = 60.0;
constexpr int adequate = 950;  // of 999

// Colours of the 0-8 kPa map: violet, blue, green, yellow, red.
std::array<std::uint8_t, 3> colourOf(double kPa) {
  static constexpr std::array<std::array<double, 3>, 6> stops{
      {{60, 0, 90}, {40, 60, 220}, {0, 190, 200}, {60, 200, 60}, {250, 220, 40}, {225, 30, 30}}};
  const double x = std::clamp(kPa / 8.0, 0.0, 1.0) * 5.0;
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(x), 4);
  const double t = x - static_cast<double>(i);
  std::array<std::uint8_t, 3> c{};
  for (std::size_t a = 0; a < 3; ++a)
    c[a] = static_cast<std::uint8_t>(std::lround((1.0 - t) * stops[i][a] + t * stops[i + 1][a]));
  return c;
}

struct Pattern {
  std::uint64_t seed = 0;
  bool stifferRegion = false;
  Point stifferCentre = Point::Zero();
  double stifferRadius_mm = 30.0;
  Point weakCentre = Point::Zero();  // the waves hardly reach it
  double weakRadius_mm = 30.0;

  // Relative deviation from the mean.
  double variation(const Point& p) const {
    const double smooth = 0.16 * noise(p, 62.0, seed + 1) + 0.05 * noise(p, 27.0, seed + 2);
    double v = std::clamp(smooth, -0.15, 0.15);
    if (stifferRegion) v += 0.28 * std::exp(-(p - stifferCentre).squaredNorm() / (stifferRadius_mm * stifferRadius_mm));
    return v;
  }
};

Pattern drawPattern(std::uint64_t seed) {
  Random random = derived(seed, 61);
  Pattern pattern;
  pattern.seed = seed + 700;
  pattern.stifferRegion = random.uniform() < 0.25;
  pattern.stifferCentre = {random.uniform(-110, -50), random.uniform(-40, 40), random.uniform(-40, 40)};
  pattern.stifferRadius_mm = random.uniform(22, 38);
  pattern.weakCentre = {random.uniform(-70, -40), random.uniform(30, 60), random.uniform(10, 50)};
  pattern.weakRadius_mm = random.uniform(18, 30);
  return pattern;
}

// Shear waves in one slice of the elastogram.
class SliceWaves {
 public:
  SliceWaves(const image::ScalarVolume& shear_kPa, int slice, double z_mm)
      : shear_kPa_(shear_kPa), slice_(slice), driver_(-118.0, -84.0, z_mm), reflector_(-150.0, 60.0, z_mm) {}

  struct Arrival {
    double amplitude = 0.0;
    double phase = 0.0;
  };
  Arrival fromDriver(const Point& p) const { return arrival(driver_, p); }
  Arrival fromReflector(const Point& p) const { return arrival(reflector_, p); }

 private:
  // Shear modulus seen by a wave on its way: liver as mapped, elsewhere soft tissue.
  double mu_kPa(const Point& p) const {
    const Eigen::Vector3d index = shear_kPa_.grid.lpsToIndex(p);
    const Eigen::Vector3i near(static_cast<int>(std::lround(index.x())), static_cast<int>(std::lround(index.y())),
                               slice_);
    if (!shear_kPa_.grid.contains(near)) return 3.0;
    const double mu = static_cast<double>(shear_kPa_.at(near));
    return mu > 0.0 ? mu : 3.0;
  }
  Arrival arrival(const Point& from, const Point& p) const {
    const double way_m = (p - from).norm() * 1e-3;
    double slowness = 0.0;
    constexpr int samples = 12;
    for (int s = 0; s < samples; ++s)
      slowness += std::sqrt(defaults::liverDensity.kgPerM3() / (1e3 * mu_kPa(from + (p - from) * (s + 0.5) / samples)));
    constexpr double omega = 2.0 * std::numbers::pi * frequency_Hz;
    return {std::exp(-way_m / 0.11) / std::sqrt(1.0 + way_m / 0.03), omega * way_m * slowness / samples};
  }

  const image::ScalarVolume& shear_kPa_;
  int slice_;
  Point driver_, reflector_;
};

// Fills a patient's elastogram: confidence and relative map first, then their mean, then what follows from both.
class Elastogram {
 public:
  Elastogram(const ElastogramInput& in, PhantomPatient& out);
  void fillConfidence();
  void fitMean();
  void fillMaps();

 private:
  Point position(std::size_t v) const {
    const auto width = static_cast<std::size_t>(grid_.size.x()), height = static_cast<std::size_t>(grid_.size.y());
    const auto i = static_cast<double>(v % width);
    const auto j = static_cast<double>((v / width) % height);
    return grid_.indexToLps({i, j, static_cast<double>(v / slice_)});
  }
  bool confident(std::size_t v) const { return out_.liverMre.values[v] && out_.confidence.values[v] >= adequate; }
  // In [0, 1], of which one half is the line between confident and not; gives the voxel its relative modulus.
  double score(std::size_t v, const Point& p);
  double noisyShear_kPa(std::size_t v, const Point& p, double noiseUnit) const;

  const ElastogramInput& in_;
  PhantomPatient& out_;
  const image::Grid& grid_;
  std::size_t slice_;  // voxels of one
  Pattern pattern_;
};

Elastogram::Elastogram(const ElastogramInput& in, PhantomPatient& out)
    : in_(in),
      out_(out),
      grid_(in.grid),
      slice_(static_cast<std::size_t>(in.grid.size.x()) * static_cast<std::size_t>(in.grid.size.y())),
      pattern_(drawPattern(in.seed)) {
  out.truth.noise_kPa = 0.06 * in.shear_kPa;
  out.liverMre = image::Mask(grid_);
  out.cleanShear_kPa = image::ScalarVolume(grid_);
  out.stiffness_Pa = Int16Volume(grid_);
  out.confidence = Int16Volume(grid_);
  out.wave.assign(PhantomPatient::waveSteps, Int16Volume(grid_));
  out.colour = RgbVolume(grid_);
}

double Elastogram::score(std::size_t v, const Point& p) {
  const double liver = (*in_.liver_mm)[v];
  if (!(liver < 0.0)) {
    const double outside = 0.28 + 0.30 * noise(p, 30.0, pattern_.seed + 3);
    return std::clamp(outside * (0.95 * smoothStep(0.0, 14.0, liver)), 0.0, 0.49);
  }
  out_.liverMre.values[v] = 1;
  out_.cleanShear_kPa.values[v] = static_cast<float>(1.0 + pattern_.variation(p));
  const double wobble = 1.5 * noise(p, 18.0, pattern_.seed + 4);
  double score = smoothStep(1.5, 6.0, -liver + wobble);
  score *= smoothStep(-1.0, 3.0, (*in_.vessel_mm)[v]);
  const double weak = (p - pattern_.weakCentre).norm() + 8.0 * noise(p, 22.0, pattern_.seed + 5);
  return score * smoothStep(0.6 * pattern_.weakRadius_mm, 1.1 * pattern_.weakRadius_mm, weak);
}

void Elastogram::fillConfidence() {
  parallelChunks(grid_.voxelCount(), slice_, [&](std::size_t begin, std::size_t end) {
    Random r = derived(in_.seed, 62 + begin / slice_);
    for (std::size_t v = begin; v < end; ++v) {
      if ((*in_.body_mm)[v] > 0.0F) continue;
      const double s = score(v, position(v));
      const double confidence = s >= 0.5 ? 962.0 + 36.0 * smoothStep(0.5, 0.9, s) + r.uniform(-2.0, 1.0)
                                         : 925.0 * std::pow(s / 0.5, 0.7) + r.uniform(-12.0, 12.0);
      out_.confidence.values[v] = static_cast<std::int16_t>(std::clamp(std::lround(confidence), 0L, 999L));
    }
  });
}

// The mean over the confident liver is made exactly what was asked for.
void Elastogram::fitMean() {
  PhantomTruth& truth = out_.truth;
  double sum = 0.0;
  for (std::size_t v = 0; v < grid_.voxelCount(); ++v)
    if (confident(v)) {
      sum += static_cast<double>(out_.cleanShear_kPa.values[v]);
      ++truth.confidentVoxels;
    }
  const double scale =
      truth.confidentVoxels > 0 ? in_.shear_kPa * static_cast<double>(truth.confidentVoxels) / sum : in_.shear_kPa;
  double confidentSum = 0.0;
  double whole = 0.0;
  for (std::size_t v = 0; v < grid_.voxelCount(); ++v)
    if (out_.liverMre.values[v]) {
      float& mu = out_.cleanShear_kPa.values[v];
      mu = static_cast<float>(static_cast<double>(mu) * scale);
      whole += static_cast<double>(mu);
      if (confident(v)) confidentSum += static_cast<double>(mu);
      ++truth.liverVoxels;
    }
  if (truth.confidentVoxels > 0) truth.shear_kPa = confidentSum / static_cast<double>(truth.confidentVoxels);
  if (truth.liverVoxels > 0) truth.wholeLiverShear_kPa = whole / static_cast<double>(truth.liverVoxels);
}

double Elastogram::noisyShear_kPa(std::size_t v, const Point& p, double noiseUnit) const {
  const double junk = noise(p, 11.0, pattern_.seed + 7);
  const double clean_kPa = static_cast<double>(out_.cleanShear_kPa.values[v]);
  if (confident(v)) return clean_kPa + out_.truth.noise_kPa * noiseUnit;
  if (out_.liverMre.values[v]) {
    // Near edges and veins an inversion reads low; where there is no wave it reads anything.
    const double doubt = 1.0 - out_.confidence.values[v] / 999.0;
    return clean_kPa * (0.62 - 0.35 * doubt + 0.5 * std::max(junk, 0.0)) + 2.0 * out_.truth.noise_kPa * noiseUnit;
  }
  return 1.6 + 2.4 * std::abs(noise(p, 26.0, pattern_.seed + 8)) * 2.0 + 2.0 * junk + 0.25 * noiseUnit;
}

void Elastogram::fillMaps() {
  const double gain = PhantomPatient::waveWindowWidth / 2.0 / std::numbers::pi;
  parallelChunks(grid_.voxelCount(), slice_, [&](std::size_t begin, std::size_t end) {
    Random r = derived(in_.seed, 200 + begin / slice_);
    Random ofLaterSteps = derived(in_.seed, 400 + begin / slice_);
    const double z = position(begin).z();
    const SliceWaves waves(out_.cleanShear_kPa, static_cast<int>(begin / slice_), z);
    const double startPhase = 0.03 * z;
    for (std::size_t v = begin; v < end; ++v) {
      if ((*in_.body_mm)[v] > 0.0F) continue;
      const Point p = position(v);
      const double noiseUnit = r.normal();
      const auto [a1, phase1] = waves.fromDriver(p);
      const auto [a2, phase2] = waves.fromReflector(p);
      for (std::size_t t = 0; t < out_.wave.size(); ++t) {
        // The wave runs away from where it arises: later is further back along its way.
        const double now = startPhase + 2.0 * std::numbers::pi * static_cast<double>(t) / PhantomPatient::waveSteps;
        const double u_rad = 2.6 * a1 * std::cos(phase1 - now) + 0.7 * a2 * std::cos(phase2 - now + 1.0) +
                             0.05 * (t == 0 ? r : ofLaterSteps).normal();
        out_.wave[t].values[v] = static_cast<std::int16_t>(std::lround(std::clamp(u_rad, -3.1, 3.1) * gain));
      }
      const long pascal = std::clamp(std::lround(1000.0 * noisyShear_kPa(v, p, noiseUnit)), 0L, 20000L);
      out_.stiffness_Pa.values[v] = static_cast<std::int16_t>(pascal);
      out_.colour.values[v] = colourOf(static_cast<double>(pascal) / 1000.0);
    }
  });
}

}  // namespace

void fillElastogram(const ElastogramInput& in, PhantomPatient& out) {
  Elastogram elastogram(in, out);
  elastogram.fillConfidence();
  elastogram.fitMean();
  elastogram.fillMaps();
}

}  // namespace glisson::phantom

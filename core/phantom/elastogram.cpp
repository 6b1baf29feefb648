#include "phantom/elastogram.h"

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

}  // namespace

void fillElastogram(const ElastogramInput& in, PhantomPatient& out) {
  const image::Grid& grid = in.grid;
  const std::size_t n = grid.voxelCount();
  const auto slice = static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y());
  Random random = derived(in.seed, 61);
  Pattern pattern;
  pattern.seed = in.seed + 700;
  pattern.stifferRegion = random.uniform() < 0.25;
  pattern.stifferCentre = {random.uniform(-110, -50), random.uniform(-40, 40), random.uniform(-40, 40)};
  pattern.stifferRadius_mm = random.uniform(22, 38);
  pattern.weakCentre = {random.uniform(-70, -40), random.uniform(30, 60), random.uniform(10, 50)};
  pattern.weakRadius_mm = random.uniform(18, 30);
  out.truth.noise_kPa = 0.06 * in.shear_kPa;

  out.liverMre = image::Mask(grid);
  out.cleanShear_kPa = image::ScalarVolume(grid);
  out.stiffness_Pa = Int16Volume(grid);
  out.confidence = Int16Volume(grid);
  out.wave.assign(PhantomPatient::waveSteps, Int16Volume(grid));
  out.colour = RgbVolume(grid);

  auto position = [&](std::size_t v) {
    const auto i = static_cast<double>(v % static_cast<std::size_t>(grid.size.x()));
    const auto j =
        static_cast<double>((v / static_cast<std::size_t>(grid.size.x())) % static_cast<std::size_t>(grid.size.y()));
    return grid.indexToLps({i, j, static_cast<double>(v / slice)});
  };

  // Confidence and the relative map.
  parallelChunks(n, slice, [&](std::size_t begin, std::size_t end) {
    Random r = derived(in.seed, 62 + begin / slice);
    for (std::size_t v = begin; v < end; ++v) {
      if ((*in.body_mm)[v] > 0.0F) continue;
      const Point p = position(v);
      const double liver = (*in.liver_mm)[v];
      double score = 0.28 + 0.30 * noise(p, 30.0, pattern.seed + 3);
      if (liver < 0.0) {
        out.liverMre.values[v] = 1;
        out.cleanShear_kPa.values[v] = static_cast<float>(1.0 + pattern.variation(p));
        const double wobble = 1.5 * noise(p, 18.0, pattern.seed + 4);
        score = smoothStep(1.5, 6.0, -liver + wobble);
        score *= smoothStep(-1.0, 3.0, (*in.vessel_mm)[v]);
        const double weak = (p - pattern.weakCentre).norm() + 8.0 * noise(p, 22.0, pattern.seed + 5);
        score *= smoothStep(0.6 * pattern.weakRadius_mm, 1.1 * pattern.weakRadius_mm, weak);
      } else {
        score *= 0.95 * smoothStep(0.0, 14.0, liver);
        score = std::clamp(score, 0.0, 0.49);
      }
      const double confidence = score >= 0.5 ? 962.0 + 36.0 * smoothStep(0.5, 0.9, score) + r.uniform(-2.0, 1.0)
                                             : 925.0 * std::pow(score / 0.5, 0.7) + r.uniform(-12.0, 12.0);
      out.confidence.values[v] = static_cast<std::int16_t>(std::clamp(std::lround(confidence), 0L, 999L));
    }
  });

  // The mean over the confident liver is made exactly what was asked for, then everything else follows.
  double sum = 0.0;
  for (std::size_t v = 0; v < n; ++v)
    if (out.liverMre.values[v] && out.confidence.values[v] >= adequate) {
      sum += static_cast<double>(out.cleanShear_kPa.values[v]);
      ++out.truth.confidentVoxels;
    }
  const double scale = out.truth.confidentVoxels > 0
                           ? in.shear_kPa * static_cast<double>(out.truth.confidentVoxels) / sum
                           : in.shear_kPa;
  double confident = 0.0;
  double whole = 0.0;
  for (std::size_t v = 0; v < n; ++v)
    if (out.liverMre.values[v]) {
      float& mu = out.cleanShear_kPa.values[v];
      mu = static_cast<float>(static_cast<double>(mu) * scale);
      whole += static_cast<double>(mu);
      if (out.confidence.values[v] >= adequate) confident += static_cast<double>(mu);
      ++out.truth.liverVoxels;
    }
  if (out.truth.confidentVoxels > 0) out.truth.shear_kPa = confident / static_cast<double>(out.truth.confidentVoxels);
  if (out.truth.liverVoxels > 0) out.truth.wholeLiverShear_kPa = whole / static_cast<double>(out.truth.liverVoxels);

  const Point driver(-118.0, -84.0, 0.0);
  const Point reflector(-150.0, 60.0, 0.0);
  const double omega = 2.0 * std::numbers::pi * frequency_Hz;
  const double gain = PhantomPatient::waveWindowWidth / 2.0 / std::numbers::pi;
  parallelChunks(n, slice, [&](std::size_t begin, std::size_t end) {
    Random r = derived(in.seed, 200 + begin / slice);
    Random ofLaterSteps = derived(in.seed, 400 + begin / slice);
    const double z = position(begin).z();
    // Shear modulus seen by a wave on its way: liver as mapped, elsewhere soft tissue.
    auto mu_kPa = [&](const Point& p) {
      const Eigen::Vector3d index = grid.lpsToIndex(p);
      const Eigen::Vector3i near(static_cast<int>(std::lround(index.x())), static_cast<int>(std::lround(index.y())),
                                 static_cast<int>(begin / slice));
      if (!grid.contains(near)) return 3.0;
      const double mu = static_cast<double>(out.cleanShear_kPa.at(near));
      return mu > 0.0 ? mu : 3.0;
    };
    auto arrival = [&](const Point& from, const Point& p) {  // displacement amplitude and phase of one wave
      const double way_m = (p - from).norm() * 1e-3;
      double slowness = 0.0;
      constexpr int samples = 12;
      for (int s = 0; s < samples; ++s)
        slowness +=
            std::sqrt(defaults::liverDensity.kgPerM3() / (1e3 * mu_kPa(from + (p - from) * (s + 0.5) / samples)));
      return std::pair{std::exp(-way_m / 0.11) / std::sqrt(1.0 + way_m / 0.03), omega * way_m * slowness / samples};
    };
    const double startPhase = 0.03 * z;
    for (std::size_t v = begin; v < end; ++v) {
      if ((*in.body_mm)[v] > 0.0F) continue;
      const Point p = position(v);
      const double noiseUnit = r.normal();
      const auto [a1, phase1] = arrival(Point(driver.x(), driver.y(), z), p);
      const auto [a2, phase2] = arrival(Point(reflector.x(), reflector.y(), z), p);
      for (std::size_t t = 0; t < out.wave.size(); ++t) {
        // The wave runs away from where it arises: later is further back along its way.
        const double now = startPhase + 2.0 * std::numbers::pi * static_cast<double>(t) / PhantomPatient::waveSteps;
        const double u_rad = 2.6 * a1 * std::cos(phase1 - now) + 0.7 * a2 * std::cos(phase2 - now + 1.0) +
                             0.05 * (t == 0 ? r : ofLaterSteps).normal();
        out.wave[t].values[v] = static_cast<std::int16_t>(std::lround(std::clamp(u_rad, -3.1, 3.1) * gain));
      }

      double kPa = 0.0;
      const double junk = noise(p, 11.0, pattern.seed + 7);
      if (out.liverMre.values[v] && out.confidence.values[v] >= adequate) {
        kPa = static_cast<double>(out.cleanShear_kPa.values[v]) + out.truth.noise_kPa * noiseUnit;
      } else if (out.liverMre.values[v]) {
        // Near edges and veins an inversion reads low; where there is no wave it reads anything.
        const double doubt = 1.0 - out.confidence.values[v] / 999.0;
        kPa = static_cast<double>(out.cleanShear_kPa.values[v]) * (0.62 - 0.35 * doubt + 0.5 * std::max(junk, 0.0)) +
              2.0 * out.truth.noise_kPa * noiseUnit;
      } else {
        kPa = 1.6 + 2.4 * std::abs(noise(p, 26.0, pattern.seed + 8)) * 2.0 + 2.0 * junk + 0.25 * noiseUnit;
      }
      const long pascal = std::clamp(std::lround(1000.0 * kPa), 0L, 20000L);
      out.stiffness_Pa.values[v] = static_cast<std::int16_t>(pascal);
      out.colour.values[v] = colourOf(static_cast<double>(pascal) / 1000.0);
    }
  });
}

}  // namespace glisson::phantom

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "image/io.h"
#include "inversion/invert.h"
#include "support/support.h"

namespace glisson::inversion {
namespace {

// Waves of another group, fetched by hand (README of core/inversion); the half that is for development only.
using Complex = std::complex<double>;
constexpr const char* folder = "dime";

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

image::Grid slice(double pixel_mm) {
  image::Grid g;
  g.size = {256, 256, 1};
  g.spacing_mm = {pixel_mm, pixel_mm, 10.0};
  return g;
}

Inversion inverted(const std::vector<image::ScalarVolume>& offsets_rad, const image::Mask& mask) {
  PhaseOffsets p;
  p.offsets_rad = offsets_rad;
  WaveOptions w;
  w.mask = mask;
  InversionOptions o;
  o.frequency_Hz = 60.0;
  o.dimensions = 2;
  return invert(firstHarmonic({p}, w), o);
}

/// The last values of an uncompressed file, MATLAB's or NIfTI's, column by column. (Their images have no place in a
/// patient, so that image/io refuses those of two dimensions.)
template <typename Stored>
std::vector<double> lastValues(const std::filesystem::path& file, std::size_t n) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  std::vector<Stored> values(n);
  if (bytes.size() < sizeof(Stored) * n) throw BadInput("'" + file.filename().string() + "' is too short");
  std::memcpy(values.data(), bytes.data() + bytes.size() - sizeof(Stored) * n, sizeof(Stored) * n);
  return {values.begin(), values.end()};
}

/// Where a map has voxels that count, against a map to compare with.
struct Comparison {
  std::vector<double> ours, ratios;
  double within = 0.0;  // 1.96 spreads
  void add(double value, double spread, double there) {
    ours.push_back(value);
    ratios.push_back(value / there);
    within += std::abs(value - there) <= 1.96 * spread ? 1.0 : 0.0;
  }
  double share() const { return within / static_cast<double>(ours.size()); }
};

struct Liver {
  std::vector<image::ScalarVolume> offsets_rad;
  image::Mask mask;
  std::vector<double> scanner_kPa;  // in the order of the mask; 0 where the scanner has none
};

Liver liver(int n) {
  const auto data = test::sharedData() / folder / "Study3-Sample Data";
  const image::ScalarVolume stored = image::readVolume(data / "Processed Data" / (std::to_string(n) + ".nii"));
  const image::Grid g = slice(1.40625);
  Liver out{{}, image::Mask(g), std::vector<double>(g.voxelCount())};
  for (std::size_t t = 0; t < 8; ++t) {
    out.offsets_rad.emplace_back(g);
    for (std::size_t v = 0; v < g.voxelCount(); ++v) {
      const auto value = static_cast<double>(stored.values.at(t * g.voxelCount() + v));
      if (value != 0.0) out.mask.values[v] = 1;
      out.offsets_rad.back().values[v] = static_cast<float>(value * 2.0 * std::numbers::pi / 4096.0);
    }
  }
  const std::vector<double> map =
      lastValues<std::int16_t>(data / "Processed Stiffness" / (std::to_string(n) + ".mat"), g.voxelCount());
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i)  // rows of the map are columns of the phase images
      out.scanner_kPa[g.linear(i, j, 0)] = map[static_cast<std::size_t>(i * 256 + j)] / 100.0;
  return out;
}

// Five livers in vivo at 60 Hz, 1.40625 mm, against the map that the scanner's own multi-model inversion made of them.
// The fewer voxels are confident, the less they are a fair sample of the organ, so that voxel is compared with voxel
// too.
TEST(PublicWaves, LiversAgreeWithTheScannersMap) {
  GLISSON_NEEDS_DATA(folder);
  for (int n = 51; n <= 55; ++n) {
    const Liver l = liver(n);
    const Inversion r = inverted(l.offsets_rad, l.mask);
    std::vector<double> theirs;
    std::array<Comparison, 3> at;
    constexpr std::array<float, 3> least{0.0F, 0.8F, 0.95F};
    for (std::size_t v = 0; v < l.mask.values.size(); ++v) {
      if (l.mask.values[v] == 0 || !(l.scanner_kPa[v] > 0.0)) continue;
      theirs.push_back(l.scanner_kPa[v]);
      for (std::size_t c = 0; c < at.size(); ++c)
        if (std::isfinite(r.shear_kPa.values[v]) && r.confidence.values[v] >= least[c])
          at[c].add(static_cast<double>(r.shear_kPa.values[v]), static_cast<double>(r.spread_kPa.values[v]),
                    l.scanner_kPa[v]);
    }
    const double of = medianOf(theirs);
    std::printf("slice %d: scanner %.2f kPa;", n, of);
    for (std::size_t c = 0; c < at.size(); ++c)
      std::printf(" confidence %.2f: %.0f %% of its voxels, median %+.1f %%, voxel by voxel %+.1f %%, %.0f %% within;",
                  static_cast<double>(least[c]), 100.0 * double(at[c].ours.size()) / double(theirs.size()),
                  100 * (medianOf(at[c].ours) / of - 1), 100 * (medianOf(at[c].ratios) - 1), 100 * at[c].share());
    std::printf("\n");
    std::fflush(stdout);
    EXPECT_NEAR(medianOf(at[0].ours), of, 0.05 * of);
    EXPECT_NEAR(medianOf(at[1].ours), of, 0.051 * of);
    EXPECT_NEAR(medianOf(at[2].ours), of, 0.07 * of);  // a smaller sample of the organ: 54 and 55 by 5.5 and 6.1 %
    EXPECT_NEAR(medianOf(at[2].ratios), 1.0, 0.051);
    EXPECT_GE(double(at[2].ours.size()), 0.6 * double(theirs.size()));
    EXPECT_GE(at[2].share(), 0.95);
  }
}

double deviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double r : values) sum += r, squares += r * r;
  const auto n = static_cast<double>(values.size());
  return std::sqrt((squares - sum * sum / n) / (n - 1.0)) / (sum / n);
}

struct Phantom {
  std::vector<Complex> wave;
  std::vector<double> truth_kPa;
  image::Mask mask;
};

Phantom phantom(const char* study, int n) {
  const auto data = test::sharedData() / folder / study;
  const std::string name = std::to_string(n) + "_E.nii";
  const image::Grid g = slice(1.0);
  const std::vector<double> wave = lastValues<double>(data / "MMDI Eval DF" / name, 2 * g.voxelCount());
  Phantom p{std::vector<Complex>(g.voxelCount()),
            lastValues<double>(data / "MMDI Eval Stiffness" / name, g.voxelCount()), image::Mask(g)};
  for (std::size_t v = 0; v < g.voxelCount(); ++v) {
    p.mask.values[v] = p.truth_kPa[v] > 0.0 ? 1 : 0;
    if (p.mask.values[v] != 0) p.wave[v] = Complex(wave[v], wave[g.voxelCount() + v]) / 2048.0;
  }
  return p;
}

/// Factor on the true map with which the phantom's waves obey ∇·(G∇u) + ρω²u = 0 best, by least squares over the weak
/// form with test functions (1 − r²/R²)², R = 8 pixels; a constant beside the wave is free.
double ownScale(const Phantom& p) {
  constexpr int reach = 8;
  const image::Grid& g = p.mask.grid;
  const double inertia = 1000.0 * std::pow(2.0 * std::numbers::pi * 60.0, 2) * 1e-9;
  std::vector<std::array<Complex, 3>> rows;  // ∫ G ∇u·∇φ, ρω² ∫ u φ, ∫ φ
  for (int j = reach + 1; j < 255 - reach; j += 2)
    for (int i = reach + 1; i < 255 - reach; i += 2) {
      std::array<Complex, 3> row{};
      bool inside = true;
      for (int b = -reach; b <= reach && inside; ++b)
        for (int a = -reach; a <= reach && inside; ++a) {
          const double rest = 1.0 - (a * a + b * b) / double(reach * reach);
          if (rest <= 0.0) continue;
          const auto at = [&](int x, int y) { return g.linear(i + a + x, j + b + y, 0); };
          inside = p.mask.values[at(1, 0)] != 0 && p.mask.values[at(-1, 0)] != 0 && p.mask.values[at(0, 1)] != 0 &&
                   p.mask.values[at(0, -1)] != 0;
          const Complex ux = 0.5 * (p.wave[at(1, 0)] - p.wave[at(-1, 0)]),
                        uy = 0.5 * (p.wave[at(0, 1)] - p.wave[at(0, -1)]);
          row[0] -= p.truth_kPa[at(0, 0)] * (4.0 * rest / (reach * reach)) * (ux * double(a) + uy * double(b));
          row[1] += inertia * p.wave[at(0, 0)] * rest * rest;
          row[2] += rest * rest;
        }
      if (inside) rows.push_back(row);
    }
  std::array<Complex, 2> mean{};
  for (const auto& r : rows)
    for (std::size_t c = 0; c < 2; ++c) mean[c] += r[c] / double(rows.size());
  double power = 0.0, cross = 0.0;
  for (const auto& r : rows) {
    cross += (std::conj(r[1] - mean[1]) * (r[0] - mean[0])).real();
    power += std::norm(r[1] - mean[1]);
  }
  return power / cross;
}

// Finite-element phantoms. Their pixel size is not told: one common factor of each study is free.
TEST(PublicWaves, PhantomsScatterLittleAndTheSpreadHolds) {
  GLISSON_NEEDS_DATA(folder);
  for (const auto& [study, first] : {std::pair("Study1(a)-Sample Data", 1251), std::pair("Study2-Sample Data", 1451)}) {
    std::vector<double> medians, own;
    std::vector<std::array<double, 2>> voxels;  // value/truth, spread/truth
    std::size_t all = 0;
    for (int n = first; n < first + 10; n += 2) {
      const Phantom p = phantom(study, n);
      std::vector<image::ScalarVolume> offsets(8, image::ScalarVolume(p.mask.grid));
      for (std::size_t t = 0; t < 8; ++t)
        for (std::size_t v = 0; v < p.wave.size(); ++v)
          offsets[t].values[v] =
              static_cast<float>((p.wave[v] * std::polar(1.0, 2.0 * std::numbers::pi * double(t) / 8.0)).real());
      const Inversion r = inverted(offsets, p.mask);
      // The homogeneous ones move on a bent background, which this scale does not take off.
      if (first == 1451) own.push_back(ownScale(p));
      std::vector<double> ratio;
      for (std::size_t v = 0; v < p.wave.size(); ++v) {
        if (p.mask.values[v] == 0) continue;
        ++all;
        if (!std::isfinite(r.shear_kPa.values[v]) || r.confidence.values[v] < 0.95F) continue;
        ratio.push_back(static_cast<double>(r.shear_kPa.values[v]) / p.truth_kPa[v]);
        voxels.push_back({ratio.back(), static_cast<double>(r.spread_kPa.values[v]) / p.truth_kPa[v]});
      }
      medians.push_back(medianOf(ratio));
    }
    const double factor = medianOf(medians);
    double within = 0.0;
    for (const auto& [ratio, spread] : voxels) within += std::abs(ratio - factor) <= 1.96 * spread ? 1.0 : 0.0;
    const auto n = static_cast<double>(voxels.size());
    std::printf("%s: scatter %.1f %% about %.3f;", study, 100 * deviation(medians), factor);
    for (const double m : medians) std::printf(" %.3f", m);
    std::printf("; confidence 0.95: %.0f %% of the voxels, %.1f %% within 1.96 spreads\n",
                100 * n / static_cast<double>(all), 100 * within / n);
    EXPECT_LE(deviation(medians), 0.04);
    EXPECT_GE(n, 0.6 * static_cast<double>(all));
    EXPECT_GE(within / n, 0.9);
    if (own.empty()) continue;
    std::vector<double> against;
    for (std::size_t i = 0; i < own.size(); ++i) against.push_back(medians[i] / own[i]);
    std::printf("   the phantoms' own scales scatter by %.1f %%:", 100 * deviation(own));
    for (const double o : own) std::printf(" %.3f", o);
    std::printf("; about those %.1f %%\n", 100 * deviation(against));
    EXPECT_LE(deviation(against), 0.03);
  }
}

}  // namespace
}  // namespace glisson::inversion

#include <gtest/gtest.h>

#include <algorithm>
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

Inversion inverted(const std::vector<image::ScalarVolume>& offsets_rad, const image::Mask& mask, Method method) {
  PhaseOffsets p;
  p.offsets_rad = offsets_rad;
  WaveOptions w;
  w.mask = mask;
  InversionOptions o;
  o.frequency_Hz = 60.0;
  o.dimensions = 2;
  o.method = method;
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

// Five livers in vivo at 60 Hz, 1.40625 mm, against the map that the scanner's own multi-model inversion made of them.
TEST(PublicWaves, LiversAgreeWithTheScannersMap) {
  GLISSON_NEEDS_DATA(folder);
  const auto data = test::sharedData() / folder / "Study3-Sample Data";
  for (int n = 51; n <= 55; ++n) {
    const image::ScalarVolume stored = image::readVolume(data / "Processed Data" / (std::to_string(n) + ".nii"));
    ASSERT_EQ(stored.grid.size, Eigen::Vector3i(256, 256, 8));
    const image::Grid g = slice(1.40625);
    std::vector<image::ScalarVolume> offsets;
    image::Mask mask(g);
    for (int t = 0; t < 8; ++t) {
      offsets.emplace_back(g);
      for (std::size_t v = 0; v < mask.values.size(); ++v) {
        const auto value = static_cast<double>(stored.values[static_cast<std::size_t>(t) * mask.values.size() + v]);
        if (value != 0.0) mask.values[v] = 1;
        offsets.back().values[v] = static_cast<float>(value * 2.0 * std::numbers::pi / 4096.0);
      }
    }
    const std::vector<double> scanner = lastValues<std::int16_t>(data / "Processed Stiffness" / (std::to_string(n) + ".mat"), 256u * 256u);
    for (const Method method : {Method::Laplacian, Method::LocalWaves}) {
      const Inversion r = inverted(offsets, mask, method);
      std::vector<double> theirs, all, clear, ours;
      for (int j = 0; j < 256; ++j)
        for (int i = 0; i < 256; ++i) {
          // Rows of the map are columns of the phase images.
          const double there = scanner[static_cast<std::size_t>(i * 256 + j)] / 100.0;
          const std::size_t v = g.linear(i, j, 0);
          if (there > 0.0) theirs.push_back(there);
          if (!std::isfinite(r.shear_kPa.values[v])) continue;
          all.push_back(static_cast<double>(r.shear_kPa.values[v]));
          if (r.confidence.values[v] >= 0.8F) clear.push_back(all.back());
          if (there > 0.0 && r.confidence.values[v] >= 0.95F) ours.push_back(all.back());
        }
      const double of = medianOf(theirs);
      ASSERT_FALSE(ours.empty());
      std::printf("slice %d, %s: scanner %.2f kPa; all %zu voxels %+.1f %%; confidence 0.8: %+.1f %%; 0.95: %+.1f %% (%.0f %% of "
                  "the scanner's voxels)\n",
                  n, method == Method::LocalWaves ? "local waves" : "laplacian", of, all.size(),
                  100 * (medianOf(all) / of - 1), 100 * (medianOf(clear) / of - 1), 100 * (medianOf(ours) / of - 1),
                  100.0 * static_cast<double>(ours.size()) / static_cast<double>(theirs.size()));
      std::fflush(stdout);
      EXPECT_NEAR(medianOf(clear), of, 0.2 * of);
    }
  }
}

struct Scatter {
  std::vector<double> ratios;
  double deviation() const {
    double sum = 0.0, squares = 0.0;
    for (const double r : ratios) sum += r, squares += r * r;
    const auto n = static_cast<double>(ratios.size());
    return std::sqrt((squares - sum * sum / n) / (n - 1.0)) / (sum / n);
  }
};

// Finite-element phantoms. Their pixel size is not told: one common factor of each study is free.
TEST(PublicWaves, PhantomsScatterLittle) {
  GLISSON_NEEDS_DATA(folder);
  const image::Grid g = slice(1.0);
  for (const auto& [study, first] : {std::pair("Study1(a)-Sample Data", 1251), std::pair("Study2-Sample Data", 1451)}) {
    Scatter scatter;
    std::vector<double> error, spread, confidence;
    for (int n = first; n < first + 10; n += 2) {
      const auto data = test::sharedData() / folder / study;
      const std::string name = std::to_string(n) + "_E.nii";
      const std::vector<double> wave = lastValues<double>(data / "MMDI Eval DF" / name, 2u * 256u * 256u),
                                truth = lastValues<double>(data / "MMDI Eval Stiffness" / name, 256u * 256u);
      image::Mask mask(g);
      for (std::size_t v = 0; v < mask.values.size(); ++v) mask.values[v] = truth[v] > 0.0 ? 1 : 0;
      std::vector<image::ScalarVolume> offsets;
      for (int t = 0; t < 8; ++t) {
        offsets.emplace_back(g);
        for (std::size_t v = 0; v < mask.values.size(); ++v) {
          const double angle = 2.0 * std::numbers::pi * t / 8.0;
          const double real = wave[v], imaginary = wave[mask.values.size() + v];
          if (mask.values[v] != 0)
            offsets.back().values[v] = static_cast<float>((real * std::cos(angle) - imaginary * std::sin(angle)) / 2048.0);
        }
      }
      // The middle of each, to be done soon.
      Eigen::Vector3i low(255, 255, 0), high(0, 0, 0);
      for (int j = 0; j < 256; ++j)
        for (int i = 0; i < 256; ++i)
          if (mask.at(i, j, 0) != 0) low = low.cwiseMin(Eigen::Vector3i(i, j, 0)), high = high.cwiseMax(Eigen::Vector3i(i, j, 0));
      for (int j = 0; j < 256; ++j)
        for (int i = 0; i < 256; ++i)
          if (std::abs(2 * i - low.x() - high.x()) > 90 || std::abs(2 * j - low.y() - high.y()) > 90) mask.at(i, j, 0) = 0;
      const Inversion r = inverted(offsets, mask, Method::LocalWaves);
      std::vector<double> ratio;
      for (std::size_t v = 0; v < mask.values.size(); ++v)
        if (mask.values[v] != 0 && std::isfinite(r.shear_kPa.values[v])) {
          ratio.push_back(static_cast<double>(r.shear_kPa.values[v]) / truth[v]);
          spread.push_back(static_cast<double>(r.spread_kPa.values[v] / r.magnitude_kPa.values[v]));
          confidence.push_back(static_cast<double>(r.confidence.values[v]));
        }
      scatter.ratios.push_back(medianOf(ratio));
      error.insert(error.end(), ratio.begin(), ratio.end());
    }
    const double factor = medianOf(scatter.ratios);
    double within = 0.0, near = 0.0, confident = 0.0;
    for (std::size_t v = 0; v < error.size(); ++v) {
      if (confidence[v] < 0.95) continue;
      const double off = std::abs(error[v] / factor - 1.0);
      confident += 1.0;
      within += off <= 1.96 * spread[v] ? 1.0 : 0.0;
      near += off <= 0.19 ? 1.0 : 0.0;
    }
    std::printf("%s: factor %.3f, scatter %.1f %%;", study, factor, 100 * scatter.deviation());
    for (const double r : scatter.ratios) std::printf(" %.3f", r);
    std::printf("; at confidence 0.95 (%.0f %% of %zu voxels) %.1f %% within 1.96 spreads, %.1f %% within 19 %%; spread %.1f %%\n",
                100 * confident / static_cast<double>(error.size()), error.size(), 100 * within / confident,
                100 * near / confident, 100 * medianOf(spread));
    std::fflush(stdout);
    EXPECT_LE(scatter.deviation(), 0.1);
  }
}

}  // namespace
}  // namespace glisson::inversion

// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/thumbnail.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace glisson::dicom {
namespace {

/// A series of the one slice k of another.
Series sliceOf(const Series& series, int k) {
  Series one = series;
  const auto n = static_cast<std::size_t>(k);
  one.grid.size.z() = 1;
  one.grid.origin_lps_mm = series.grid.indexToLps(Eigen::Vector3d(0.0, 0.0, k));
  if (series.frames.empty())
    one.files = {series.files.at(n)};
  else
    one.frames = {series.frames.at(n)};
  if (!series.fileOfSlice.empty()) {
    one.files = {series.files.at(static_cast<std::size_t>(series.fileOfSlice.at(n)))};
    one.fileOfSlice.clear();
  }
  return one;
}

/// Mean of the finite values of columns [i0, i1) and rows [j0, j1); not a number where there is none.
float meanOf(const image::ScalarVolume& v, int i0, int i1, int j0, int j1) {
  double sum = 0.0;
  int count = 0;
  for (int j = j0; j < j1; ++j)
    for (int i = i0; i < i1; ++i)
      if (const float value = v.at(i, j, 0); std::isfinite(value)) {
        sum += static_cast<double>(value);
        ++count;
      }
  return count > 0 ? static_cast<float>(sum / count) : std::nanf("");
}

}  // namespace

Thumbnail thumbnail(const Series& series, int size_px) {
  if (size_px < 8) throw BadArgument("thumbnail: at least 8 pixels are needed");
  Thumbnail out;
  if (series.burnedIn) {
    out.whyNone = "its pixels may hold text about the patient";
    return out;
  }
  image::ScalarVolume slice;
  try {
    if (series.error) throw BadInput(*series.error);
    slice = readSeries(sliceOf(series, (series.grid.size.z() - 1) / 2));
  } catch (const BadInput& e) {
    out.whyNone = e.what();
    return out;
  }
  const image::Grid& g = slice.grid;
  const double width_mm = g.size.x() * g.spacing_mm.x();
  const double height_mm = g.size.y() * g.spacing_mm.y();
  const double pixel_mm = std::max({width_mm / size_px, height_mm / size_px, g.spacing_mm.x(), g.spacing_mm.y()});
  out.width = std::clamp(static_cast<int>(std::lround(width_mm / pixel_mm)), 1, size_px);
  out.height = std::clamp(static_cast<int>(std::lround(height_mm / pixel_mm)), 1, size_px);
  const auto edge = [](int n, int of, int pixels) {
    return static_cast<int>(static_cast<std::int64_t>(n) * pixels / of);
  };
  std::vector<float> values;
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) {
      const int i0 = edge(i, out.width, g.size.x());
      const int j0 = edge(j, out.height, g.size.y());
      values.push_back(meanOf(slice, i0, std::max(i0 + 1, edge(i + 1, out.width, g.size.x())), j0,
                              std::max(j0 + 1, edge(j + 1, out.height, g.size.y()))));
    }
  std::vector<float> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](float v) { return std::isfinite(v); });
  std::sort(sorted.begin(), sorted.end());
  const auto percentile = [&sorted](double part) {
    return sorted.empty() ? 0.0F : sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  const double low = static_cast<double>(percentile(0.01));
  const double range = static_cast<double>(percentile(0.99)) - low;
  for (const float v : values) {
    const double shade = range > 0.0 && std::isfinite(v) ? (static_cast<double>(v) - low) / range : 0.0;
    out.grey.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(shade, 0.0, 1.0))));
  }
  return out;
}

}  // namespace glisson::dicom

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/reader_intervals.h"

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace glisson::pipeline::detail {
namespace {

struct Overlap {
  double a = 0.0, b = 0.0, both = 0.0;  ///< voxels
};

std::vector<Overlap> overlapBySlice(const image::Mask& a, const image::Mask& b) {
  std::vector<Overlap> out;
  const std::size_t perSlice = a.grid.linear(0, 0, 1);
  for (std::size_t begin = 0; begin < a.values.size(); begin += perSlice) {
    Overlap o;
    for (std::size_t v = begin; v < begin + perSlice; ++v) {
      const bool inA = a.values[v] != 0, inB = b.values[v] != 0;
      o.a += inA ? 1.0 : 0.0;
      o.b += inB ? 1.0 : 0.0;
      o.both += inA && inB ? 1.0 : 0.0;
    }
    if (o.a + o.b > 0.0) out.push_back(o);
  }
  return out;
}

struct Sums {
  double n = 0.0, sum = 0.0;
};

}  // namespace

void addOverlapIntervals(const image::Mask& a, const image::Mask& b, ReaderIntervals& out) {
  const std::vector<Overlap> slices = overlapBySlice(a, b);
  const auto figure = [&slices](const auto& of) {
    return elastography::bootstrapSlices(slices.size(), [&slices, &of](const std::vector<std::size_t>& drawn) {
      Overlap sum;
      for (const std::size_t s : drawn) {
        sum.a += slices[s].a;
        sum.b += slices[s].b;
        sum.both += slices[s].both;
      }
      return of(sum);
    });
  };
  const double voxel_mL = 1e-3 * a.grid.voxelVolume_mm3();
  out.slices = slices.size();
  out.dice = figure([](const Overlap& o) { return 2.0 * o.both / (o.a + o.b); });
  out.jaccard = figure([](const Overlap& o) { return o.both / (o.a + o.b - o.both); });
  out.volumeDifference_mL = figure([voxel_mL](const Overlap& o) { return (o.b - o.a) * voxel_mL; });
  out.volumeDifference_percent = figure([](const Overlap& o) { return 200.0 * (o.b - o.a) / (o.a + o.b); });
}

elastography::Interval stiffnessDifference(const elastography::Measurement& a, const elastography::Measurement& b) {
  std::map<int, std::array<Sums, 2>> bySlice;
  for (const auto& [reader, measured] : {std::pair(0u, &a), std::pair(1u, &b)})
    for (const elastography::SliceStatistics& s : measured->slices)
      if (s.statistics.n > 0) {
        const auto n = static_cast<double>(s.statistics.n);
        bySlice[s.slice][reader] = {n, n * s.statistics.mean_kPa};
      }
  std::vector<std::array<Sums, 2>> slices;
  for (const auto& [k, sums] : bySlice) slices.push_back(sums);
  return elastography::bootstrapSlices(slices.size(), [&slices](const std::vector<std::size_t>& drawn) {
    std::array<Sums, 2> total{};
    for (const std::size_t s : drawn)
      for (std::size_t r = 0; r < 2; ++r) {
        total[r].n += slices[s][r].n;
        total[r].sum += slices[s][r].sum;
      }
    return total[1].sum / total[1].n - total[0].sum / total[0].n;  // not-a-number where a reader has nothing there
  });
}

}  // namespace glisson::pipeline::detail

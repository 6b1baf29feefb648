// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/reading.h"

namespace glisson::elastography {

SliceFault faultOf(const Statistics& s) {
  constexpr std::size_t tenth = 10;
  if (s.n == 0) return SliceFault::NoReliableWave;
  if (tenth * s.n < s.n_before_mask) return SliceFault::MostlyWithout;
  return s.area_mm2 < smallestOnSlice_mm2 ? SliceFault::Small : SliceFault::None;
}

const char* nameOf(SliceFault fault) {
  switch (fault) {
    case SliceFault::NoReliableWave: return "no-reliable-wave";
    case SliceFault::MostlyWithout: return "mostly-without-reliable-wave";
    case SliceFault::Small: return "small";
    case SliceFault::None: break;
  }
  return "none";
}

Reading readingOf(const Measurement& m) {
  Reading r;
  if (m.drawn > 0) r.shareMeasured = static_cast<double>(m.pooled.n) / static_cast<double>(m.drawn);
  if (m.meanOfAll_kPa > 0.0) r.meanChange = m.pooled.mean_kPa / m.meanOfAll_kPa - 1.0;
  r.changeToBeReal_kPa = repeatabilityCoefficient * m.pooled.mean_kPa;
  r.small = m.pooled.area_mm2 < smallestRegion_mm2;
  for (const SliceStatistics& s : m.slices) {
    r.slices.push_back({s.slice, faultOf(s.statistics)});
    if (r.slices.back().fault == SliceFault::NoReliableWave) ++r.failed;
  }
  return r;
}

}  // namespace glisson::elastography

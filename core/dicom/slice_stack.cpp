// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/slice_stack.h"

#include <algorithm>
#include <cmath>

namespace glisson::dicom {
namespace {

constexpr double roundedWithin = 0.1;  ///< of the spacing, where that is less than roundedWithin_mm
constexpr double exactWithin_mm = 0.01, exactWithin = 0.001;
constexpr std::size_t mostGaps = 10;

/// The line place = first + step * index nearest to all slices.
void fit(const std::vector<double>& index, const std::vector<double>& place, SliceStack& s) {
  const auto n = static_cast<double>(place.size());
  double meanIndex = 0.0, meanPlace = 0.0, both = 0.0, squares = 0.0;
  for (std::size_t p = 0; p < place.size(); ++p) {
    meanIndex += index[p] / n;
    meanPlace += place[p] / n;
  }
  for (std::size_t p = 0; p < place.size(); ++p) {
    both += (index[p] - meanIndex) * (place[p] - meanPlace);
    squares += (index[p] - meanIndex) * (index[p] - meanIndex);
  }
  s.step_mm = both / squares;
  s.first_mm = meanPlace - s.step_mm * meanIndex;
  for (std::size_t p = 0; p < place.size(); ++p)
    s.off_mm = std::max(s.off_mm, std::abs(place[p] - s.first_mm - s.step_mm * index[p]));
}

}  // namespace

SliceStack stackOf(const std::vector<double>& along_mm) {
  SliceStack s;
  std::vector<double> gaps;
  for (std::size_t n = 1; n < along_mm.size(); ++n) gaps.push_back(along_mm[n] - along_mm[n - 1]);
  std::vector<double> sorted = gaps;
  std::sort(sorted.begin(), sorted.end());
  s.smallest_mm = sorted.front();
  // The usual distance; of few slices with one missing, the smaller one.
  const double usual_mm = sorted[(sorted.size() - 1) / 2];
  std::vector<double> index{0.0};
  for (const double gap : gaps) index.push_back(index.back() + std::max(1.0, std::round(gap / usual_mm)));
  fit(index, along_mm, s);
  s.even = s.off_mm <= std::max(std::min(roundedWithin_mm, roundedWithin * s.step_mm), 0.005 + 0.01 * s.step_mm);
  s.exact = s.off_mm <= exactWithin_mm + exactWithin * s.step_mm;
  if (!s.even) {
    s.step_mm = usual_mm;
    double oddest_mm = -1.0;
    for (std::size_t g = 0; g < gaps.size(); ++g)
      if (const double off_mm = std::abs(gaps[g] - usual_mm); off_mm > oddest_mm) {
        oddest_mm = off_mm;
        s.odd = g + 1;
      }
    return s;
  }
  for (std::size_t p = 1; p < along_mm.size(); ++p)
    for (double i = index[p - 1] + 1.0; i < index[p] && s.missing.size() < mostGaps; i += 1.0)
      s.missing.push_back({s.first_mm + i * s.step_mm, p});
  return s;
}

}  // namespace glisson::dicom

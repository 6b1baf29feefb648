// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "roi/contour_stack.h"

namespace glisson::test {

/// Whether two readers' outlines are the same to the last bit: polygons in order, their state, kind and vertices.
inline bool same(const roi::ContourStack& a, const roi::ContourStack& b) {
  if (a.polygons.size() != b.polygons.size()) return false;
  for (std::size_t p = 0; p < a.polygons.size(); ++p) {
    const roi::Polygon &x = a.polygons[p], &y = b.polygons[p];
    if (x.state != y.state || x.exclude != y.exclude || x.points_lps_mm.cols() != y.points_lps_mm.cols() ||
        x.points_lps_mm != y.points_lps_mm)
      return false;
  }
  return true;
}

}  // namespace glisson::test

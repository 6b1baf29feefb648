// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/arrangement.h"
#include "roi/detail/slabs.h"
#include "roi/plane.h"

namespace glisson::roi {

double area_mm2(const ContourStack& contours) {
  double total = 0.0;
  for (const FlatPolygons& flat : flatPlanesOf(contours)) {
    // Outlines first, exclusions behind them.
    std::vector<Eigen::Matrix2Xd> rings, excluded;
    std::vector<bool> flips;
    for (std::size_t m = 0; m < flat.members.size(); ++m) {
      const Polygon& polygon = contours.polygons[flat.members[m]];
      (polygon.exclude ? excluded : rings).push_back(flat.rings_mm[m]);
      if (!polygon.exclude) flips.push_back(polygon.combine == Combine::Parity);
    }
    if (rings.empty()) continue;
    const Arrangement arrangement = arrange(rings, flips);
    rings.insert(rings.end(), excluded.begin(), excluded.end());
    const auto outlines = static_cast<std::ptrdiff_t>(flips.size());
    detail::forTrapezoids(rings, [&](const std::vector<bool>& in, double area) {
      if (std::find(in.begin() + outlines, in.end(), true) == in.end() && holds(arrangement, in)) total += area;
    });
  }
  return total;
}

}  // namespace glisson::roi

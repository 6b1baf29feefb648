// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>

#include "roi/arrangement.h"
#include "roi/detail/slabs.h"
#include "roi/plane.h"

namespace glisson::roi {
namespace {

std::int64_t number(std::size_t n) {
  return static_cast<std::int64_t>(n);
}

struct Counts {
  std::size_t repeated = 0, repeatedOn = 0, overlapping = 0, overlappingOn = 0, cancelling = 0, hollow = 0, specks = 0;
  std::size_t crossing = 0, crossingOn = 0;

  void add(const ContourStack& contours, const std::vector<std::size_t>& members, const image::Grid& grid) {
    std::vector<Eigen::Matrix2Xd> rings;
    std::vector<bool> flips;
    for (const std::size_t p : members) {
      const Polygon& polygon = contours.polygons[p];
      if (polygon.exclude) continue;
      rings.emplace_back(grid.direction.leftCols<2>().transpose() *
                         (polygon.points_lps_mm.colwise() - grid.origin_lps_mm));
      flips.push_back(polygon.combine == Combine::Parity);
    }
    if (rings.empty()) return;
    constexpr double speck_pixels = 0.25;
    bool large = false;
    const std::size_t before = crossing;
    for (const Eigen::Matrix2Xd& ring : rings) {
      const detail::Windings w = detail::windingsOf(ring);
      const double speck_mm2 = speck_pixels * grid.spacing_mm.head<2>().prod();
      if (std::max(w.more, w.against) > speck_mm2) ++crossing;
      const bool speck = w.odd < speck_mm2;
      specks += speck ? 1 : 0;
      large = large || !speck;
    }
    crossingOn += crossing > before ? 1 : 0;
    const Arrangement arrangement = arrange(rings, flips);
    repeated += arrangement.repeated;
    repeatedOn += arrangement.repeated > 0 ? 1 : 0;
    overlapping += arrangement.overlapping;
    overlappingOn += arrangement.overlapping > 0 ? 1 : 0;
    if (!large || rings.size() < 2) return;
    double area = 0.0, enclosed = 0.0;
    detail::forTrapezoids(rings, [&](const std::vector<bool>& in, double a) {
      area += holds(arrangement, in) ? a : 0.0;
      enclosed += std::find(in.begin(), in.end(), true) != in.end() ? a : 0.0;
    });
    if (area < speck_pixels * grid.spacing_mm.head<2>().prod())
      ++cancelling;
    else if (area < 0.5 * enclosed)
      ++hollow;
  }
};

}  // namespace

Diagnostics outlineDoubts(const ContourStack& contours, const image::Grid& grid, bool drawnHere) {
  Diagnostics doubts;
  const SliceOutlines slices = outlinesOf(contours, grid);
  Counts counts;
  for (const std::vector<std::size_t>& members : slices.members) counts.add(contours, members, grid);
  if (counts.repeated > 0)
    doubts.add(DiagnosticCode::OutlinesRepeated,
               {{"count", number(counts.repeated)}, {"slices", number(counts.repeatedOn)}});
  if (counts.overlapping > 0)
    doubts.add(DiagnosticCode::OutlinesOverlap,
               {{"count", number(counts.overlapping)}, {"slices", number(counts.overlappingOn)}});
  if (counts.cancelling > 0) doubts.add(DiagnosticCode::OutlinesCancel, {{"slices", number(counts.cancelling)}});
  if (counts.hollow > 0) doubts.add(DiagnosticCode::OutlinesHollow, {{"slices", number(counts.hollow)}});
  if (!slices.offPlane.empty())
    doubts.add(DiagnosticCode::OutlinesOffPlane,
               {{"count", number(slices.offPlane.size())}, {"mm", slices.farthestOffPlane_mm}});
  if (!slices.leftOut.empty())
    doubts.add(DiagnosticCode::OutlinesLeftOut,
               {{"count", number(slices.leftOut.size())}, {"mm", slices.farthestOffPlane_mm}});
  if (drawnHere && !slices.beyond.empty())
    doubts.add(DiagnosticCode::OutlinesBeyond,
               {{"count", number(slices.beyond.size())}, {"all", number(contours.polygons.size())}});
  if (counts.crossing > 0)
    doubts.add(DiagnosticCode::OutlinesCrossThemselves,
               {{"count", number(counts.crossing)}, {"slices", number(counts.crossingOn)}});
  if (counts.specks > 0) doubts.add(DiagnosticCode::OutlineSpecks, {{"count", number(counts.specks)}});
  return doubts;
}

}  // namespace glisson::roi

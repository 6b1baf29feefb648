// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "image/morphology.h"
#include "pipeline/sources.h"
#include "roi/arrangement.h"
#include "roi/interpolate.h"
#include "roi/plane.h"

namespace glisson::pipeline {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void checkOutlines(LoadedRoi& roi, const image::Grid& mriGrid) {
  if (!roi.contours) return;
  const Diagnostics doubts = roi::outlineDoubts(*roi.contours, mriGrid, true);
  roi.diagnostics.add(doubts);
  append(roi.warnings, doubts.texts(Severity::Warning));
}

std::optional<std::string> completeOutlines(LoadedRoi& roi, const image::Grid& mriGrid) {
  if (!roi.contours) return std::nullopt;
  *roi.contours = roi::interpolateBetween(*roi.contours, mriGrid);
  // Outlines that a reader had interpolated before count like those interpolated just now.
  int drawn = 0, interpolated = 0;
  for (const std::vector<std::size_t>& members : roi::polygonsPerSlice(*roi.contours, mriGrid)) {
    const auto holds = [&](roi::PolygonState state) {
      return std::any_of(members.begin(), members.end(), [&](std::size_t p) {
        const roi::Polygon& polygon = roi.contours->polygons[p];
        return !polygon.exclude && polygon.state == state;
      });
    };
    if (holds(roi::PolygonState::Accepted))
      ++drawn;
    else if (holds(roi::PolygonState::Interpolated))
      ++interpolated;
  }
  const int empty = static_cast<int>(roi::emptySlicesBetween(*roi.contours, mriGrid).size());
  const auto drafts = std::count_if(roi.contours->polygons.begin(), roi.contours->polygons.end(), [](const auto& p) {
    return p.state == roi::PolygonState::Draft && p.points_lps_mm.cols() > 0;
  });
  if (interpolated + empty + drafts == 0) return std::nullopt;
  std::string text =
      "outlines on " + std::to_string(drawn) + " of " + std::to_string(drawn + interpolated + empty) + " slices";
  if (interpolated + empty > 0)
    text += "; " + std::to_string(interpolated) + " slices between them were interpolated by shape";
  if (empty > 0)
    text += "; " + std::to_string(empty) + " slices stay empty, because the outlines next to them do not overlap";
  if (drafts > 0)
    text += drafts == 1
                ? "; one outline is a draft and does not count: accept or delete it"
                : "; " + std::to_string(drafts) + " outlines are drafts and do not count: accept or delete them";
  return text;
}

namespace {

/// Of slices that lie unevenly: those between the first and the last with an outline that hold none, and outlines that
/// lie on none of them.
void countLeftOut(const roi::ContourStack& contours, const elastography::StiffnessMap& map, Diagnostics& said) {
  const image::Grid& stack = map.values_kPa.grid;
  std::vector<bool> drawn(map.unevenSlices_mm.size(), false);
  std::int64_t all = 0, beyond = 0;
  for (const roi::Polygon& polygon : contours.polygons) {
    if (polygon.state == roi::PolygonState::Draft) continue;
    const double at_mm = stack.lpsToIndex(polygon.points_lps_mm.rowwise().mean()).z() * stack.spacing_mm.z();
    bool here = false;
    for (std::size_t k = 0; k < drawn.size(); ++k)
      if (std::abs(at_mm - map.unevenSlices_mm[k]) <= 0.5 * stack.spacing_mm.z() + 1e-6) here = drawn[k] = true;
    ++all;
    beyond += here ? 0 : 1;
  }
  const auto first = std::find(drawn.begin(), drawn.end(), true);
  const auto last = std::find(drawn.rbegin(), drawn.rend(), true).base();
  if (first < last)
    if (const auto missing = std::count(first, last, false); missing > 0)
      said.add(DiagnosticCode::SlicesWithoutOutline,
               {{"missing", static_cast<std::int64_t>(missing)}, {"slices", static_cast<std::int64_t>(last - first)}});
  if (beyond > 0) said.add(DiagnosticCode::OutlinesBeyond, {{"count", beyond}, {"all", all}});
}

/// Where slices lie unevenly: the region on each of them by itself.
elastography::MappedRoi mapOnSlices(const LoadedRoi& roi, const std::optional<image::Grid>& mriGrid,
                                    const elastography::StiffnessMap& map) {
  const image::Grid& stack = map.values_kPa.grid;
  elastography::MappedRoi all;
  all.mask = image::Mask(stack);
  std::string why;
  for (std::size_t k = 0; k < map.unevenSlices_mm.size(); ++k) {
    elastography::StiffnessMap slice;
    slice.frameOfReferenceUid = map.frameOfReferenceUid;
    slice.values_kPa.grid = stack;
    slice.values_kPa.grid.size.z() = 1;
    slice.values_kPa.grid.origin_lps_mm += map.unevenSlices_mm[k] * stack.direction.col(2);
    try {
      elastography::MappedRoi one = mapRoi(roi, mriGrid, slice);
      std::ranges::copy(one.mask.values,
                        all.mask.values.begin() + static_cast<std::ptrdiff_t>(stack.linear(0, 0, static_cast<int>(k))));
      all.coverage += one.coverage;
      all.coincidentSlices += one.coincidentSlices;
      all.sampledSlices += one.sampledSlices;
      for (const Diagnostic& d : one.diagnostics)
        if (!all.diagnostics.contains(d.code)) all.diagnostics.add(d.code, d.arguments);
    } catch (const BadInput& e) {
      why = e.what();
    }
  }
  if (image::count(all.mask) == 0) throw BadInput(why);
  if (roi.contours && !mriGrid) countLeftOut(*roi.contours, map, all.diagnostics);
  all.coverage = std::min(1.0, all.coverage);
  append(all.warnings, all.diagnostics.texts(Severity::Warning));
  if (!roi.frameOfReferenceUid.empty() && !map.frameOfReferenceUid.empty() &&
      roi.frameOfReferenceUid != map.frameOfReferenceUid)
    all.warnings.push_back(
        "the region of interest and the elastogram have different frames of reference; confirm that they fit");
  return all;
}

}  // namespace

elastography::MappedRoi mapRoi(const LoadedRoi& roi, const std::optional<image::Grid>& mriGrid,
                               const elastography::StiffnessMap& map) {
  if (!map.unevenSlices_mm.empty()) return mapOnSlices(roi, mriGrid, map);
  if (roi.contours) {
    LoadedRoi complete;
    complete.contours = roi.contours;
    const auto completed = mriGrid ? completeOutlines(complete, *mriGrid) : std::nullopt;
    elastography::MappedRoi mapped =
        elastography::mapRoi(*complete.contours, mriGrid, map.values_kPa.grid, map.frameOfReferenceUid);
    if (completed) mapped.warnings.push_back(*completed);
    return mapped;
  }
  if (roi.mask) {
    elastography::MappedRoi mapped = elastography::mapRoi(*roi.mask, map.values_kPa.grid);
    if (!roi.frameOfReferenceUid.empty() && !map.frameOfReferenceUid.empty() &&
        roi.frameOfReferenceUid != map.frameOfReferenceUid)
      mapped.warnings.push_back(
          "the segmentation and the elastogram have different frames of reference: check that they belong together");
    return mapped;
  }
  throw BadArgument("mapRoi: the region of interest is empty");
}

}  // namespace glisson::pipeline

// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/planes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/diagnostic.h"
#include "dicom/detail/series_facts.h"
#include "dicom/detail/slice_stack.h"

namespace glisson::dicom::detail {
namespace {

std::string positionText(double along_mm) {
  std::ostringstream s;
  s.precision(6);
  s << along_mm;
  return s.str();
}

/// A single slice is as thick as it says it is.
void spaceSingle(const Frame& frame, Series& series) {
  const double depth = frame.statedSpacing_mm.value_or(frame.thickness_mm.value_or(0.0));
  series.grid.spacing_mm.z() = depth > 0.0 ? depth : frame.rowSpacing_mm;
  series.warnings.push_back(
      depth > 0.0 ? "has a single slice: statistics are possible, a 3-D model is not"
                  : "has a single slice and no slice thickness: the pixel spacing stands in for it; statistics are "
                    "possible, a 3-D model is not");
}

/// Why slices that lie at one position cannot be told apart.
std::optional<std::string> shareAPlace(const Planes& planes) {
  Planes shared;
  for (std::size_t n = 1; n < planes.size(); ++n)
    if (planes[n].along_mm - planes[n - 1].along_mm < samePlace_mm) {
      if (shared.empty()) shared.push_back(planes[n - 1]);
      shared.push_back(planes[n]);
    }
  if (shared.empty()) return {};
  return "several images lie at one position and nothing tells them apart: " + namesOf(shared) +
         "; separate them before loading";
}

/// Why slices that are sheared against each other make no grid.
std::optional<std::string> areTilted(const Planes& planes, const Eigen::Vector3d& normal) {
  const Frame& first = *planes.front().frame;
  for (const Plane& p : planes) {
    const Eigen::Vector3d step = p.frame->position_lps_mm - first.position_lps_mm;
    const double aside = (step - step.dot(normal) * normal).norm();
    if (aside <= std::max(roundedWithin_mm, 0.002 * std::abs(step.dot(normal)))) continue;
    std::ostringstream why;
    why << "its slices are not stacked along their normal (gantry tilt): " << nameOf(p) << " lies " << aside
        << " mm to the side of " << nameOf(planes.front()) << "; resample it to a regular grid first";
    return why.str();
  }
  return {};
}

void refuseUneven(const Planes& planes, const SliceStack& stack, Series& series) {
  std::ostringstream why;
  why << "its slices are unevenly spaced: " << planes[stack.odd].along_mm - planes[stack.odd - 1].along_mm
      << " mm between " << nameOf(planes[stack.odd - 1]) << " and " << nameOf(planes[stack.odd]) << ", "
      << stack.step_mm << " mm elsewhere; no averaged spacing is made up";
  series.warnings.push_back(why.str());
  series.error = why.str();
}

void refuseGaps(const Planes& planes, const SliceStack& stack, Series& series) {
  std::string places;
  for (const SliceStack::Gap& gap : stack.missing)
    places += (places.empty() ? "" : "; ") + positionText(gap.at_mm) + " mm (between " +
              nameOf(planes[gap.before - 1]) + " and " + nameOf(planes[gap.before]) + ")";
  series.warnings.push_back("a slice is missing at " + places + " along the normal");
  series.error = "a slice is missing at " + places + " along the normal; add its file, or load a complete series";
}

/// Rounded positions are put back to where they are meant.
void spaceEvenly(const Planes& planes, const SliceStack& stack, const Eigen::Vector3d& normal, Series& series) {
  series.grid.spacing_mm.z() =
      (planes.back().along_mm - planes.front().along_mm) / static_cast<double>(planes.size() - 1);
  if (!stack.exact) {
    series.grid.spacing_mm.z() = stack.step_mm;
    series.grid.origin_lps_mm += (stack.first_mm - planes.front().along_mm) * normal;
    tell(series, DiagnosticCode::PositionsRounded, {{"mm", stack.off_mm}, {"spacing_mm", stack.step_mm}});
  }
  if (planes.size() == 2) series.warnings.push_back("has only 2 slices: too few for a 3-D model");
}

void compareWithStated(const Frame& first, Series& series) {
  const double taken_mm = series.grid.spacing_mm.z();
  if (!first.statedSpacing_mm || std::abs(*first.statedSpacing_mm - taken_mm) <= 0.02 * taken_mm + 0.005) return;
  std::ostringstream why;
  why << "says that its slices are " << *first.statedSpacing_mm << " mm apart; their positions say " << taken_mm
      << " mm, which is used";
  series.warnings.push_back(why.str());
}

}  // namespace

std::string nameOf(const Plane& p) {
  std::string name = "'" + p.header->file.filename().string() + "'";
  if (p.header->frames.size() > 1) name += " frame " + std::to_string(p.frame->number + 1);
  return name;
}

std::string namesOf(const Planes& planes) {
  std::string names;
  for (std::size_t n = 0; n < planes.size() && n < 3; ++n) names += (n > 0 ? ", " : "") + nameOf(planes[n]);
  if (planes.size() > 3) names += " and " + std::to_string(planes.size() - 3) + " more";
  return names;
}

void spaceSlices(const Planes& planes, const Eigen::Vector3d& normal, Series& series) {
  const Frame& first = *planes.front().frame;
  if (planes.size() == 1) return spaceSingle(first, series);
  series.error = shareAPlace(planes);
  if (!series.error) series.error = areTilted(planes, normal);
  if (series.error) return;
  std::vector<double> along_mm;
  for (const Plane& p : planes) along_mm.push_back(p.along_mm);
  const SliceStack stack = stackOf(along_mm);
  series.grid.spacing_mm.z() = stack.smallest_mm;
  if (!stack.even || !stack.missing.empty())
    for (const Plane& p : planes) series.unevenSlices_mm.push_back(p.along_mm - planes.front().along_mm);
  if (!stack.even)
    refuseUneven(planes, stack, series);
  else if (!stack.missing.empty())
    refuseGaps(planes, stack, series);
  else
    spaceEvenly(planes, stack, normal, series);
  compareWithStated(first, series);
}

}  // namespace glisson::dicom::detail

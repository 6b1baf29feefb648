// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/outlined.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "base/error.h"
#include "dicom/acquisitions.h"
#include "dicom/roles.h"

namespace glisson::pipeline {
namespace {

using dicom::SeriesRole;

std::string stem(const std::string& uid) {
  return uid.substr(0, uid.find('#'));
}

std::int64_t numberOf(const dicom::ScanResult& scan, int series) {
  return scan.series[static_cast<std::size_t>(series)].number;
}

int indexOf(const dicom::ScanResult& scan, const dicom::Series& series) {
  return static_cast<int>(&series - scan.series.data());
}

/// The series that holds most of the named images, -1 where none holds any.
int byImages(const dicom::ScanResult& scan, const OutlineNames& names) {
  if (names.planes.empty()) return -1;
  std::unordered_map<std::string, int> of;
  for (std::size_t s = 0; s < scan.series.size(); ++s)
    for (const std::string& uid : scan.series[s].sopInstanceUids) of.emplace(uid, static_cast<int>(s));
  std::map<int, int> count;
  for (const NamedPlane& plane : names.planes)
    if (const auto found = of.find(plane.sopInstanceUid); found != of.end()) ++count[found->second];
  const auto most =
      std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? -1 : most->first;
}

int bySeries(const dicom::ScanResult& scan, const OutlineNames& names) {
  if (names.seriesUid.empty()) return -1;
  int found = -1;
  for (std::size_t s = 0; s < scan.series.size(); ++s) {
    const dicom::Series& series = scan.series[s];
    if (series.uid == names.seriesUid) return static_cast<int>(s);
    if (found < 0 && stem(series.uid) == stem(names.seriesUid)) found = static_cast<int>(s);
  }
  return found;
}

/// As dicom::findRole; where no series has the role and there is only one, that one.
const dicom::Series& best(const dicom::ScanResult& scan, SeriesRole role) {
  const bool any = std::any_of(scan.series.begin(), scan.series.end(), [&](const auto& s) { return s.role == role; });
  if (!any && scan.series.size() == 1) return scan.series.front();
  return dicom::findRole(scan, role);
}

/// Whether a series can stand for the MRI: an anatomical one, or what there is where there is none (magnitude images of
/// the elastography show no vessels).
bool servesAsMri(const dicom::Series& s, bool anatomicalThere) {
  if (s.error || s.colour) return false;
  return s.role == SeriesRole::Anatomical ||
         (!anatomicalThere && (s.role == SeriesRole::Magnitude || s.role == SeriesRole::Other));
}

/// The acquisition that a series is a product of; null where it is of none.
const dicom::Acquisition* acquisitionOf(const std::vector<dicom::Acquisition>& all, int series) {
  for (const dicom::Acquisition& a : all) {
    const auto in = [series](const std::vector<int>& list) {
      return std::find(list.begin(), list.end(), series) != list.end();
    };
    if (a.stiffness == series || a.magnitude == series || a.confidence == series || in(a.wave) || in(a.otherStiffness))
      return &a;
  }
  return nullptr;
}

}  // namespace

int outlinedSeries(const dicom::ScanResult& scan, const OutlineNames& names, Diagnostics* said) {
  const int images = byImages(scan, names), series = bySeries(scan, names);
  if (images < 0) return series;
  if (series >= 0 && said != nullptr &&
      stem(scan.series[static_cast<std::size_t>(series)].uid) !=
          stem(scan.series[static_cast<std::size_t>(images)].uid))
    said->add(DiagnosticCode::OutlineNamesContradict,
              {{"named", numberOf(scan, series)}, {"series", numberOf(scan, images)}});
  return images;
}

const dicom::Series& seriesFor(const dicom::ScanResult& scan, SeriesRole role, const OutlineNames& names,
                               Diagnostics& said, bool mayBeUneven) {
  const int named = outlinedSeries(scan, names, &said);
  const std::string what = role == SeriesRole::Stiffness ? "elastogram" : "MRI";
  const bool byHand = std::any_of(scan.series.begin(), scan.series.end(),
                                  [&](const auto& s) { return s.role == role && dicom::setByHand(s); });
  if (role != SeriesRole::Stiffness && named >= 0 && !byHand) {
    const dicom::Series& outlined = scan.series[static_cast<std::size_t>(named)];
    const bool others = std::any_of(scan.series.begin(), scan.series.end(),
                                    [&](const auto& s) { return &s != &outlined && s.role == role && !s.error; });
    if (servesAsMri(outlined, others)) {
      if (others) said.add(DiagnosticCode::SeriesByOutline, {{"series", numberOf(scan, named)}, {"what", what}});
      return outlined;
    }
  }
  const dicom::Series& taken = best(scan, role);
  if (named < 0) return taken;
  if (role != SeriesRole::Stiffness) {
    if (stem(taken.uid) != stem(scan.series[static_cast<std::size_t>(named)].uid))
      said.add(DiagnosticCode::OutlinedSeriesNotTaken,
               {{"named", numberOf(scan, named)}, {"taken", static_cast<std::int64_t>(taken.number)}, {"what", what}});
    return taken;
  }
  const std::vector<dicom::Acquisition> all = dicom::acquisitions(scan);
  const dicom::Acquisition *outlined = acquisitionOf(all, named), *own = acquisitionOf(all, indexOf(scan, taken));
  if (outlined == nullptr || own == nullptr || outlined == own) return taken;
  const dicom::Series* other =
      outlined->stiffness >= 0 ? &scan.series[static_cast<std::size_t>(outlined->stiffness)] : nullptr;
  const bool usable = other != nullptr && (!other->error || (mayBeUneven && !other->unevenSlices_mm.empty()));
  if (byHand || !usable) {
    said.add(DiagnosticCode::OutlinedSeriesNotTaken,
             {{"named", numberOf(scan, named)}, {"taken", static_cast<std::int64_t>(taken.number)}, {"what", what}});
    return taken;
  }
  said.add(DiagnosticCode::SeriesByOutline, {{"series", static_cast<std::int64_t>(other->number)}, {"what", what}});
  return *other;
}

Diagnostics planesOffTheirImages(const OutlineNames& names, const std::vector<const dicom::ScanResult*>& scans,
                                 const std::string& what) {
  struct Place {
    const dicom::Series* series;
    int slice;
  };
  Diagnostics said;
  if (names.planes.empty()) return said;
  std::unordered_map<std::string, Place> places;
  for (const dicom::ScanResult* scan : scans)
    for (const dicom::Series& s : scan->series)
      if ((!s.error || !s.unevenSlices_mm.empty()) && s.frames.empty() &&
          static_cast<int>(s.sopInstanceUids.size()) == s.grid.size.z())
        for (int k = 0; k < s.grid.size.z(); ++k)
          places.emplace(s.sopInstanceUids[static_cast<std::size_t>(k)], Place{&s, k});
  std::int64_t count = 0;
  double farthest_mm = 0.0;
  for (const NamedPlane& plane : names.planes) {
    const auto found = places.find(plane.sopInstanceUid);
    if (found == places.end()) continue;
    const dicom::Series& series = *found->second.series;
    const image::Grid& grid = series.grid;
    const auto slice = static_cast<std::size_t>(found->second.slice);
    const double slack_mm = std::min(0.5, 0.5 * grid.spacing_mm.z());
    const double height_mm =
        series.unevenSlices_mm.empty() ? found->second.slice * grid.spacing_mm.z() : series.unevenSlices_mm[slice];
    const double away_mm = std::abs(grid.lpsToIndex(plane.point_lps_mm).z() * grid.spacing_mm.z() - height_mm);
    if (away_mm <= slack_mm) continue;
    ++count;
    farthest_mm = std::max(farthest_mm, away_mm);
  }
  if (count > 0)
    said.add(DiagnosticCode::OffTheNamedImage, {{"count", count},
                                                {"of", static_cast<std::int64_t>(names.planes.size())},
                                                {"what", what},
                                                {"distance_mm", farthest_mm}});
  return said;
}

}  // namespace glisson::pipeline

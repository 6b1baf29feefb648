// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/measure.h"

#include <algorithm>

#include "base/error.h"
#include "image/io.h"
#include "image/morphology.h"
#include "image/resample.h"
#include "pipeline/breath_hold.h"
#include "pipeline/region_file.h"

namespace glisson::pipeline {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// The warnings but for the texts of notes.
std::vector<std::string> withoutNotes(std::vector<std::string> warnings, const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics)
    if (d.severity() == Severity::Note) std::erase(warnings, d.text());
  return warnings;
}

MapMeaning meaningOf(const MeasureRequest& request, const OutlineNames& outlined) {
  MapMeaning meaning;
  meaning.quantity = request.quantity;
  meaning.unit = request.unit;
  meaning.roles = request.roles;
  meaning.mayBeUneven = true;
  meaning.confidenceScale = request.confidenceScale;
  meaning.outlined = outlined;
  return meaning;
}

void refuseSeveralLabels(const MeasureRequest& request) {
  if (request.label) return;
  if (const std::string labels = severalLabels(request.roi); !labels.empty())
    throw BadInput("'" + request.roi.filename().string() + "' holds the labels " + labels +
                   ": choose the region's with --label (0 takes all of them together)");
}

/// What is not offered for slices that lie unevenly.
void refuseUneven(const MeasureRequest& request, const LoadedStiffness& mre) {
  if (mre.map.unevenSlices_mm.empty()) return;
  if (request.registration)
    throw BadInput("a breath-hold correction needs evenly spaced slices, and the elastogram's are not");
  if (!request.exclude.empty())
    throw BadInput(
        "a mask of what is left out needs evenly spaced slices, and the elastogram's are not; take it off the "
        "region of interest instead");
}

/// The mask of what is left out on the elastogram's grid; what is doubtful about it goes into diagnostics and warnings.
image::Mask exclusion(const MeasureRequest& request, const elastography::MappedRoi& region, MeasuredRegion& out) {
  Diagnostics about;
  image::Mask excluded =
      image::resampleNearest(image::readMask(request.exclude, 0, &about), out.mre.map.values_kPa.grid);
  if (!image::overlap(excluded, region.mask)) about.add(DiagnosticCode::ExclusionElsewhere);
  out.diagnostics.add(about);
  for (const std::string& w : about.texts(Severity::Warning))
    if (std::find(out.mre.warnings.begin(), out.mre.warnings.end(), w) == out.mre.warnings.end())
      out.mre.warnings.push_back(w);
  return excluded;
}

/// Where nothing can be measured, what is odd about the region's place is the likely reason.
elastography::Measurement measured(const elastography::StiffnessMap& map, const elastography::MappedRoi& region,
                                   const elastography::MeasureOptions& options) {
  try {
    return elastography::measure(map, region.mask, options);
  } catch (const BadInput& e) {
    if (region.warnings.empty()) throw;
    throw BadInput(std::string(e.what()) + "; " + region.warnings.front());
  }
}

void measureIn(const MeasureRequest& request, MeasuredRegion& out) {
  elastography::MeasureOptions options;
  options.confidenceThreshold = request.confidence.value_or(defaults::confidenceThreshold);
  if (request.confidence && !out.mre.map.confidence)
    out.mre.warnings.push_back("--confidence was not used: the map comes without a confidence map");
  options.erosion_pixels = request.erosion_pixels;
  options.erosion_mm = request.erosion_mm;
  options.poisson = request.poisson;
  std::optional<image::Mask> excluded;
  if (!request.exclude.empty()) {
    excluded = exclusion(request, out.region, out);
    options.exclude = &*excluded;
  }
  out.measurement = measured(out.mre.map, out.region, options);
}

}  // namespace

MeasuredRegion measureRegion(const MeasureRequest& request, const Progress& progress) {
  refuseSeveralLabels(request);
  // The region first: it says which images it was drawn on.
  const LoadedRoi roi = loadRoi(request.roi, request.name, request.label.value_or(0), progress.part(0.0, 0.2));
  MeasuredRegion out;
  out.mre = loadStiffness(request.mre, meaningOf(request, roi.names), progress.part(0.2, 0.8));
  if (request.registration && request.mri.empty())
    throw BadInput("a breath-hold correction needs the image to fit to: give --mri");
  std::vector<std::string> together;
  std::vector<std::vector<std::string>> rolesNotFound = {out.mre.rolesNotFound};
  std::optional<AnatomicalImage> mri;
  if (!request.mri.empty()) {
    mri = loadImage(request.mri, progress.part(0.8, 0.9), request.roles, roi.names);
    together = checkTogether(*mri, out.mre, request.overrideChecks);
    rolesNotFound.push_back(mri->rolesNotFound);
  }
  const AnatomicalImage* image = mri ? &*mri : nullptr;
  append(together, checkRoi(roi, image, &out.mre, request.overrideChecks));
  refuseUneven(request, out.mre);
  out.diagnostics = out.mre.diagnostics;
  out.diagnostics.add(roi.diagnostics);
  if (mri) out.diagnostics.add(mri->diagnostics);
  if (mri) append(together, withoutNotes(mri->warnings, mri->diagnostics));
  const Diagnostics doubts = doubtsAboutOutline(roi, image, &out.mre);
  out.diagnostics.add(doubts);
  append(together, doubts.texts());
  if (request.registration)
    out.registration = fitToMri(out.mre, request.mre, request.magnitude, mri->volume, progress.part(0.9, 1.0));
  checkRolesFound(request.roles, rolesNotFound);
  out.region = mapRoi(roi, mri ? std::optional(mri->volume.grid) : std::nullopt, out.mre.map);
  measureIn(request, out);
  progress.report(1.0, "measured");
  out.warnings = out.mre.warnings;
  append(out.warnings, together);
  append(out.warnings, roi.warnings);
  append(out.warnings, out.region.warnings);
  append(out.warnings, out.measurement.warnings);
  out.diagnostics.add(out.region.diagnostics);
  out.diagnostics.add(out.measurement.diagnostics);
  return out;
}

}  // namespace glisson::pipeline

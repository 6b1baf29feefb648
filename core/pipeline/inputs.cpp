// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/inputs.h"

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "image/io.h"
#include "pipeline/breath_hold.h"
#include "pipeline/detail/needs.h"
#include "pipeline/detail/step_id.h"
#include "pipeline/region_file.h"
#include "pipeline/sources.h"

namespace glisson::pipeline {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// What was told about a part of the input.
template <typename Loaded>
void take(Inputs& in, const Loaded& part) {
  append(in.warnings, part.warnings);
  in.diagnostics.add(part.diagnostics);
}

/// Notes the time since the last note as that of a step.
class StepClock {
 public:
  explicit StepClock(Inputs& in) : in_(in) {}
  void note(detail::StepId step) {
    const auto now = std::chrono::steady_clock::now();
    in_.seconds.emplace_back(detail::nameOf(step), std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  Inputs& in_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void loadPatient(const Scene& scene, const detail::Needs& needs, Inputs& in, const Progress& progress) {
  const GeometrySpec& g = scene.geometry;
  StepClock clock(in);
  // The region first: it says which images it was drawn on.
  progress.report(0.0, "reading the region of interest");
  LoadedRoi roi = loadRoi(g.roi, g.roiName, g.label, progress.part(0.0, 0.1));
  clock.note(detail::StepId::ReadRoi);
  progress.report(0.1, "reading the MRI");
  AnatomicalImage mri = loadImage(g.mri, progress.part(0.1, 0.4), g.roles, roi.names);
  if (mri.volume.grid.size.z() < 2)
    throw BadInput("the MRI has a single slice: statistics are possible, a 3-D model is not; give the whole series");
  take(in, mri);
  clock.note(detail::StepId::ReadMri);
  progress.report(0.4, "placing the region of interest");
  checkOutlines(roi, mri.volume.grid);
  take(in, roi);
  append(in.warnings, checkRoi(roi, &mri, nullptr, g.overrideChecks));
  const std::optional<std::string> completed = completeOutlines(roi, mri.volume.grid);
  if (completed) in.warnings.push_back(*completed);
  in.liver = roi.contours ? roi::rasterise(*roi.contours, mri.volume.grid) : *roi.mask;
  std::optional<LoadedStiffness> mre;
  if (needs.mre) {
    progress.report(0.5, "reading the elastogram");
    MapMeaning meaning{g.mreQuantity, g.mreUnit, g.roles};
    meaning.outlined = roi.names;
    meaning.confidenceScale = g.mreConfidenceScale;
    mre = loadStiffness(g.mre, meaning, progress.part(0.5, 0.9));
    if (g.rigidRegistration) in.registration = fitToMri(*mre, g.mre, {}, mri.volume, progress.part(0.9, 1.0));
    take(in, *mre);
    append(in.warnings, checkTogether(mri, *mre, g.overrideChecks));
    checkRolesFound(g.roles, {mri.rolesNotFound, mre->rolesNotFound});
    in.roiOnMre = mapRoi(roi, mri.volume.grid, mre->map);
    for (const Diagnostic& d : in.roiOnMre->diagnostics)
      if (!in.diagnostics.contains(d.code)) in.diagnostics.add(d.code, d.arguments);
    for (const std::string& warning : in.roiOnMre->warnings)
      if (warning != completed && std::find(in.warnings.begin(), in.warnings.end(), warning) == in.warnings.end())
        in.warnings.push_back(warning);
    clock.note(detail::StepId::ReadMre);
  }
  const Diagnostics doubts = doubtsAboutOutline(roi, &mri, mre ? &*mre : nullptr);
  in.diagnostics.add(doubts);
  append(in.warnings, doubts.texts());
  if (mre) in.stiffness = std::move(mre->map);
  in.contours = std::move(roi.contours);
  if (needs.mriValues) in.mri = std::move(mri.volume);
}

}  // namespace

Inputs loadInputs(const Scene& scene, const Progress& progress) {
  const detail::Needs needs(scene);
  const GeometrySpec& g = scene.geometry;
  Inputs in;
  if (g.kind == GeometrySpec::Kind::Patient) loadPatient(scene, needs, in, progress);
  StepClock clock(in);
  if (g.kind == GeometrySpec::Kind::Mask) {
    in.liver = readRegion(g.file, g.label, surfaceCell_mm(g), in.warnings, &in.diagnostics);
    clock.note(detail::StepId::ReadRoi);
    if (needs.mriValues && !g.background.empty()) {
      AnatomicalImage background = loadImage(g.background, progress);
      take(in, background);
      in.mri = std::move(background.volume);
    }
    if (needs.mriValues) clock.note(detail::StepId::ReadMri);
  }
  if (needs.map) {
    LoadedStiffness map =
        loadStiffness(scene.material.map, {scene.material.quantity, scene.material.unit, {}}, progress);
    take(in, map);
    in.stiffness = std::move(map.map);
    clock.note(detail::StepId::ReadMap);
  }
  progress.report(1.0, "inputs read");
  return in;
}

}  // namespace glisson::pipeline

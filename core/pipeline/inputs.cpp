#include "pipeline/inputs.h"

#include "base/error.h"
#include "image/io.h"
#include "pipeline/detail/needs.h"
#include "pipeline/sources.h"

namespace glisson::pipeline {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& from) { to.insert(to.end(), from.begin(), from.end()); }

void loadPatient(const Scene& scene, const detail::Needs& needs, Inputs& in, const Progress& progress) {
  const GeometrySpec& g = scene.geometry;
  progress.report(0.0, "reading the MRI");
  AnatomicalImage mri = loadImage(g.mri, progress.part(0.0, 0.4));
  append(in.warnings, mri.warnings);
  progress.report(0.4, "reading the region of interest");
  LoadedRoi roi = loadRoi(g.roi, g.roiName, g.label, progress.part(0.4, 0.5));
  append(in.warnings, roi.warnings);
  if (roi.contours && !roi.contours->frameOfReferenceUid.empty() && !mri.frameOfReferenceUid.empty() &&
      roi.contours->frameOfReferenceUid != mri.frameOfReferenceUid)
    in.warnings.push_back("the contours and the MRI have different frames of reference: check that they belong together");
  const std::optional<std::string> completed = completeOutlines(roi, mri.volume.grid);
  if (completed) in.warnings.push_back(*completed);
  in.liver = roi.contours ? roi::rasterise(*roi.contours, mri.volume.grid) : *roi.mask;
  if (needs.mre) {
    progress.report(0.5, "reading the elastogram");
    LoadedStiffness mre = loadStiffness(g.mre, {}, progress.part(0.5, 0.9));
    append(in.warnings, mre.warnings);
    if (!mri.patientKey.empty() && !mre.patientKey.empty() && mri.patientKey != mre.patientKey)
      throw BadInput("the MRI and the elastogram belong to different patients; choose two series of one patient");
    if (!mri.frameOfReferenceUid.empty() && !mre.map.frameOfReferenceUid.empty() &&
        mri.frameOfReferenceUid != mre.map.frameOfReferenceUid)
      in.warnings.push_back("the MRI and the elastogram have different frames of reference: check that the patient did not move");
    in.roiOnMre = mapRoi(roi, mri.volume.grid, mre.map);
    for (const std::string& warning : in.roiOnMre->warnings)
      if (warning != completed) in.warnings.push_back(warning);
    in.stiffness = std::move(mre.map);
  }
  in.contours = std::move(roi.contours);
  if (needs.mriValues) in.mri = std::move(mri.volume);
}

}  // namespace

Inputs loadInputs(const Scene& scene, const Progress& progress) {
  const detail::Needs needs(scene);
  const GeometrySpec& g = scene.geometry;
  Inputs in;
  if (g.kind == GeometrySpec::Kind::Patient) loadPatient(scene, needs, in, progress);
  if (g.kind == GeometrySpec::Kind::Mask) {
    in.liver = image::readMask(g.file, g.label);
    if (needs.mriValues && !g.background.empty()) in.mri = loadImage(g.background, progress).volume;
  }
  if (needs.map) {
    LoadedStiffness map = loadStiffness(scene.material.map, {scene.material.quantity, scene.material.unit}, progress);
    in.stiffness = std::move(map.map);
  }
  progress.report(1.0, "inputs read");
  return in;
}

}  // namespace glisson::pipeline

#include "pipeline/inputs.h"

#include <chrono>

#include "base/error.h"
#include "image/io.h"
#include "pipeline/breath_hold.h"
#include "pipeline/detail/needs.h"
#include "pipeline/region_file.h"
#include "pipeline/sources.h"

namespace glisson::pipeline {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Notes the time since the last note under the name of a step.
class StepClock {
 public:
  explicit StepClock(Inputs& in) : in_(in) {}
  void note(const std::string& step) {
    const auto now = std::chrono::steady_clock::now();
    in_.seconds.emplace_back(step, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  Inputs& in_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void loadPatient(const Scene& scene, const detail::Needs& needs, Inputs& in, const Progress& progress) {
  const GeometrySpec& g = scene.geometry;
  StepClock clock(in);
  progress.report(0.0, "reading the MRI");
  AnatomicalImage mri = loadImage(g.mri, progress.part(0.0, 0.4), g.roles);
  if (mri.volume.grid.size.z() < 2)
    throw BadInput("the MRI has a single slice: statistics are possible, a 3-D model is not; give the whole series");
  append(in.warnings, mri.warnings);
  clock.note("read-mri");
  progress.report(0.4, "reading the region of interest");
  LoadedRoi roi = loadRoi(g.roi, g.roiName, g.label, progress.part(0.4, 0.5));
  append(in.warnings, roi.warnings);
  append(in.warnings, checkRoi(roi, &mri, nullptr, g.overrideChecks));
  const std::optional<std::string> completed = completeOutlines(roi, mri.volume.grid);
  if (completed) in.warnings.push_back(*completed);
  in.liver = roi.contours ? roi::rasterise(*roi.contours, mri.volume.grid) : *roi.mask;
  clock.note("read-roi");
  if (needs.mre) {
    progress.report(0.5, "reading the elastogram");
    LoadedStiffness mre = loadStiffness(g.mre, {g.mreQuantity, g.mreUnit, g.roles}, progress.part(0.5, 0.9));
    if (g.rigidRegistration) in.registration = fitToMri(mre, g.mre, {}, mri.volume, progress.part(0.9, 1.0));
    append(in.warnings, mre.warnings);
    append(in.warnings, checkTogether(mri, mre, g.overrideChecks));
    checkRolesFound(g.roles, {mri.rolesNotFound, mre.rolesNotFound});
    in.roiOnMre = mapRoi(roi, mri.volume.grid, mre.map);
    for (const std::string& warning : in.roiOnMre->warnings)
      if (warning != completed) in.warnings.push_back(warning);
    in.stiffness = std::move(mre.map);
    clock.note("read-mre");
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
  StepClock clock(in);
  if (g.kind == GeometrySpec::Kind::Mask) {
    in.liver = readRegion(g.file, g.label, surfaceCell_mm(g), in.warnings);
    clock.note("read-roi");
    if (needs.mriValues && !g.background.empty()) in.mri = loadImage(g.background, progress).volume;
    if (needs.mriValues) clock.note("read-mri");
  }
  if (needs.map) {
    LoadedStiffness map =
        loadStiffness(scene.material.map, {scene.material.quantity, scene.material.unit, {}}, progress);
    in.stiffness = std::move(map.map);
    clock.note("read-map");
  }
  progress.report(1.0, "inputs read");
  return in;
}

}  // namespace glisson::pipeline

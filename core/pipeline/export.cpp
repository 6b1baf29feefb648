// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/export.h"

#include <algorithm>

#include "base/error.h"
#include "pipeline/detail/export_case.h"

namespace glisson::pipeline {
namespace {

struct Exporter {
  const char* name;
  const char* gives;
  void (*write)(detail::ExportCase&);
};

constexpr Exporter exporters[] = {
    {"rtstruct", "DICOM RT Structure Set of the region of interest, on the MRI", detail::exportRtStruct},
    {"seg", "DICOM Segmentation of the region of interest, on the MRI", detail::exportSegmentation},
    {"pmap", "DICOM Parametric Map of the stiffness in kPa", detail::exportParametricMap},
    {"sr", "DICOM report (TID 1500) of the stiffness, with the segmentation it refers to", detail::exportReport},
    {"sc", "DICOM Secondary Captures of a run's pictures", detail::exportCaptures},
    {"contours", "contours as JSON", detail::exportContours},
    {"markups", "contours as 3D Slicer markups", detail::exportMarkups},
    {"nifti", "region of interest as NIfTI", detail::exportNifti},
    {"seg-nrrd", "region of interest as 3D Slicer segmentation", detail::exportSegNrrd},
    {"field", "displacement as 4-D NRRD", detail::exportField},
    {"vtu", "body and surface, at rest and deformed, with E_kPa and u_mm", detail::exportVtu},
    {"mtx", "K, M, supports and loads as Matrix Market", detail::exportMatrices},
    {"csv", "stiffness and displacement as a tidy table", detail::exportCsv},
    {"slicer", "a 3D Slicer scene with image, outline, surfaces and displacement", detail::exportSlicer},
    {"sofa", "a scene for SOFA", detail::exportSofa},
};

}  // namespace

std::vector<ExportFormat> exportFormats() {
  std::vector<ExportFormat> all;
  for (const Exporter& e : exporters) all.push_back({e.name, e.gives});
  return all;
}

Exported exportFiles(const ExportRequest& request, const Progress& progress) {
  std::vector<const Exporter*> wanted;
  for (const std::string& name : request.formats) {
    const auto* e =
        std::find_if(std::begin(exporters), std::end(exporters), [&](const Exporter& one) { return name == one.name; });
    if (e == std::end(exporters)) {
      std::string names;
      for (const Exporter& one : exporters) names += std::string(names.empty() ? "" : ", ") + one.name;
      throw BadInput("there is no format '" + name.substr(0, 40) + "'; there are " + names);
    }
    if (std::find(wanted.begin(), wanted.end(), e) == wanted.end()) wanted.push_back(e);
  }
  if (wanted.empty()) throw BadInput("no format was asked for");
  detail::ExportCase c(request, progress);
  for (const Exporter* e : wanted) {
    const std::size_t before = c.exported().files.size();
    try {
      e->write(c);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& refusal) {
      if (!request.leaveOutRefused) throw;
      c.exported().refused.push_back({e->name, refusal.what()});
      c.forgetFilesFrom(before);
    }
  }
  progress.report(1.0, "exported");
  return c.exported();
}

}  // namespace glisson::pipeline

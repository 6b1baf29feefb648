// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "dicom/series.h"
#include "pipeline/export.h"
#include "pipeline/run.h"
#include "pipeline/scene.h"
#include "pipeline/sources.h"

namespace glisson::pipeline::detail {

/// What exporters need of a scene, made when first asked for and kept.
class ExportCase {
 public:
  ExportCase(const ExportRequest& request, const Progress& progress);

  const ExportRequest& request() const { return request_; }
  const Scene& scene() const { return scene_; }
  /// Empty where a scene file was given.
  const std::filesystem::path& runFolder() const { return runFolder_; }

  /// The anatomical and the stiffness series. Throw BadInput where the scene has no DICOM for them.
  const dicom::Series& mri();
  const dicom::Series& mre();
  /// Elastogram with the quantity that was asked for.
  const elastography::StiffnessMap& stiffness();
  /// The region of interest as polygons; traced where it came as voxels.
  const roi::ContourStack& contours();
  /// The region of interest on the grid of the MRI, on its own or the body's where there is no MRI.
  const image::Mask& liver();
  /// The region of interest on the elastogram.
  const image::Mask& liverOnMre();
  /// The scene, solved.
  const RunResult& result();

  /// A file of that name in the output folder, noted as written.
  std::filesystem::path file(const std::string& name);
  void note(const std::vector<std::filesystem::path>& files);
  /// Of a format that ended half way: its files, but those noted before it, are removed.
  void forgetFilesFrom(std::size_t first);
  void warn(const std::string& text);
  void warn(const Diagnostics& said);
  Exported& exported() { return exported_; }

  const LoadedRoi& roi();  ///< the region of interest, read once

 private:
  const dicom::Series& series(const std::filesystem::path& path, dicom::SeriesRole role, const char* what,
                              std::optional<dicom::Series>& kept);

  ExportRequest request_;
  Progress progress_;
  Scene scene_;
  std::filesystem::path runFolder_;
  std::optional<dicom::Series> mri_, mre_;
  std::optional<elastography::StiffnessMap> stiffness_;
  std::optional<LoadedRoi> roi_;
  std::optional<roi::ContourStack> contours_;
  std::optional<image::Mask> liver_, liverOnMre_;
  std::optional<image::Grid> mriGrid_;
  std::shared_ptr<const RunResult> result_;
  Exported exported_;
};

// One function per format.
void exportRtStruct(ExportCase& c);
void exportSegmentation(ExportCase& c);
void exportParametricMap(ExportCase& c);
void exportReport(ExportCase& c);
void exportCaptures(ExportCase& c);
void exportContours(ExportCase& c);
void exportMarkups(ExportCase& c);
void exportNifti(ExportCase& c);
void exportSegNrrd(ExportCase& c);
void exportField(ExportCase& c);
void exportVtu(ExportCase& c);
void exportMatrices(ExportCase& c);
void exportCsv(ExportCase& c);
void exportSlicer(ExportCase& c);
void exportSofa(ExportCase& c);

}  // namespace glisson::pipeline::detail

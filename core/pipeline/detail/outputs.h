// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/vessels.h"
#include "pipeline/picture_file.h"
#include "pipeline/run.h"

namespace glisson::pipeline::detail {

/// Everything the overlays draw, with displacements continued around the body.
render::RetractionScene retractionScene(const Scene& scene, const Inputs& inputs, const image::Mask& cells,
                                        const RunResult& result, const anatomy::VesselModel& vessels);

/// What the pictures show of a rigid bar; nothing without one. liver: the surface where the body has no smooth one.
std::optional<render::RigidBar> drawnBar(const RunResult& result, const anatomy::TriangleMesh& liver);

/// What the pictures show of how sure the run is; nothing where it does not say.
std::optional<render::HowSure> howSureOf(const RunResult& result, const anatomy::VesselModel& vessels);

/// Writes the files of one run into a folder, each written beside and then renamed; notes what was written.
class Writer {
 public:
  /// Makes the folder. Throws BadInput where it cannot.
  Writer(std::filesystem::path folder, std::vector<std::filesystem::path>& files);

  void text(const std::string& name, const std::string& content);
  void displacementFields(const RunResult& r);
  void vessels(const Scene& scene, const RunResult& r, const anatomy::VesselModel& vessels);
  void stiffness(const elastography::Measurement& m);
  PictureData pictureData(const RunResult& r) const;
  void pictureFile(const PictureData& data);
  void sliceOverlays(const PictureData& data, render::Palette palette);
  void charts(const PictureData& data);
  void overlays3D(const PictureData& data, render::Palette palette);
  void howSure(const PictureData& data, Language language);
  void howSure3D(const PictureData& data, render::Palette palette, Language language);
  /// inputs: name and SHA-256 of each input, for the manifest.
  /// palette: of the pictures, which the report names; language: of the sentence for surgeons.
  void report(const Scene& scene, const RunResult& r, const std::vector<std::pair<std::string, std::string>>& inputs,
              render::Palette palette, Language language);

 private:
  std::filesystem::path note(const std::string& name);

  std::filesystem::path folder_;
  std::vector<std::filesystem::path>& files_;
};

}  // namespace glisson::pipeline::detail

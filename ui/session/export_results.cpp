// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export_results.h"

#include <algorithm>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "pipeline/write_again.h"
#include "render/colour_map.h"

namespace glisson::session {

namespace {

constexpr double voxel_mm = 1.64;  // of the paper's MRI

Eigen::Vector3d nearest(const image::DisplacementField& u_mm, const Eigen::Vector3d& p_lps) {
  const Eigen::Vector3i at = u_mm.grid.lpsToIndex(p_lps).array().round().cast<int>();
  return u_mm.grid.contains(at) ? Eigen::Vector3d(u_mm.at(at).cast<double>()) : Eigen::Vector3d::Zero();
}

}  // namespace

std::vector<VesselPlace> vesselsBeyond(const pipeline::RunResult& result, const render::RetractionScene& picture) {
  std::vector<VesselPlace> places;
  if (!result.difference) return places;
  const std::vector<double>& apart = result.difference->vessel_mm;
  for (std::size_t n = 0; n < std::min(apart.size(), result.landmarks_mm.size()); ++n) {
    if (!(apart[n] >= picture.clinicallySignificant_mm)) continue;
    const Eigen::Vector3d& p = result.landmarks_mm[n];
    places.push_back({apart[n], p, p + 0.5 * (nearest(picture.u_mre_mm, p) + nearest(picture.u_atlas_mm, p))});
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.apart_mm > b.apart_mm; });
  return places;
}

render::BoxPlot differenceBoxes(const pipeline::RunResult& result, const render::RetractionScene& picture) {
  if (!result.difference || !result.atlas) throw BadArgument("the run compares with no atlas: there is no difference");
  render::BoxPlot plot;
  plot.title = "MRE against atlas";
  plot.y.title = "Displacement difference (mm)";
  const image::Grid& grid = result.model.youngs_kPa.grid;
  render::BoxPlot::Box liver{"whole liver", {}};
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        if (result.model.youngs_kPa.at(i, j, k) > 0.0F)
          liver.values.push_back((result.primary.u_mm.at(i, j, k) - result.atlas->u_mm.at(i, j, k)).norm());
  plot.boxes.push_back(std::move(liver));
  if (!result.difference->vessel_mm.empty()) plot.boxes.push_back({"vessels", result.difference->vessel_mm});
  plot.lines = {{voxel_mm, "1.64 mm: one MRI voxel", render::colours::magenta},
                {picture.clinicallySignificant_mm, "5 mm: clinically significant", render::colours::orange}};
  plot.caption = picture.caption;
  return plot;
}

std::vector<std::filesystem::path> exportResults(const pipeline::RunResult& result,
                                                 const render::RetractionScene& picture, render::Palette palette,
                                                 const std::filesystem::path& runFolder,
                                                 const std::filesystem::path& folder, const Progress& progress) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (!std::filesystem::is_directory(folder))
    throw BadInput("cannot make the folder for the pictures; choose a place that can be written to");
  std::vector<std::filesystem::path> files;
  try {
    progress.report(0.0, "charts");
    if (result.difference && result.atlas) {
      const render::BoxPlot plot = differenceBoxes(result, picture);
      files.push_back(folder / "difference-boxes.png");
      render::writePng(files.back(), render::draw(plot));
      files.push_back(folder / "difference-boxes.svg");
      writeAtomically(files.back(), render::svg(plot));
    }
    pipeline::writeAgain(result, {runFolder, folder, palette, files}, files, progress);
  } catch (...) {
    // Half an export would pass for a whole one.
    for (const auto& file : files) {
      std::filesystem::remove(file, failed);
      if (file.parent_path() != folder) std::filesystem::remove(file.parent_path(), failed);  // where it is empty
    }
    throw;
  }
  return files;
}

}  // namespace glisson::session

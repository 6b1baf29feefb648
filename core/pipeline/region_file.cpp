// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/region_file.h"

#include <cmath>
#include <set>
#include <sstream>

#include "anatomy/surface_file.h"
#include "anatomy/voxelise.h"
#include "base/error.h"
#include "base/quantity.h"
#include "image/io.h"
#include "image/morphology.h"

namespace glisson::pipeline {
namespace {

/// No liver, nor a lobe of one that is worth a model, is smaller or larger: the unit of the coordinates is then
/// another.
constexpr double leastLiver_mL = 20.0, mostLiver_mL = 10'000.0;

}  // namespace

bool isRegionFile(const std::filesystem::path& path) {
  return image::isVolumeFile(path) || anatomy::isSurfaceFile(path);
}

std::string severalLabels(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path) || !image::isVolumeFile(path)) return {};
  const image::LabelMap map = image::readLabelMap(path);
  std::set<std::int32_t> labels(map.values.begin(), map.values.end());
  labels.erase(0);
  if (labels.size() < 2) return {};
  constexpr int most = 20;
  std::string text;
  int shown = 0;
  for (const std::int32_t label : labels) {
    if (++shown > most) return text + " ... (" + std::to_string(labels.size()) + " in all)";
    text += (text.empty() ? "" : " ") + std::to_string(label);
  }
  return text;
}

image::Mask readRegion(const std::filesystem::path& path, int label, std::optional<Eigen::Vector3d> cell_mm,
                       std::vector<std::string>& warnings, Diagnostics* diagnostics) {
  const auto tell = [&](const Diagnostics& doubts) {
    for (const std::string& text : doubts.texts(Severity::Warning)) warnings.push_back(text);
    if (diagnostics != nullptr) diagnostics->add(doubts);
  };
  if (!anatomy::isSurfaceFile(path)) {
    if (const std::string labels = label == 0 ? severalLabels(path) : std::string(); !labels.empty())
      warnings.push_back("the mask holds the labels " + labels + ": they were taken together, because none was chosen");
    Diagnostics doubts;
    image::Mask mask = image::readMask(path, label, &doubts);
    tell(doubts);
    return mask;
  }
  const anatomy::SurfaceFile file = anatomy::readSurface(path);
  const std::string name = "'" + path.filename().string() + "'";
  if (!file.closed)
    throw BadInput("the surface " + name +
                   " is not closed, so it has no inside: close its holes, keep one shell of triangles, and turn them "
                   "all the same way round");
  for (const std::string& w : file.warnings) warnings.push_back("the surface: " + w);
  if (label != 0) warnings.push_back("a label picks a value of a mask; this is a surface: it was not used");
  Diagnostics doubts;
  image::Mask mask = anatomy::voxelise(file.mesh, anatomy::gridAround(file.mesh, cell_mm), &doubts);
  constexpr double mm3PerMillilitre = 1000.0;
  const double filled_mL = static_cast<double>(image::count(mask)) * mask.grid.voxelVolume_mm3() / mm3PerMillilitre;
  if (filled_mL < 1.0) {
    // Of a surface smaller than a cell no voxel is left to say how small.
    const double mL = filled_mL > 0.0 ? filled_mL : std::abs(anatomy::volume_mm3(file.mesh)) / mm3PerMillilitre;
    std::ostringstream size;
    size.precision(3);
    size << mL;
    throw BadInput("the surface " + name + " holds " + size.str() +
                   " mL if its coordinates are millimetres; scale it to millimetres");
  }
  if (filled_mL < leastLiver_mL || filled_mL > mostLiver_mL) {
    const Eigen::Vector3d extent_mm =
        file.mesh.vertices_lps_mm.rowwise().maxCoeff() - file.mesh.vertices_lps_mm.rowwise().minCoeff();
    doubts.add(DiagnosticCode::SurfaceSizeOdd, {{"mL", filled_mL}, {"longest_mm", extent_mm.maxCoeff()}});
  }
  tell(doubts);
  return mask;
}

Eigen::Vector3d surfaceCell_mm(const GeometrySpec& geometry) {
  if (geometry.cell_mm.x() > 0) return geometry.cell_mm;
  return Eigen::Vector3d::Constant(2.0 * defaults::mriVoxel.mm());
}

}  // namespace glisson::pipeline

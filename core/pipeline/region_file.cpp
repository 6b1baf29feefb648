#include "pipeline/region_file.h"

#include <set>
#include <sstream>

#include "anatomy/surface_file.h"
#include "anatomy/voxelise.h"
#include "base/error.h"
#include "base/quantity.h"
#include "image/io.h"

namespace glisson::pipeline {

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
                       std::vector<std::string>& warnings) {
  if (!anatomy::isSurfaceFile(path)) {
    if (const std::string labels = label == 0 ? severalLabels(path) : std::string(); !labels.empty())
      warnings.push_back("the mask holds the labels " + labels + ": they were taken together, because none was chosen");
    return image::readMask(path, label);
  }
  const anatomy::SurfaceFile file = anatomy::readSurface(path);
  const std::string name = "'" + path.filename().string() + "'";
  if (!file.closed)
    throw BadInput("the surface " + name +
                   " is not closed, so it has no inside: close its holes, keep one shell of triangles, and turn them "
                   "all the same way round");
  constexpr double mm3PerMillilitre = 1000.0;
  const double mL = anatomy::volume_mm3(file.mesh) / mm3PerMillilitre;
  std::ostringstream size;
  size.precision(3);
  size << mL;
  if (mL < 1.0)
    throw BadInput("the surface " + name + " holds " + size.str() +
                   " mL if its coordinates are millimetres; scale it to millimetres");
  for (const std::string& w : file.warnings) warnings.push_back("the surface: " + w);
  if (label != 0) warnings.push_back("a label picks a value of a mask; this is a surface: it was not used");
  return anatomy::voxelise(file.mesh, anatomy::gridAround(file.mesh, cell_mm));
}

Eigen::Vector3d surfaceCell_mm(const GeometrySpec& geometry) {
  if (geometry.cell_mm.x() > 0) return geometry.cell_mm;
  return Eigen::Vector3d::Constant(2.0 * defaults::mriVoxel.mm());
}

}  // namespace glisson::pipeline

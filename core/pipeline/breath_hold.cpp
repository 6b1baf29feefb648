#include "pipeline/breath_hold.h"

#include "base/error.h"
#include "dicom/series.h"
#include "image/io.h"

namespace glisson::pipeline {
namespace {

image::ScalarVolume magnitudeOf(const std::filesystem::path& path, const Progress& progress) {
  if (std::filesystem::is_regular_file(path) && image::isVolumeFile(path)) return image::readVolume(path);
  const dicom::ScanResult scan = dicom::scan(path, progress);
  for (const dicom::Series& s : scan.series)
    if (s.role == dicom::SeriesRole::Magnitude && !s.error) return dicom::readSeries(s, progress);
  throw BadInput("a breath-hold correction needs the magnitude images of the elastography acquisition, which '" +
                 path.filename().string() + "' does not hold; give them, or leave the correction out");
}

}  // namespace

elastography::Registration fitToMri(LoadedStiffness& mre, const std::filesystem::path& mrePath,
                                    const std::filesystem::path& magnitude, const image::ScalarVolume& mri,
                                    const Progress& progress) {
  if (magnitude.empty() && std::filesystem::is_regular_file(mrePath) && image::isVolumeFile(mrePath))
    throw BadInput("a bare map has no magnitude image to lay over the MRI; give it");
  const image::ScalarVolume moving = magnitudeOf(magnitude.empty() ? mrePath : magnitude, progress.part(0.0, 0.3));
  elastography::Registration r = elastography::registerRigid(mri, moving, {}, progress.part(0.3, 1.0));
  mre.map.values_kPa.grid = elastography::moved(mre.map.values_kPa.grid, r.X_fixed_moving);
  if (mre.map.confidence) mre.map.confidence->grid = elastography::moved(mre.map.confidence->grid, r.X_fixed_moving);
  mre.warnings.push_back(elastography::describe(r));
  return r;
}

}  // namespace glisson::pipeline

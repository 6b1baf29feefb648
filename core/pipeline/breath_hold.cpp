// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/breath_hold.h"

#include "base/error.h"
#include "dicom/series.h"
#include "image/io.h"

namespace glisson::pipeline {
namespace {

/// The magnitude images of a path of their own: the only ones there.
image::ScalarVolume magnitudeOf(const std::filesystem::path& path, const Progress& progress) {
  if (std::filesystem::is_regular_file(path) && image::isVolumeFile(path)) return image::readVolume(path);
  const dicom::ScanResult scan = dicom::scan(path, progress);
  const dicom::Series* found = nullptr;
  for (const dicom::Series& s : scan.series) {
    if (s.role != dicom::SeriesRole::Magnitude || s.error) continue;
    if (found != nullptr && found->number != s.number)
      throw BadInput("'" + path.filename().string() + "' holds the magnitude images of several series (" +
                     std::to_string(found->number) + ", " + std::to_string(s.number) +
                     "); give the folder of the ones that belong to the elastogram");
    if (found == nullptr) found = &s;
  }
  if (found != nullptr) return dicom::readSeries(*found, progress);
  throw BadInput("a breath-hold correction needs the magnitude images of the elastography acquisition, which '" +
                 path.filename().string() + "' does not hold; give them, or leave the correction out");
}

/// Those of the acquisition that the stiffness is of.
image::ScalarVolume magnitudeOf(const LoadedStiffness& mre, const std::filesystem::path& path,
                                const Progress& progress) {
  if (!mre.scan) return magnitudeOf(path, progress);
  const int magnitude = mre.acquisition.magnitude;
  if (magnitude < 0)
    throw BadInput(
        "a breath-hold correction needs the magnitude images of the same acquisition as the stiffness, which '" +
        path.filename().string() +
        "' does not hold; name them with --role <series>=magnitude, give them with --magnitude, or leave the "
        "correction out");
  return dicom::readSeries(mre.scan->series[static_cast<std::size_t>(magnitude)], progress);
}

}  // namespace

elastography::Registration fitToMri(LoadedStiffness& mre, const std::filesystem::path& mrePath,
                                    const std::filesystem::path& magnitude, const image::ScalarVolume& mri,
                                    const Progress& progress) {
  if (magnitude.empty() && std::filesystem::is_regular_file(mrePath) && image::isVolumeFile(mrePath))
    throw BadInput("a bare map has no magnitude image to lay over the MRI; give it");
  const image::ScalarVolume moving = magnitude.empty() ? magnitudeOf(mre, mrePath, progress.part(0.0, 0.3))
                                                       : magnitudeOf(magnitude, progress.part(0.0, 0.3));
  elastography::Registration r = elastography::registerRigid(mri, moving, {}, progress.part(0.3, 1.0));
  mre.map.values_kPa.grid = elastography::moved(mre.map.values_kPa.grid, r.X_fixed_moving);
  if (mre.map.confidence) mre.map.confidence->grid = elastography::moved(mre.map.confidence->grid, r.X_fixed_moving);
  if (mre.map.noConfidence)
    mre.map.noConfidence->grid = elastography::moved(mre.map.noConfidence->grid, r.X_fixed_moving);
  mre.warnings.push_back(elastography::describe(r));
  return r;
}

}  // namespace glisson::pipeline

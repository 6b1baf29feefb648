// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/volume_files.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "base/error.h"
#include "dicom/product_words.h"
#include "image/io.h"
#include "pipeline/sources.h"
#include "session/session.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;

constexpr const char* uidBegins = "file:";

/// The name without ".nii.gz" and the like, words parted by spaces.
std::string wordsOf(std::string name) {
  name = name.substr(0, name.find('.', 1));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '_' || c == '-'; }, ' ');
  return name;
}

/// Different values, where there are at most this many and all are whole numbers of 0 or more; else empty.
std::set<float> labelsOf(const image::ScalarVolume& volume, std::size_t atMost) {
  std::set<float> found;
  for (const float v : volume.values) {
    if (!(v >= 0.0F) || v != std::floor(v)) return {};
    found.insert(v);
    if (found.size() > atMost) return {};
  }
  return found;
}

dicom::Series seriesOf(const fs::path& file, const image::Grid& grid, const Diagnostics& doubts) {
  dicom::Series s;
  s.uid = uidBegins + file.filename().string();
  std::replace(s.uid.begin(), s.uid.end(), '#', '_');  // which parts the volumes of one DICOM series
  s.description = file.filename().string();
  s.files = {file};
  s.grid = grid;
  s.diagnostics = doubts;
  s.warnings = doubts.texts(Severity::Warning);
  return s;
}

/// What the volume files are for, where nobody has said so.
void guessRoles(std::vector<dicom::Series*>& volumes, const std::vector<VolumeLook>& looks, bool besideDicom) {
  using dicom::SeriesRole;
  const bool onlyMasks = std::all_of(looks.begin(), looks.end(), [](VolumeLook l) { return l == VolumeLook::Mask; });
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    dicom::Series& s = *volumes[i];
    QString why;
    switch (looks[i]) {
      case VolumeLook::Mask:
        s.role = onlyMasks && i == 0 && !besideDicom ? SeriesRole::Anatomical : SeriesRole::Other;
        why = s.role == SeriesRole::Other ? Session::tr("a mask: its outlines are offered below")
                                          : Session::tr("a mask, and no image beside it: it is its own picture");
        break;
      case VolumeLook::Stiffness:
        s.role = besideDicom ? SeriesRole::Other : SeriesRole::Stiffness;
        why = Session::tr("the file's name speaks of stiffness");
        break;
      case VolumeLook::Image:
        s.role = besideDicom ? SeriesRole::Other : SeriesRole::Anatomical;
        why = Session::tr("a volume file, taken for an image");
        break;
    }
    if (besideDicom && looks[i] != VolumeLook::Mask)
      why += Session::tr("; beside DICOM series it is used where you give it a role");
    s.roleReason = why.toStdString();
  }
}

}  // namespace

VolumeLook lookOf(const std::string& name, const image::ScalarVolume& volume) {
  constexpr std::size_t mostLabels = 16;
  const std::set<float> labels = labelsOf(volume, mostLabels);
  if (labels.size() > 1 && labels.contains(0.0F)) return VolumeLook::Mask;
  const auto product = dicom::productNamed(wordsOf(name), true);
  return product && product->role == dicom::SeriesRole::Stiffness ? VolumeLook::Stiffness : VolumeLook::Image;
}

bool isVolume(const dicom::Series& series) {
  return series.uid.rfind(uidBegins, 0) == 0;
}

dicom::RoleOverrides dicomRoles(const dicom::RoleOverrides& roles) {
  dicom::RoleOverrides of = roles;
  std::erase_if(of, [](const auto& given) { return given.first.rfind(uidBegins, 0) == 0; });
  return of;
}

void addVolumes(dicom::ScanResult& scan, const Progress& progress) {
  std::vector<dicom::SkippedFile> left;
  std::vector<dicom::Series> volumes;
  std::vector<VolumeLook> looks;
  const auto n = static_cast<double>(std::max<std::size_t>(1, scan.skipped.size()));
  for (std::size_t i = 0; i < scan.skipped.size(); ++i) {
    dicom::SkippedFile& skipped = scan.skipped[i];
    progress.report(static_cast<double>(i) / n, "looking at volume files");
    if (!image::isVolumeFile(skipped.file)) {
      left.push_back(std::move(skipped));
      continue;
    }
    try {
      Diagnostics doubts;
      const image::ScalarVolume volume = image::readVolume(skipped.file, &doubts);
      looks.push_back(lookOf(skipped.file.filename().string(), volume));
      volumes.push_back(seriesOf(skipped.file, volume.grid, doubts));
    } catch (const BadInput& e) {
      left.push_back({skipped.file, e.what()});
    }
  }
  const std::size_t dicomSeries = scan.series.size();
  scan.skipped = std::move(left);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    volumes[i].number = static_cast<int>(i) + 1;
    scan.series.push_back(std::move(volumes[i]));
  }
  std::vector<dicom::Series*> added;
  for (std::size_t i = dicomSeries; i < scan.series.size(); ++i) added.push_back(&scan.series[i]);
  guessRoles(added, looks, dicomSeries > 0);
}

dicom::ScanResult scanAll(const fs::path& path, const std::vector<std::string>& only, const Progress& progress) {
  dicom::ScanResult all;
  const Progress looking = progress.part(0.0, 0.7);
  if (only.empty()) {
    all = dicom::scan(path, looking);
  } else {
    const auto n = static_cast<double>(only.size());
    for (std::size_t i = 0; i < only.size(); ++i) {
      dicom::ScanResult one =
          dicom::scan(path / only[i], looking.part(static_cast<double>(i) / n, static_cast<double>(i + 1) / n));
      std::move(one.series.begin(), one.series.end(), std::back_inserter(all.series));
      std::move(one.skipped.begin(), one.skipped.end(), std::back_inserter(all.skipped));
    }
  }
  addVolumes(all, progress.part(0.7, 1.0));
  return all;
}

std::pair<fs::path, std::vector<std::string>> commonFolder(const std::vector<fs::path>& paths) {
  if (paths.size() == 1) return {paths.front(), {}};
  fs::path common = paths.front().parent_path();
  const auto holds = [&common](const fs::path& path) {
    const std::string from = path.lexically_relative(common).string();
    return !from.empty() && from.rfind("..", 0) != 0;
  };
  while (!std::all_of(paths.begin(), paths.end(), holds) && common.has_relative_path()) common = common.parent_path();
  std::vector<std::string> names;
  for (const fs::path& path : paths) names.push_back(path.lexically_relative(common).string());
  return {common, names};
}

image::ScalarVolume readImage(const dicom::Series& series, const Progress& progress) {
  return isVolume(series) ? pipeline::loadImage(series.files.front(), progress).volume
                          : dicom::readSeries(series, progress);
}

dicom::Thumbnail smallPicture(const dicom::Series& series, int size_px) {
  if (!isVolume(series)) return dicom::thumbnail(series, size_px);
  dicom::Thumbnail picture;
  image::ScalarVolume volume;
  try {
    volume = readImage(series);
  } catch (const BadInput& e) {
    picture.whyNone = e.what();
    return picture;
  }
  const image::Grid& grid = volume.grid;
  const int k = (grid.size.z() - 1) / 2;
  const Eigen::Vector2d extent_mm = grid.spacing_mm.head<2>().cwiseProduct(grid.size.head<2>().cast<double>());
  const Eigen::Vector2d shown = extent_mm * (size_px / extent_mm.maxCoeff());
  picture.width = std::max(1, static_cast<int>(std::lround(shown.x())));
  picture.height = std::max(1, static_cast<int>(std::lround(shown.y())));
  // Rows go down the patient's back, as in a slice view.
  const bool flipX = grid.direction.col(0).sum() < 0.0, flipY = grid.direction.col(1).sum() < 0.0;
  std::vector<float> values;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      int i = std::min(x * grid.size.x() / picture.width, grid.size.x() - 1);
      int j = std::min(y * grid.size.y() / picture.height, grid.size.y() - 1);
      if (flipX) i = grid.size.x() - 1 - i;
      if (flipY) j = grid.size.y() - 1 - j;
      const float v = volume.at(i, j, k);
      values.push_back(std::isfinite(v) ? v : 0.0F);
    }
  std::vector<float> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const float low = sorted[sorted.size() / 100], high = sorted[sorted.size() - 1 - sorted.size() / 100];
  const float range = high > low ? high - low : 1.0F;
  for (const float v : values)
    picture.grey.push_back(static_cast<std::uint8_t>(std::clamp(255.0F * (v - low) / range, 0.0F, 255.0F)));
  return picture;
}

}  // namespace glisson::session

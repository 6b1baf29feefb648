// Opening: scan, roles, volumes.
#include <QDir>
#include <QStandardPaths>
#include <algorithm>

#include "base/error.h"
#include "phantom/phantom.h"
#include "session/session.h"

namespace glisson::session {

namespace {

bool below(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return file.string().rfind((folder / "").string(), 0) == 0;
}

int indexOf(const dicom::ScanResult& scan, dicom::SeriesRole role) {
  try {
    const dicom::Series& found = dicom::findRole(scan, role);
    return static_cast<int>(&found - scan.series.data());
  } catch (const BadInput&) {
    return -1;
  }
}

std::filesystem::path commonFolder(const dicom::Series& series) {
  std::filesystem::path common = series.files.front().parent_path();
  for (const std::filesystem::path& file : series.files)
    while (!below(file, common) && common.has_relative_path()) common = common.parent_path();
  return common;
}

/// Whether a reader of this folder alone would take the series by its role.
bool findsIt(const dicom::ScanResult& guessed, const std::filesystem::path& folder, dicom::SeriesRole role,
             const std::string& uid) {
  dicom::ScanResult there;
  for (const dicom::Series& s : guessed.series)
    if (!s.files.empty() && below(s.files.front(), folder)) there.series.push_back(s);
  const int found = indexOf(there, role);
  return found >= 0 && there.series[static_cast<std::size_t>(found)].uid == uid;
}

struct Opened {
  std::filesystem::path path;
  dicom::ScanResult scan;
  OpenImages images;
  std::string failure;  // images could not be read; the scan is shown all the same
};

}  // namespace

OpenImages readImages(const dicom::ScanResult& scan, const dicom::ScanResult& guessed,
                      const std::filesystem::path& root, const Progress& progress) {
  OpenImages images;
  images.mriSeries = indexOf(scan, dicom::SeriesRole::Anatomical);
  if (images.mriSeries < 0) images.mriSeries = indexOf(scan, dicom::SeriesRole::Magnitude);
  images.stiffnessSeries = indexOf(scan, dicom::SeriesRole::Stiffness);
  images.confidenceSeries = indexOf(scan, dicom::SeriesRole::Confidence);
  if (images.mriSeries < 0)
    throw BadInput("no anatomical or magnitude MR series was found; give a series that role in the table");
  const auto series = [&scan](int i) -> const dicom::Series& { return scan.series[static_cast<std::size_t>(i)]; };
  progress.report(0.0, "reading MRI");
  images.mri =
      std::make_shared<image::ScalarVolume>(dicom::readSeries(series(images.mriSeries), progress.part(0.0, 0.6)));
  // From the folder of the series up to the one that was opened: the first that means these series and no others.
  const auto outwards = [&root](std::filesystem::path folder, const auto& right) -> std::filesystem::path {
    for (;; folder = folder.parent_path()) {
      if (right(folder)) return folder;
      if (!below(folder, root)) return {};
    }
  };
  images.mriSource = outwards(commonFolder(series(images.mriSeries)), [&](const std::filesystem::path& folder) {
    return findsIt(guessed, folder, dicom::SeriesRole::Anatomical, series(images.mriSeries).uid);
  });
  if (images.stiffnessSeries < 0) {
    images.note = QStringLiteral("No stiffness series was found: outlines can be drawn, stiffness cannot be measured.");
    return images;
  }
  progress.report(0.6, "reading elastogram");
  const dicom::Series& stiffness = series(images.stiffnessSeries);
  elastography::StiffnessMap map = elastography::makeStiffnessMap(
      dicom::readSeries(stiffness, progress.part(0.6, 0.85)), StiffnessQuantity::Shear, stiffness.unit.value_or("kPa"));
  map.frameOfReferenceUid = stiffness.frameOfReferenceUid;
  if (images.confidenceSeries >= 0)
    elastography::attachConfidence(map, dicom::readSeries(series(images.confidenceSeries), progress.part(0.85, 1.0)));
  else
    images.note = QStringLiteral("No confidence map was found: every voxel with a stiffness counts.");
  images.mreSource = outwards(commonFolder(stiffness), [&](const std::filesystem::path& folder) {
    return findsIt(guessed, folder, dicom::SeriesRole::Stiffness, stiffness.uid) &&
           (images.confidenceSeries < 0 ||
            findsIt(guessed, folder, dicom::SeriesRole::Confidence, series(images.confidenceSeries).uid));
  });
  images.stiffness = std::make_shared<elastography::StiffnessMap>(std::move(map));
  if (series(images.mriSeries).frameOfReferenceUid != stiffness.frameOfReferenceUid)
    images.note +=
        QStringLiteral(" MRI and MRE name different frames of reference: check that they lie on each other.");
  return images;
}

void Session::openPath(const QString& path) {
  std::error_code unknown;
  const std::filesystem::path folder =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path.toStdString(), unknown), unknown);
  startLoad([folder](const Progress&) { return folder; }, tr("Opening"));
}

void Session::openSynthetic(std::uint64_t seed, const QString& folder) {
  const QString base = folder.isEmpty() ? QStandardPaths::writableLocation(QStandardPaths::CacheLocation) : folder;
  const std::filesystem::path target =
      (base + QStringLiteral("/synthetic-patient-%1").arg(static_cast<qulonglong>(seed))).toStdString();
  startLoad(
      [target, seed](const Progress& progress) {
        // truth.json is written last: its presence means the patient is complete.
        if (!std::filesystem::exists(target / "truth.json")) {
          progress.report(0.0, "making a synthetic patient");
          phantom::PhantomOptions options;
          phantom::writePhantom(phantom::makePhantom(seed, options, progress.part(0.0, 0.9)), target);
        }
        return target;
      },
      tr("Opening the synthetic patient"));
}

void Session::startLoad(std::function<std::filesystem::path(const Progress&)> prepare, const QString& what) {
  if (worker_.busy()) {
    emit message(tr("Still at work; cancel it first."));
    return;
  }
  auto opened = std::make_shared<Opened>();
  work_ = Work::Load;
  worker_.start(
      [opened, prepare](const Progress& progress) {
        opened->path = prepare(progress.part(0.0, 0.5));
        opened->scan = dicom::scan(opened->path, progress.part(0.5, 0.7));
        try {
          opened->images = readImages(opened->scan, opened->scan, opened->path, progress.part(0.7, 1.0));
        } catch (const BadInput& e) {
          opened->failure = e.what();
        }
      },
      [this, opened](std::exception_ptr failure) {
        if (!failure) {
          path_ = QString::fromStdString(opened->path.string());
          scan_ = std::move(opened->scan);
          guessed_ = scan_;
          images_ = std::move(opened->images);
          contours_ = {};
          if (images_.mriSeries >= 0 && images_.mri) {
            const dicom::Series& mri = scan_.series[static_cast<std::size_t>(images_.mriSeries)];
            contours_.frameOfReferenceUid = mri.frameOfReferenceUid;
            contours_.seriesUid = mri.uid;
          }
          undo_.clear();
          tool_.contoursChanged();
          plane_.reset();
          result_.reset();
          picture_.reset();
          failure_ = {};
          ++revision_;
          modified_ = false;
        }
        ended(Work::Load, failure);
        if (failure) return;
        if (!opened->failure.empty())
          failure_[static_cast<std::size_t>(Step::Load)] = QString::fromStdString(opened->failure);
        emit loaded();
        emit contoursChanged();
        emit statusChanged();
        if (!images_.note.isEmpty()) emit message(images_.note);
        measure();
      });
  emit workStarted(what);
  emit statusChanged();
}

void Session::setRole(int index, dicom::SeriesRole role) {
  if (worker_.busy() || index < 0 || index >= static_cast<int>(scan_.series.size())) return;
  dicom::Series& series = scan_.series[static_cast<std::size_t>(index)];
  if (series.role == role) return;
  // One series has the role: whoever had it before becomes "other".
  if (role != dicom::SeriesRole::Other)
    for (dicom::Series& other : scan_.series)
      if (other.role == role) {
        other.role = dicom::SeriesRole::Other;
        other.roleReason = "another series was given this role by hand";
      }
  series.role = role;
  series.roleReason = "set by hand";
  auto images = std::make_shared<OpenImages>();
  work_ = Work::Load;
  worker_.start([images, scan = scan_, guessed = guessed_, root = std::filesystem::path(path_.toStdString())](
                    const Progress& progress) { *images = readImages(scan, guessed, root, progress); },
                [this, images](std::exception_ptr failure) {
                  images_ = failure ? OpenImages{} : std::move(*images);
                  ++revision_;
                  ended(Work::Load, failure);
                  emit loaded();
                  measure();
                });
  emit workStarted(tr("Reading images"));
  emit statusChanged();
}

}  // namespace glisson::session

// Opening: scan, roles, volumes.
#include <QDir>
#include <QStandardPaths>
#include <algorithm>

#include "base/error.h"
#include "phantom/phantom.h"
#include "pipeline/case_folder.h"
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

/// Time steps of the wave: the volumes that follow each other in one series.
std::vector<std::shared_ptr<const image::ScalarVolume>> readWave(const dicom::ScanResult& scan,
                                                                 const Progress& progress) {
  const int first = indexOf(scan, dicom::SeriesRole::Wave);
  if (first < 0) return {};
  const auto stem = [](const std::string& uid) { return uid.substr(0, uid.find('#')); };
  const std::string uid = stem(scan.series[static_cast<std::size_t>(first)].uid);
  std::vector<const dicom::Series*> steps;
  for (const dicom::Series& s : scan.series)
    if (s.role == dicom::SeriesRole::Wave && !s.error && stem(s.uid) == uid) steps.push_back(&s);
  std::stable_sort(steps.begin(), steps.end(),
                   [](const auto* a, const auto* b) { return a->temporalIndex < b->temporalIndex; });
  std::vector<std::shared_ptr<const image::ScalarVolume>> wave;
  for (std::size_t t = 0; t < steps.size(); ++t) {
    const double n = static_cast<double>(steps.size());
    auto volume = std::make_shared<image::ScalarVolume>(
        dicom::readSeries(*steps[t], progress.part(static_cast<double>(t) / n, static_cast<double>(t + 1) / n)));
    if (wave.empty() || wave.front()->grid.sameGeometry(volume->grid)) wave.push_back(std::move(volume));
  }
  return wave;
}

}  // namespace

OpenImages readImages(const dicom::ScanResult& scan, const dicom::ScanResult& guessed,
                      const std::filesystem::path& root, const dicom::RoleOverrides& roles, const Progress& progress) {
  OpenImages images;
  images.roles = roles;
  images.mriSeries = indexOf(scan, dicom::SeriesRole::Anatomical);
  if (images.mriSeries < 0) images.mriSeries = indexOf(scan, dicom::SeriesRole::Magnitude);
  images.stiffnessSeries = indexOf(scan, dicom::SeriesRole::Stiffness);
  images.confidenceSeries = indexOf(scan, dicom::SeriesRole::Confidence);
  if (images.mriSeries < 0)
    throw BadInput("no anatomical or magnitude MR series was found; give a series that role in the table");
  const auto series = [&scan](int i) -> const dicom::Series& { return scan.series[static_cast<std::size_t>(i)]; };
  progress.report(0.0, "reading MRI");
  images.mri =
      std::make_shared<image::ScalarVolume>(dicom::readSeries(series(images.mriSeries), progress.part(0.0, 0.5)));
  // From the folder of the series up to the one that was opened: the first that means these series and no others.
  const auto outwards = [&root](std::filesystem::path folder, const auto& right) -> std::filesystem::path {
    for (;; folder = folder.parent_path()) {
      if (right(folder)) return folder;
      if (!below(folder, root)) return {};
    }
  };
  // What is shown beside the maps that count: where it cannot be read, the rest still can.
  try {
    const int magnitude = indexOf(scan, dicom::SeriesRole::Magnitude);
    if (magnitude >= 0 && magnitude != images.mriSeries)
      images.magnitude =
          std::make_shared<image::ScalarVolume>(dicom::readSeries(series(magnitude), progress.part(0.5, 0.55)));
    images.wave = readWave(scan, progress.part(0.55, 0.6));
  } catch (const BadInput& e) {
    images.note = QString::fromUtf8(e.what());
  }
  if (!roles.empty()) images.mriSource = root;
  if (images.mriSource.empty())
    images.mriSource = outwards(commonFolder(series(images.mriSeries)), [&](const std::filesystem::path& folder) {
      return findsIt(guessed, folder, dicom::SeriesRole::Anatomical, series(images.mriSeries).uid);
    });
  if (images.stiffnessSeries < 0) {
    images.note +=
        QStringLiteral("No stiffness series was found: outlines can be drawn, stiffness cannot be measured.");
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
    images.note += QStringLiteral("No confidence map was found: every voxel with a stiffness counts.");
  if (!roles.empty()) images.mreSource = root;
  if (images.mreSource.empty())
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

/// What the worker found and read.
struct Session::Opened {
  Wanted wanted;
  dicom::ScanResult scan, guessed;
  OpenImages images;
  std::string failure;  ///< images could not be read; the scan is shown all the same
};

void Session::openPath(const QString& path) {
  std::error_code unknown;
  const std::filesystem::path there =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path.toStdString(), unknown), unknown);
  startLoad(
      [there](const Progress&) {
        if (pipeline::isCase(there)) return wantedCase(there);
        Wanted wanted;
        wanted.path = there;
        return wanted;
      },
      tr("Opening"));
}

Session::Wanted Session::wantedCase(const std::filesystem::path& path) {
  Wanted wanted;
  wanted.caseFolder = std::filesystem::is_directory(path) ? path : path.parent_path();
  wanted.lock = std::make_shared<CaseLock>(wanted.caseFolder);
  wanted.record = readCaseRecord(path);
  wanted.path = wanted.record->source;
  if (!std::filesystem::exists(wanted.path))
    throw BadInput("the images of this case are not where they were; put them back, or beside the case as before");
  return wanted;
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
          options.shear_kPa = 5.8;  // far from the atlas: there is something to compare
          phantom::writePhantom(phantom::makePhantom(seed, options, progress.part(0.0, 0.9)), target);
        }
        Wanted wanted;
        wanted.path = target;
        return wanted;
      },
      tr("Opening the synthetic patient"));
}

void Session::recover(const Journalled& journalled) {
  startLoad(
      [journalled](const Progress&) {
        Wanted wanted;
        if (!journalled.caseFile.empty() && pipeline::isCase(journalled.caseFile))
          wanted = wantedCase(journalled.caseFile);
        if (wanted.path.empty()) wanted.path = journalled.source;
        wanted.journalled = journalled;
        return wanted;
      },
      tr("Recovering"));
}

void Session::startLoad(std::function<Wanted(const Progress&)> prepare, const QString& what) {
  if (worker_.busy()) {
    emit message(tr("Still at work; cancel it first."));
    return;
  }
  auto opened = std::make_shared<Opened>();
  work_ = Work::Load;
  // The case that is open gives its lock back first: it may be the one that is opened again.
  lock_.reset();
  worker_.start(
      [opened, prepare](const Progress& progress) {
        opened->wanted = prepare(progress.part(0.0, 0.5));
        opened->scan = dicom::scan(opened->wanted.path, progress.part(0.5, 0.7));
        opened->guessed = opened->scan;
        dicom::RoleOverrides roles;
        if (opened->wanted.record) roles = opened->wanted.record->roles;
        dicom::applyRoles(opened->scan, roles);
        try {
          opened->images =
              readImages(opened->scan, opened->guessed, opened->wanted.path, roles, progress.part(0.7, 1.0));
        } catch (const BadInput& e) {
          opened->failure = e.what();
        }
      },
      [this, opened](std::exception_ptr failure) {
        if (!failure) take(*opened);
        ended(Work::Load, failure);
        if (failure) return;
        if (!opened->failure.empty())
          failure_[static_cast<std::size_t>(Step::Load)] = QString::fromStdString(opened->failure);
        emit loaded();
        emit contoursChanged();
        emit parametersChanged();
        emit statusChanged();
        if (!images_.note.isEmpty()) emit message(images_.note);
        measure();
      });
  emit workStarted(what);
  emit statusChanged();
}

void Session::take(Opened& opened) {
  path_ = QString::fromStdString(opened.wanted.path.string());
  scan_ = std::move(opened.scan);
  guessed_ = std::move(opened.guessed);
  images_ = std::move(opened.images);
  contours_ = {};
  second_ = {};
  clipboard_.clear();
  measure_ = {};
  if (images_.mriSeries >= 0 && images_.mri) {
    const dicom::Series& mri = scan_.series[static_cast<std::size_t>(images_.mriSeries)];
    contours_.frameOfReferenceUid = mri.frameOfReferenceUid;
    contours_.seriesUid = mri.uid;
  }
  caseFolder_ = QString::fromStdString(opened.wanted.caseFolder.string());
  lock_ = std::move(opened.wanted.lock);
  parameters_.placement = {};  // of another patient
  if (opened.wanted.record) {
    contours_ = std::move(opened.wanted.record->outlines);
    parameters_ = opened.wanted.record->parameters;
    measure_ = opened.wanted.record->measure;
  }
  modified_ = false;
  const auto& recovered = opened.wanted.journalled;
  if (recovered) {
    contours_ = recovered->outlines;
    if (recovered->inWork.points_lps_mm.cols() > 0) contours_.polygons.push_back(recovered->inWork);
    modified_ = true;
  }
  undo_.clear();
  forgetPlacings();
  tool_.selectPolygon(std::nullopt);
  tool_.contoursChanged();
  plane_.reset();
  result_.reset();
  picture_.reset();
  failure_ = {};
  ++revision_;
  beginJournal();
  std::error_code ignored;
  // What was recovered is in the new journal now.
  if (recovered && journal_ && !journalFailed_) std::filesystem::remove(recovered->file, ignored);
}

void Session::setRole(int index, dicom::SeriesRole role) {
  if (worker_.busy() || index < 0 || index >= static_cast<int>(scan_.series.size())) return;
  const dicom::Series& series = scan_.series[static_cast<std::size_t>(index)];
  if (series.role == role) return;
  dicom::RoleOverrides roles = images_.roles;
  // One series has the role by hand: who was given it before becomes "other".
  for (auto& [uid, given] : roles)
    if (given == role && role != dicom::SeriesRole::Other) given = dicom::SeriesRole::Other;
  roles[series.uid] = role;
  dicom::applyRoles(scan_, roles);
  images_.roles = roles;
  readAgain(tr("Reading images"));
}

void Session::readAgain(const QString& what) {
  auto images = std::make_shared<OpenImages>();
  work_ = Work::Load;
  worker_.start([images, scan = scan_, guessed = guessed_, roles = images_.roles,
                 root = std::filesystem::path(path_.toStdString())](
                    const Progress& progress) { *images = readImages(scan, guessed, root, roles, progress); },
                [this, images, roles = images_.roles](std::exception_ptr failure) {
                  images_ = failure ? OpenImages{} : std::move(*images);
                  images_.roles = roles;
                  ++revision_;
                  modified_ = true;
                  ended(Work::Load, failure);
                  emit loaded();
                  measure();
                });
  emit workStarted(what);
  emit statusChanged();
}

}  // namespace glisson::session

// SPDX-License-Identifier: GPL-3.0-or-later

// Opening: folders, cases, the synthetic patient, what a crash left behind; roles and answers.
#include <algorithm>

#include "base/error.h"
#include "phantom/phantom.h"
#include "pipeline/case_folder.h"
#include "session/kept_results.h"
#include "session/session.h"
#include "session/volume_files.h"

namespace glisson::session {

/// What the worker found and read.
struct Session::Opened {
  Wanted wanted;
  dicom::ScanResult scan, guessed;
  Settings settings;  ///< of the case or the journal; else the defaults
  OpenImages images;
  std::vector<OfferedRegion> regions;
  std::optional<pipeline::LoadedRoi> region;  ///< the only one of files that were named, to be taken as outlines
  std::optional<ShownRun> run;                ///< kept in the case
  std::string notKept;                        ///< why a run that is kept cannot be shown
  std::string failure;                        ///< images could not be read; the scan is shown all the same
};

void Session::openPath(const QString& path) {
  openPaths({path});
}

void Session::openPaths(const QStringList& paths) {
  if (paths.isEmpty()) return;
  std::vector<std::filesystem::path> there;
  std::error_code unknown;
  for (const QString& path : paths)
    there.push_back(std::filesystem::weakly_canonical(std::filesystem::absolute(path.toStdString(), unknown), unknown));
  const auto [source, files] = commonFolder(there);
  const QString name = QString::fromStdString(there.front().filename().string());
  startLoad(
      [source = source, files = files](const Progress&) {
        if (files.empty() && pipeline::isCase(source)) return wantedCase(source);
        Wanted wanted;
        wanted.path = source;
        wanted.files = files;
        return wanted;
      },
      tr("Opening"), paths.size() == 1 ? name : tr("%1 and %2 more").arg(name).arg(paths.size() - 1));
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
  const QString base = folder.isEmpty() ? cacheFolder() : folder;
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
      tr("Opening the synthetic patient"), tr("The synthetic patient"));
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
      tr("Recovering"), tr("What was left behind"));
}

namespace {

/// Why nothing of a folder could be opened: what was looked at, and what was wrong with it.
QString whyNothing(const dicom::ScanResult& scan) {
  QString why = Session::tr(
      "There is no DICOM series, volume or case here; choose a DICOM folder, DICOMDIR, ZIP archive, a NIfTI, NRRD or "
      "MetaImage volume, or case.json.");
  constexpr std::size_t shown = 3;
  for (std::size_t i = 0; i < std::min(shown, scan.skipped.size()); ++i)
    why += QStringLiteral("\n%1: %2")
               .arg(QString::fromStdString(scan.skipped[i].file.filename().string()),
                    QString::fromStdString(scan.skipped[i].reason));
  if (scan.skipped.size() > shown)
    why += QLatin1Char('\n') + Session::tr("and %1 more files").arg(scan.skipped.size() - shown);
  return why;
}

}  // namespace

// On a thread of the worker: everything that reading takes.
void Session::openInto(Opened& opened, const std::filesystem::path& work, const Progress& progress) {
  const Wanted& wanted = opened.wanted;
  opened.settings.choices.files = wanted.files;
  if (wanted.record) opened.settings = *wanted.record;
  // What a journal holds is newer than its case.
  if (wanted.journalled && wanted.journalled->settings) opened.settings = *wanted.journalled->settings;
  const Choices& choices = opened.settings.choices;
  opened.scan = scanAll(wanted.path, choices.files, progress.part(0.0, 0.4));
  if (opened.scan.series.empty()) throw BadInput(whyNothing(opened.scan).toStdString());
  opened.guessed = opened.scan;
  dicom::applyRoles(opened.scan, choices.roles);
  opened.regions = offeredRegions(opened.scan, progress.part(0.4, 0.45));
  try {
    opened.images = readImages(opened.scan, opened.guessed, wanted.path, choices, progress.part(0.45, 0.9));
  } catch (const BadInput& e) {
    opened.images.choices = choices;
    opened.failure = e.what();
    return;
  }
  std::error_code unknown;
  const bool named = !choices.files.empty() ||
                     (std::filesystem::is_regular_file(wanted.path, unknown) && isVolume(opened.scan.series.front()));
  if (named && !wanted.record && !wanted.journalled && opened.regions.size() == 1) {
    const OfferedRegion& only = opened.regions.front();
    opened.region = pipeline::loadRoi(only.file, {}, only.number, progress.part(0.9, 1.0));
  }
  // What was drawn since is newer than the run, which would be taken for its own.
  if (wanted.record && wanted.record->lastRunStale && !wanted.journalled) {
    try {
      opened.run = keptRun(wanted.caseFolder, work);
    } catch (const BadInput& e) {
      opened.notKept = e.what();
    }
  }
}

void Session::startLoad(std::function<Wanted(const Progress&)> prepare, const QString& what, const QString& name) {
  if (stillAtWork()) return;
  auto opened = std::make_shared<Opened>();
  work_ = Work::Load;
  // The case that is open gives its lock back first: it may be the one that is opened again.
  lock_.reset();
  worker_.start(
      [opened, prepare, work = std::filesystem::path(workFolder().toStdString())](const Progress& progress) {
        opened->wanted = prepare(progress.part(0.0, 0.5));
        openInto(*opened, work, progress.part(0.5, 1.0));
      },
      [this, opened, name](std::exception_ptr failure) { loadEnded(*opened, name, failure); });
  emit workStarted(what);
  emit statusChanged();
}

void Session::loadEnded(Opened& opened, const QString& name, std::exception_ptr failure) {
  refusal_.reset();
  if (failure && !wasCancelled(failure)) refusal_ = Refusal{name, reasonOf(failure)};
  if (!failure) take(opened);
  ended(Work::Load, failure);
  if (failure) {
    if (images_.mri) failure_[static_cast<std::size_t>(Step::Load)].clear();  // what was open still is
    lockAgain();
    emit message({});  // the Load page says why, once
    emit statusChanged();
    return;
  }
  failure_[static_cast<std::size_t>(Step::Load)] = QString::fromStdString(opened.failure);
  emit contoursChanged();
  emit parametersChanged();
  tellImages();  // pages show the run that was kept, too
  if (!opened.notKept.empty()) emit message(QString::fromStdString(opened.notKept));
  if (opened.region) takeOnlyRegion(*opened.region);
  if (opened.wanted.journalled && images_.mri) {
    // Where the reader was: the outline in work comes last, then what was drawn last.
    const auto& all = contours_.polygons;
    const auto last = std::find_if(all.rbegin(), all.rend(), [](const roi::Polygon& p) {
      return p.points_lps_mm.cols() > 0 && p.state != roi::PolygonState::Interpolated;
    });
    if (last != all.rend()) emit pointWanted(last->points_lps_mm.rowwise().mean());
  }
}

// Nothing could be opened: what was open stays, and is locked as before.
void Session::lockAgain() {
  if (caseFolder_.isEmpty()) return;
  try {
    lock_ = std::make_shared<CaseLock>(std::filesystem::path(caseFolder_.toStdString()));
  } catch (const BadInput& e) {
    emit message(QString::fromUtf8(e.what()));
  }
}

void Session::tellImages() {
  emit loaded();
  emit statusChanged();
  const QString& failure = failure_[static_cast<std::size_t>(Step::Load)];
  if (!failure.isEmpty())
    emit message(failure);
  else if (images_.question)
    emit message(images_.question->text);
  else if (!images_.note.isEmpty())
    emit message(images_.note);
  if (images_.question && images_.question->kind != Question::Kind::None) {
    const bool refused = images_.question->kind == Question::Kind::Together && images_.choices.together.has_value();
    if (!refused) emit asked();
  }
  measure();
}

// A patient starts from the defaults: parameters of the one before would go unseen into this one's numbers.
void Session::take(Opened& opened) {
  path_ = QString::fromStdString(opened.wanted.path.string());
  scan_ = std::move(opened.scan);
  guessed_ = std::move(opened.guessed);
  images_ = std::move(opened.images);
  tool_.setImage(images_.mri);
  regions_ = std::move(opened.regions);
  contours_ = {};
  second_ = {};
  clipboard_.clear();
  caseFolder_ = QString::fromStdString(opened.wanted.caseFolder.string());
  lock_ = std::move(opened.wanted.lock);
  parameters_ = opened.settings.parameters;
  measure_ = opened.settings.measure;
  if (opened.wanted.record) contours_ = std::move(opened.wanted.record->outlines);
  unsaved_ = {};
  const auto& recovered = opened.wanted.journalled;
  if (recovered) {
    contours_ = recovered->outlines;
    if (recovered->inWork.points_lps_mm.cols() > 0) contours_.polygons.push_back(recovered->inWork);
    unsaved_ = {true, recovered->settings.has_value()};
    recovered_ = recovered->file;
  } else {
    recovered_.clear();
  }
  undo_.clear();
  forgetPlacings();
  tool_.selectPolygon(std::nullopt);
  tool_.contoursChanged();
  plane_.reset();
  statistics_ = {};
  vesseler_.cancel();
  vessels_.reset();
  vesselsOf_.reset();
  measuredKey_.reset();
  regionKey_.reset();
  failure_ = {};
  ++revision_;
  ++outlinesRevision_;
  result_ = opened.run ? opened.run->result : nullptr;
  picture_ = opened.run ? opened.run->picture : nullptr;
  if (opened.run) {
    resultOutlines_ = outlinesRevision_;
    resultParameters_ = parameters_;
    resultWasStale_ = *opened.wanted.record->lastRunStale;
    lastKept_ = {caseFolder_, result_};
  }
  if (!images_.mri) journal_.reset();  // of the patient before
  drawnOn();
}

// The outlines belong to the image that is drawn on; their journal begins with it.
void Session::drawnOn() {
  if (!images_.mri) return;  // after a role that did not help the outlines wait in the journal that they are in
  const dicom::Series& mri = scan_.series[static_cast<std::size_t>(images_.mriSeries)];
  if (contours_.polygons.empty() || contours_.frameOfReferenceUid.empty() ||
      contours_.frameOfReferenceUid == mri.frameOfReferenceUid) {
    contours_.frameOfReferenceUid = mri.frameOfReferenceUid;
    contours_.seriesUid = isVolume(mri) ? std::string() : mri.uid;
  } else if (!images_.choices.otherFrame) {
    emit message(tr("The outlines have another frame of reference than this MRI: check that they lie where they did."));
  }
  beginJournal();
}

void Session::setRole(int index, dicom::SeriesRole role) {
  if (worker_.busy() || index < 0 || index >= static_cast<int>(scan_.series.size())) return;
  const dicom::Series& series = scan_.series[static_cast<std::size_t>(index)];
  if (series.role == role && (inUse(index) || role == dicom::SeriesRole::Other)) return;
  Choices choices = images_.choices;
  // One series has the role by hand: who was given it before becomes "other".
  for (auto& [uid, given] : choices.roles)
    if (given == role && role != dicom::SeriesRole::Other) given = dicom::SeriesRole::Other;
  choices.roles[series.uid] = role;
  // What was answered was about other series.
  choices.together.reset();
  choices.quantity.reset();
  choices.unit.reset();
  dicom::applyRoles(scan_, choices.roles);
  readAgain(choices);
}

bool Session::inUse(int index) const {
  return (images_.mri && index == images_.mriSeries) ||
         (images_.stiffness && (index == images_.stiffnessSeries || index == images_.confidenceSeries));
}

void Session::useTogether(bool yes) {
  if (stillAtWork()) return;
  Choices choices = images_.choices;
  choices.together = yes;
  if (yes) {
    readAgain(choices);
    return;
  }
  images_.choices = choices;  // the elastogram is left out already
  settingsTouched();
  emit statusChanged();
}

void Session::setMeaning(StiffnessQuantity quantity, const QString& unit) {
  if (stillAtWork()) return;
  elastography::unitFactor_kPa(unit.toStdString());  // throws where it is none
  Choices choices = images_.choices;
  choices.quantity = quantity;
  choices.unit = unit.toStdString();
  readAgain(choices);
}

bool Session::stillAtWork() {
  if (worker_.busy()) emit message(tr("Still at work; cancel it first."));
  return worker_.busy();
}

void Session::readAgain(const Choices& choices) {
  auto images = std::make_shared<OpenImages>();
  images_.choices = choices;
  work_ = Work::Load;
  worker_.start([images, scan = scan_, guessed = guessed_, choices, root = std::filesystem::path(path_.toStdString())](
                    const Progress& progress) { *images = readImages(scan, guessed, root, choices, progress); },
                [this, images, choices](std::exception_ptr failure) {
                  images_ = failure ? OpenImages{} : std::move(*images);
                  tool_.setImage(images_.mri);
                  images_.choices = choices;
                  ++revision_;
                  ++outlinesRevision_;
                  unsaved_.settings = true;
                  ended(Work::Load, failure);
                  drawnOn();
                  tellImages();
                });
  emit workStarted(tr("Reading images"));
  emit statusChanged();
}

}  // namespace glisson::session

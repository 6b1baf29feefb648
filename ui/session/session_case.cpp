// SPDX-License-Identifier: GPL-3.0-or-later

// The case on disk: contours.json, scene.json, and where the images are.
#include <QCoreApplication>
#include <QEventLoop>

#include "base/atomic_file.h"
#include "base/error.h"
#include "dicom/rtstruct.h"
#include "image/io.h"
#include "roi/contour_io.h"
#include "roi/polygon.h"
#include "session/imported_roi.h"
#include "session/kept_results.h"
#include "session/measured_contours.h"
#include "session/session.h"
#include "session/setup_of.h"
#include "session/volume_files.h"

namespace glisson::session {

pipeline::Scene Session::scene(const std::filesystem::path& folder) const {
  pipeline::Scene s;
  s.folder = folder;
  s.geometry.kind = pipeline::GeometrySpec::Kind::Patient;
  s.geometry.cell_mm.setConstant(parameters_.cell_mm);  // 0: the pipeline's default for the image
  s.geometry.roi = folder / "contours.json";
  s.material.kind =
      parameters_.useMre && images_.stiffness ? pipeline::MaterialSpec::Kind::Mre : pipeline::MaterialSpec::Kind::Atlas;
  const Choices& choices = images_.choices;
  s.geometry.roles = dicomRoles(choices.roles);
  s.geometry.overrideChecks = choices.together.value_or(false) || choices.otherFrame;
  s.geometry.mreQuantity = choices.quantity;
  s.geometry.mreUnit = choices.unit;
  s.geometry.rigidRegistration = parameters_.registerRigidly && s.material.kind == pipeline::MaterialSpec::Kind::Mre;
  s.setup = setupOf(parameters_);
  s.compare = pipeline::CompareSpec{parameters_.atlasShear_kPa, StiffnessQuantity::Shear};
  if (parameters_.howSure && retraction::rigidBarOf(s.setup)) s.uncertainty.emplace();
  s.outputs.vessels = s.outputs.overlay = s.outputs.report = true;
  return s;
}

CaseFiles Session::caseFiles(const std::filesystem::path& folder) const {
  return {images_, contours_, scene(folder), measure_.vessels ? vessels_ : nullptr};
}

namespace {

constexpr const char* vesselsFile = "vessels.nrrd";

/// The scene with the places of its images, which are written where no folder names them. Also what is not measured:
/// vessels, and the outlines as they are measured, where these are others.
pipeline::Scene placed(const CaseFiles& files, const std::filesystem::path& folder) {
  pipeline::Scene s = files.scene;
  if (!files.images.mri) throw BadInput("there is nothing to save: open images first");
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  if (!std::filesystem::is_directory(folder))
    throw BadInput("cannot make the case folder; choose a place that can be written to");
  s.geometry.mri = files.images.mriSource;
  if (s.geometry.mri.empty()) {
    s.geometry.mri = folder / "mri.nrrd";
    image::writeVolume(s.geometry.mri, *files.images.mri);
  }
  if (files.images.stiffness) {
    if (files.images.mreSource.empty())
      throw BadInput(
          "the series of the elastogram were chosen by hand, and no folder holds just these: put stiffness and "
          "confidence into a folder of their own and open the patient again");
    s.geometry.mre = files.images.mreSource;
  }
  const std::filesystem::path measured = folder / "contours-measured.json";
  const bool leftOut = std::any_of(files.contours.marks.begin(), files.contours.marks.end(),
                                   [](const auto& m) { return m.second == commands::SliceMark::NoWave; });
  if (files.vessels)
    image::writeVolume(folder / vesselsFile, *files.vessels);
  else
    std::filesystem::remove(folder / vesselsFile, ignored);
  if (leftOut && files.images.stiffness)
    writeAtomically(measured, roi::toJson(measuredContours(files.contours, files.images.mri->grid,
                                                           files.images.stiffness->values_kPa.grid)));
  else
    std::filesystem::remove(measured, ignored);
  return s;
}

}  // namespace

CaseRecord Session::caseRecord(const std::filesystem::path& folder) const {
  CaseRecord record;
  record.source = path_.toStdString();
  record.seriesUid = contours_.seriesUid;
  static_cast<Settings&>(record) = settings();
  record.outlines = contours_;
  if (result_) record.lastRunStale = resultIsStale();
  record.sceneJson = pipeline::toJson(scene(folder));  // without images yet; see saveFiles
  return record;
}

int saveFiles(CaseRecord record, const CaseFiles& files, const std::filesystem::path& folder) {
  record.sceneJson = pipeline::toJson(placed(files, folder));
  return writeCaseRecord(record, folder);
}

void Session::saveCase(const QString& folder) {
  // One writing at a time: the saving by itself may be under way.
  while (saver_.busy())
    QCoreApplication::processEvents(QEventLoop::ExcludeUserInputEvents | QEventLoop::WaitForMoreEvents);
  const std::filesystem::path target = folder.toStdString();
  std::error_code ignored;
  std::filesystem::create_directories(target, ignored);
  if (folder != caseFolder_ || !lock_) {
    std::shared_ptr<CaseLock> lock;
    if (std::filesystem::is_directory(target)) lock = std::make_shared<CaseLock>(target);
    lock_ = std::move(lock);
  }
  const int version = saveFiles(caseRecord(target), caseFiles(target), target);
  keepLastRun(target);
  caseFolder_ = folder;
  unsaved_ = {};
  beginJournal();
  emit saved(version);
  emit statusChanged();
}

// The run goes where its case goes; a folder that held another case's gives that one up. A case without its results is
// still a case: that they could not be kept is said, and what was saved stays.
void Session::keepLastRun(const std::filesystem::path& folder) {
  const QString name = QString::fromStdString(folder.string());
  if (!result_) {
    if (name != caseFolder_) forgetRun(folder);
    return;
  }
  if (work_ == Work::Run || (lastKept_.folder == name && lastKept_.result.lock() == result_)) return;
  try {
    keepRun(workFolder().toStdString(), folder);
    lastKept_ = {name, result_};
  } catch (const BadInput& e) {
    emit message(QString::fromUtf8(e.what()));
  }
}

void Session::saveInBackground() {
  if (saver_.busy() || caseFolder_.isEmpty() || !images_.mri) return;
  const std::filesystem::path target = caseFolder_.toStdString();
  auto version = std::make_shared<int>(0);
  auto notKept = std::make_shared<std::string>();
  const bool keeps =
      result_ && work_ != Work::Run && (lastKept_.folder != caseFolder_ || lastKept_.result.lock() != result_);
  saver_.start(
      [version, target, notKept, keeps, work = std::filesystem::path(workFolder().toStdString()),
       record = caseRecord(target), files = caseFiles(target)](const Progress&) {
        *version = saveFiles(record, files, target);
        try {
          if (keeps) keepRun(work, target);
        } catch (const BadInput& e) {
          *notKept = e.what();
        }
      },
      [this, version, notKept, keeps, result = result_, folder = caseFolder_, revision = revision_,
       written = settings()](std::exception_ptr failure) {
        if (failure) {
          emit saveFailed(reasonOf(failure));
          return;
        }
        if (keeps && notKept->empty()) lastKept_ = {folder, result};
        if (!notKept->empty()) emit message(QString::fromStdString(*notKept));
        if (revision == revision_ && written == settings()) {
          unsaved_ = {};
          beginJournal();
        }
        emit saved(*version);
        emit statusChanged();
      });
}

void Session::beginJournal() {
  if (!images_.mri) return;
  try {
    if (!journal_) journal_ = std::make_unique<Journal>(journalFolder_.toStdString());
    journal_->begin(path_.toStdString(),
                    caseFolder_.isEmpty() ? std::string() : (caseFolder_ + QStringLiteral("/case.json")).toStdString(),
                    contours_.seriesUid);
  } catch (const Error& e) {
    journalFailed_ = true;
    emit message(QString::fromUtf8(e.what()));
    return;
  }
  journalFailed_ = false;
  journal();
  std::error_code ignored;
  if (!recovered_.empty() && !journalFailed_) std::filesystem::remove(recovered_, ignored);
  recovered_.clear();
}

void Session::journal() {
  if (!journal_) return;
  roi::Polygon inWork;
  inWork.state = roi::PolygonState::Draft;
  inWork.points_lps_mm = tool_.outlineInWork();
  if (plane_) inWork.sopInstanceUid = plane_->sopInstanceUid;
  journalledVertices_ = tool_.drawing().cols();
  try {
    journal_->write(contours_, inWork, settings(), modified());
    journalFailed_ = false;
  } catch (const Error& e) {
    // Told once; what is not written now goes out with the next gesture.
    if (!std::exchange(journalFailed_, true)) emit message(QString::fromUtf8(e.what()));
  }
}

void Session::park() {
  if (tool_.state() == tools::ToolState::Drawing && plane_) apply(tool_.leaveSlice(*plane_));
}

void Session::importContours(const QString& file, const std::function<bool(const QString&)>& confirm) {
  if (!images_.mri) throw BadInput("open images first; outlines belong to an image series");
  takeOutlines(pipeline::loadRoi(file.toStdString(), {}, 0), confirm);
}

void Session::importRegion(const OfferedRegion& region, const std::function<bool(const QString&)>& confirm) {
  if (!images_.mri) throw BadInput("open images first; outlines belong to an image series");
  takeOutlines(pipeline::loadRoi(region.file, {}, region.number), confirm);
}

// A region that was named beside the images: refused with a message only, since the images are open all the same.
void Session::takeOnlyRegion(const pipeline::LoadedRoi& region) {
  if (!images_.mri) return;
  try {
    takeOutlines(region, {});
  } catch (const BadInput& e) {
    emit message(QString::fromUtf8(e.what()));
  }
}

bool Session::takeOutlines(const pipeline::LoadedRoi& roi, const std::function<bool(const QString&)>& confirm) {
  const Belonging where = belongs(roi, scan_.series[static_cast<std::size_t>(images_.mriSeries)]);
  if (!where.refusal.isEmpty()) throw BadInput(where.refusal.toStdString());
  if (!where.doubt.isEmpty() && confirm) {
    if (!confirm(where.doubt)) return false;
    images_.choices.otherFrame = true;
    settingsTouched();
  }
  roi::ContourStack imported = roi.contours ? *roi.contours : roi::contoursOf(*roi.mask);
  imported.seriesUid = contours_.seriesUid;
  park();
  replaceContours(std::move(imported), "import outlines");
  const QString said = QStringList{confirm ? QString() : where.doubt, where.notes}.join(QLatin1Char(' ')).trimmed();
  if (!said.isEmpty()) emit message(said);
  return true;
}

}  // namespace glisson::session

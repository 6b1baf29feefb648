// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/session.h"

#include <QCoreApplication>
#include <QStandardPaths>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "pipeline/sources.h"
#include "session/act_command.h"
#include "session/model_preview.h"
#include "session/trust.h"

namespace glisson::session {

namespace {

constexpr int measureEvery_ms = 16;
constexpr int regionAfter_ms = 120;
constexpr int vesselsAfter_ms = 3000;
constexpr int autosaveEvery_ms = 30000;
constexpr int journalAfter_ms = 200;

QString plural(std::size_t n, const QString& one, const QString& many) {
  return n == 1 ? one : many.arg(static_cast<qulonglong>(n));
}

/// A folder named after the program alone: the name of an organization would come twice.
QString placeOf(QStandardPaths::StandardLocation location) {
  return QStandardPaths::writableLocation(location) + QLatin1Char('/') + QCoreApplication::applicationName();
}

/// In the reader's language.
QString nameOfAct(const std::string& text) {
  return text.empty() ? QString() : QCoreApplication::translate("commands", text.c_str());
}

QString inWords(const tools::Sentence& sentence) {
  if (sentence.empty()) return {};
  QString text = QCoreApplication::translate("tools", sentence.text);
  for (const std::string& value : sentence.values) text = text.arg(QString::fromStdString(value));
  return text;
}

}  // namespace

Session::Session(QObject* parent) : QObject(parent), tool_(contours_) {
  measureTimer_.setSingleShot(true);
  measureTimer_.setInterval(measureEvery_ms);
  connect(&measureTimer_, &QTimer::timeout, this, &Session::measure);
  regionTimer_.setSingleShot(true);
  regionTimer_.setInterval(regionAfter_ms);
  connect(&regionTimer_, &QTimer::timeout, this, &Session::measureRegion);
  vesselTimer_.setSingleShot(true);
  vesselTimer_.setInterval(vesselsAfter_ms);
  connect(&vesselTimer_, &QTimer::timeout, this, &Session::findVessels);
  connect(&worker_, &Worker::progressed, this, &Session::progressed);
  journalTimer_.setSingleShot(true);
  journalTimer_.setInterval(journalAfter_ms);
  connect(&journalTimer_, &QTimer::timeout, this, &Session::journal);
  journalFolder_ = placeOf(QStandardPaths::GenericDataLocation) + QStringLiteral("/journals");
  autosave_.setInterval(autosaveEvery_ms);
  connect(&autosave_, &QTimer::timeout, this, [this] {
    if (lock_) lock_->touch();
    if (modified() && !caseFolder_.isEmpty()) saveInBackground();
  });
  autosave_.start();
}

Session::~Session() {
  delete preview_;  // its worker writes into the work folder, which goes with the members
}

QString Session::cacheFolder() {
  return placeOf(QStandardPaths::GenericCacheLocation);
}

const QString& Session::workFolder() const {
  if (!workFolder_.isEmpty()) return workFolder_;
  try {
    ownFolder_ = std::make_unique<WorkFolder>(cacheFolder().toStdString());
    workFolder_ = QString::fromStdString(ownFolder_->path().string());
  } catch (const BadInput&) {
    workFolder_ = cacheFolder() + QStringLiteral("/current-case");  // what runs there says why it cannot be written
  }
  return workFolder_;
}

void Session::setWorkFolder(const QString& folder) {
  workFolder_ = folder;
}

QString Session::runFolder() const {
  return workFolder() + QStringLiteral("/results");
}

std::size_t Session::acceptedCount() const {
  return static_cast<std::size_t>(std::count_if(contours_.polygons.begin(), contours_.polygons.end(),
                                                [](const auto& p) { return p.state == roi::PolygonState::Accepted; }));
}

void Session::apply(const tools::Acts& acts) {
  if (acts.empty()) {
    toolMoved();
    return;
  }
  for (const tools::Act& act : acts) {
    auto settled = images_.mri ? settleInterpolated(act, contours_, images_.mri->grid) : std::nullopt;
    undo_.push(settled ? std::move(settled->command) : commandOf(act, contours_), contours_);
    if (settled) tool_.selectPolygon(settled->selected);
  }
  tool_.contoursChanged();
  contoursTouched();
}

void Session::toolMoved() {
  if (const tools::Sentence said = tool_.takeMessage(); !said.empty()) emit message(inWords(said));
  if (!tool_.dragging() && tool_.drawing().cols() != journalledVertices_) journal();
  const bool atWork = tool_.drawing().cols() >= 3 || tool_.preview().cols() > 0;
  if (atWork && !measureTimer_.isActive()) measureTimer_.start();
  emit toolChanged();
}

void Session::contoursTouched() {
  ++revision_;
  ++outlinesRevision_;
  vesseler_.cancel();
  unsaved_.outlines = true;
  journal();
  failure_[static_cast<std::size_t>(Step::Segment)].clear();
  if (!measureTimer_.isActive()) measureTimer_.start();
  emit message(inWords(tool_.takeMessage()));  // nothing to say: what was said before is over
  emit contoursChanged();
  emit toolChanged();
  emit statusChanged();
}

void Session::undo() {
  if (plane_ && tool_.undoDrawing(*plane_)) {
    toolMoved();
    return;
  }
  if (const auto where = undo_.whereUndo()) {
    emit pointWanted(*where);  // first the slice it concerns, then the act
    const QString what = undoText();
    undo_.undo(contours_);
    tool_.contoursChanged();
    contoursTouched();
    emit message(tr("Undone: %1.").arg(what));
  }
}

void Session::redo() {
  if (plane_ && tool_.redoDrawing(*plane_)) {
    toolMoved();
    return;
  }
  if (const auto where = undo_.whereRedo()) {
    emit pointWanted(*where);
    const QString what = redoText();
    undo_.redo(contours_);
    tool_.contoursChanged();
    contoursTouched();
    emit message(tr("Done again: %1.").arg(what));
  }
}

bool Session::canUndo() const {
  return tool_.state() == tools::ToolState::Drawing || undo_.canUndo();
}
bool Session::canRedo() const {
  return tool_.canRedoDrawing() || undo_.canRedo();
}
QString Session::undoText() const {
  return tool_.state() == tools::ToolState::Drawing ? tr("vertex") : nameOfAct(undo_.undoText());
}
QString Session::redoText() const {
  return tool_.canRedoDrawing() ? tr("vertex") : nameOfAct(undo_.redoText());
}

void Session::setShownPlane(const tools::SlicePlane& plane) {
  plane_ = plane;
  // Every slice is measured at once: another one has its numbers at once.
  pickSlice();
  emit statisticsChanged();
  const RegionKey now{revision_, tool_.state(), tool_.selected()};
  if (measuredKey_ != now) measureSoon();
}

void Session::setParameters(const Parameters& parameters) {
  if (parameters == parameters_) return;
  parameters_ = parameters;
  ++revision_;
  settingsTouched();
  emit parametersChanged();
  emit statusChanged();
}

void Session::settingsTouched() {
  unsaved_.settings = true;
  if (!journalTimer_.isActive()) journalTimer_.start();
}

ChangedSince Session::changedSinceRun() const {
  if (!result_) return {};
  return {outlinesRevision_ != resultOutlines_, !(parameters_ == resultParameters_), resultWasStale_};
}

void Session::cancel() {
  worker_.cancel();
}

StepStatus Session::status(Step step) const {
  const QString& failed = failure_[static_cast<std::size_t>(step)];
  const bool running = work_ == Work::Run && worker_.busy();
  const std::size_t accepted = acceptedCount();
  if (step == Step::Load) {
    if (work_ == Work::Load && worker_.busy()) return {StepState::Running, tr("Reading images")};
    if (!failed.isEmpty()) return {StepState::Failed, failed};
    if (!images_.mri) return {StepState::Ready, tr("Open a DICOM folder or the synthetic patient")};
    return {StepState::Done, plural(scan_.series.size(), tr("1 series"), tr("%1 series"))};
  }
  if (!images_.mri) return {StepState::Empty, tr("Needs images")};
  if (step == Step::Segment) {
    if (!failed.isEmpty()) return {StepState::Failed, failed};
    if (accepted == 0) return {StepState::Ready, tr("Outline the liver")};
    const OutlineCoverage c = coverage();
    QString detail = plural(accepted, tr("1 outline"), tr("%1 outlines"));
    if (!c.interpolated.empty()) detail += tr(", %1 slices interpolated").arg(c.interpolated.size());
    if (!c.empty.empty()) detail += tr(", %1 slices between them empty").arg(c.empty.size());
    return {StepState::Done, detail};
  }
  if (accepted == 0) return {StepState::Empty, tr("Needs an outline")};
  if (running) return {StepState::Running, tr("Running")};
  if (step != Step::Model && !failed.isEmpty()) return {StepState::Failed, failed};
  if (resultIsStale()) return {StepState::Stale, tr("Changed since the last run")};
  if (!result_) {
    if (step == Step::Compare) return {StepState::Empty, tr("Needs a run")};
    return {StepState::Ready, step == Step::Model ? tr("Set and check") : tr("Ready to run")};
  }
  if (step == Step::Model) return {StepState::Done, tr("%1 cells").arg(static_cast<qulonglong>(result_->model.cells))};
  if (isNoAnswer(*result_)) return {StepState::Failed, tr("No answer: see How far to trust it")};
  if (step == Step::Retract) return {StepState::Done, tr("%1 DOFs").arg(result_->primary.dofs)};
  if (!result_->difference) return {StepState::Empty, tr("Nothing was compared")};
  return {StepState::Done, tr("mean %1 mm").arg(result_->difference->mean_mm, 0, 'f', 2)};
}

void Session::ended(Work work, std::exception_ptr failure) {
  work_ = Work::None;
  const QString reason = reasonOf(failure);
  if (work == Work::Load) failure_[static_cast<std::size_t>(Step::Load)] = reason;
  if (work == Work::Run) {
    failure_[static_cast<std::size_t>(Step::Retract)] = reason;
    failure_[static_cast<std::size_t>(Step::Compare)] = reason;
  }
  if (wasCancelled(failure)) emit message(tr("Cancelled."));
  emit workEnded(!failure, reason);
  emit statusChanged();
}

}  // namespace glisson::session

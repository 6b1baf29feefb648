// SPDX-License-Identifier: GPL-3.0-or-later

// Opening, saving, recent ones, recovery, drag and drop.
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>
#include <QStatusBar>

#include "base/error.h"
#include "panels/compare_page.h"
#include "panels/form.h"
#include "panels/load_page.h"
#include "panels/main_window.h"
#include "session/imported_roi.h"

namespace glisson::panels {

using session::Step;

namespace {
constexpr int recentKept = 10;
const QString recentKey = QStringLiteral("recent");
}  // namespace

void MainWindow::openFolder() {
  if (!mayDiscard()) return;
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Open DICOM folder"), session_.path());
  if (folder.isEmpty()) return;
  showStep(Step::Load);
  session_.openPath(folder);
}

void MainWindow::openSynthetic() {
  if (!mayDiscard()) return;
  showStep(Step::Load);
  session_.openSynthetic();
}

void MainWindow::importOutlines() {
  const QString file =
      QFileDialog::getOpenFileName(this, tr("Import outlines"), session_.path(),
                                   tr("Outlines (*.dcm *.json *.nii *.nii.gz *.nrrd *.mha);;All files (*)"));
  if (!file.isEmpty()) importFrom(file);
}

void MainWindow::importFrom(const QString& file) {
  // What cannot be taken is refused before anything is asked.
  bool fits = false;
  attempt(tr("Import outlines"), [&] {
    const int mri = session_.images().mriSeries;
    if (mri < 0) throw BadInput("open images first; outlines belong to an image series");
    const session::Belonging where = session::belongs(pipeline::loadRoi(file.toStdString(), {}, 0),
                                                      session_.scan().series[static_cast<std::size_t>(mri)]);
    if (!where.refusal.isEmpty()) throw BadInput(where.refusal.toStdString());
    fits = true;
  });
  if (!fits || !mayReplaceOutlines()) return;
  attempt(tr("Import outlines"), [&] {
    session_.importContours(file, [this](const QString& doubt) {
      return confirmed("otherFrameBox", tr("Import outlines"), doubt,
                       tr("Import them all the same? The answer is kept in the case."), tr("Import"));
    });
  });
  showStep(Step::Segment);
}

void MainWindow::saveCase() {
  if (session_.caseFolder().isEmpty() || session_.readOnly())
    saveCaseAs();
  else
    session_.saveInBackground();
}

void MainWindow::saveCaseAs() {
  saveInto({});
}

bool MainWindow::saveInto(QString folder) {
  if (folder.isEmpty()) folder = QFileDialog::getExistingDirectory(this, tr("Save case into a folder"));
  if (folder.isEmpty()) return false;
  attempt(tr("Save case"), [&] { session_.saveCase(folder); });
  return !session_.modified();
}

void MainWindow::openFiles() {
  const QStringList files = QFileDialog::getOpenFileNames(
      this, tr("Open case, volumes or archive"), session_.path(),
      tr("Cases, volumes, archives, DICOMDIR (case.json *.nii *.nii.gz *.nrrd *.nhdr *.mha *.mhd *.zip DICOMDIR);;"
         "All files (*)"));
  openPaths(files);
}

void MainWindow::openPath(const QString& path) {
  openPaths({path});
}

void MainWindow::openPaths(const QStringList& paths) {
  if (paths.isEmpty() || !mayDiscard()) return;
  showStep(Step::Load);
  session_.openPaths(paths);
}

void MainWindow::takeRegion(const session::OfferedRegion& region) {
  if (!mayReplaceOutlines()) return;
  attempt(tr("Import outlines"), [&] {
    session_.importRegion(region, [this](const QString& doubt) {
      return confirmed("otherFrameBox", tr("Import outlines"), doubt,
                       tr("Import them all the same? The answer is kept in the case."), tr("Import"));
    });
    showStep(Step::Segment);
  });
}

void MainWindow::loadSecondReader() {
  const QString file = QFileDialog::getOpenFileName(this, tr("A second reader's outlines"), session_.path(),
                                                    tr("Outlines and cases (*.json *.dcm);;All files (*)"));
  if (file.isEmpty()) return;
  attempt(tr("A second reader's outlines"), [&] { session_.loadSecondReader(file); });
  if (!session_.secondReader().polygons.empty()) session_.compareReaders();
}

void MainWindow::exportResults() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder for pictures and report"));
  if (!folder.isEmpty()) compare_->exportTo(folder);
}

void MainWindow::remember(const QString& path) {
  if (path.isEmpty() || !session_.images().mri) return;  // what could not be opened is not offered again
  // Some files of a folder: the folder alone would mean others as well.
  if (session_.caseFolder().isEmpty() && !session_.images().choices.files.empty()) return;
  QSettings settings;
  QStringList all = settings.value(recentKey).toStringList();
  all.removeAll(path);
  all.prepend(path);
  settings.setValue(recentKey, all.mid(0, recentKept));
}

void MainWindow::fillRecent() {
  recent_->clear();
  for (const QString& path : QSettings().value(recentKey).toStringList())
    connect(recent_->addAction(path), &QAction::triggered, this, [this, path] { openPath(path); });
  if (recent_->isEmpty()) recent_->addAction(tr("None yet"))->setEnabled(false);
}

// What a crash left behind is offered once, above the pages, and never in the way.
void MainWindow::offerRecovery() {
  const auto found = session::Journal::abandoned(session_.journalFolder().toStdString());
  if (found.empty()) return;
  const session::Journalled newest = found.front();
  auto* row = qobject_cast<QHBoxLayout*>(recovery_->layout());
  const QString lost = newest.inWork.points_lps_mm.cols() > 0 ? tr(", and the one being drawn") : QString();
  auto* text = new QLabel(
      newest.settings
          ? tr("Glisson did not end in order. %1 outlines can be brought back%2, with the parameters as they were.")
                .arg(newest.outlines.polygons.size())
                .arg(lost)
          : tr("Glisson did not end in order. %1 outlines can be brought back%2.")
                .arg(newest.outlines.polygons.size())
                .arg(lost));
  auto* recover = button("recoverButton", tr("Recover"), {}, tr("Opens the patient and puts the outlines back"));
  recover->setProperty("primary", true);
  auto* later = button("recoverLaterButton", tr("Later"), {}, tr("Keeps it for the next start"));
  auto* discard = button("recoverDiscardButton", tr("Discard"), {}, tr("Deletes what could be brought back"));
  row->addWidget(text, 1);
  for (QPushButton* b : {recover, later, discard}) row->addWidget(b);
  connect(recover, &QPushButton::clicked, this, [this, newest] {
    if (!mayDiscard()) return;
    recovery_->hide();
    showStep(Step::Load);
    session_.recover(newest);
  });
  connect(later, &QPushButton::clicked, recovery_, &QWidget::hide);
  connect(discard, &QPushButton::clicked, this, [this, newest] {
    if (!confirmed("discardBox", tr("Discard"), tr("What Glisson could bring back is deleted for good."),
                   tr("%1 outlines and the parameters are lost.").arg(newest.outlines.polygons.size()), tr("Delete")))
      return;
    std::error_code ignored;
    std::filesystem::remove(newest.file, ignored);
    recovery_->hide();
  });
  recovery_->show();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  QStringList paths;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) paths << url.toLocalFile();
  openPaths(paths);
}

}  // namespace glisson::panels

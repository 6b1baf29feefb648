// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/main_window.h"

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QScreen>
#include <QSettings>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTimer>
#include <QVBoxLayout>
#include <array>
#include <cmath>

#include "base/version.h"
#include "panels/compare_page.h"
#include "panels/key_sheet.h"
#include "panels/keys.h"
#include "panels/load_page.h"
#include "panels/model_page.h"
#include "panels/quiet_wheel.h"
#include "panels/retract_page.h"
#include "panels/segment_page.h"
#include "panels/step_rail.h"
#include "panels/theme.h"
#include "views/slice_view.h"

namespace glisson::panels {

using session::Session;
using session::Step;

namespace {

const QString geometryKey = QStringLiteral("geometry");

}  // namespace

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent),
      keys_(new Keys(this)),
      rail_(new StepRail),
      pages_(new QStackedWidget),
      load_(new LoadPage(session_)),
      segment_(new SegmentPage(session_, *keys_)),
      model_(new ModelPage(session_)),
      retract_(new RetractPage(session_)),
      compare_(new ComparePage(session_)),
      progress_(new QProgressBar),
      progressText_(new QLabel),
      cancel_(new QPushButton(tr("Cancel"))) {
  setObjectName(QStringLiteral("mainWindow"));
  keepWheelForScrolling();
  setWindowTitle(QStringLiteral("%1[*]").arg(tr(researchUseOnly)));  // the desktop adds the name
  setWindowIcon(icon(QStringLiteral("glisson")));
  setAcceptDrops(true);
  resize(QSize(1480, 900).boundedTo(screen()->availableSize()));
  for (QWidget* page : {static_cast<QWidget*>(load_), static_cast<QWidget*>(segment_), static_cast<QWidget*>(model_),
                        static_cast<QWidget*>(retract_), static_cast<QWidget*>(compare_)})
    pages_->addWidget(page);
  auto* centre = new QWidget;
  auto* row = new QHBoxLayout(centre);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  row->addWidget(rail_);
  auto* main = new QWidget;
  auto* column = new QVBoxLayout(main);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  recovery_ = new QFrame;
  recovery_->setObjectName(QStringLiteral("recoveryBar"));
  recovery_->setLayout(new QHBoxLayout);
  recovery_->hide();
  column->addWidget(recovery_);
  column->addWidget(pages_, 1);
  row->addWidget(main, 1);
  setCentralWidget(centre);
  makeMenus();
  makeToolsMenu();
  makeStatusLine();
  connectSession();
  connect(compare_, &ComparePage::runWanted, this, &MainWindow::run);
  refreshIcons();
  showStep(Step::Load);
  updateStatus();
  QTimer::singleShot(0, this, &MainWindow::offerRecovery);
}

void MainWindow::makeStatusLine() {
  progress_->setObjectName(QStringLiteral("progressBar"));
  progress_->setRange(0, 1000);
  progress_->setFixedWidth(220);
  progress_->setTextVisible(false);
  progressText_->setObjectName(QStringLiteral("progressText"));
  cancel_->setObjectName(QStringLiteral("cancelButton"));
  auto* research = new QLabel(tr(researchUseOnly));
  research->setObjectName(QStringLiteral("researchUse"));
  for (QWidget* w :
       {static_cast<QWidget*>(progressText_), static_cast<QWidget*>(progress_), static_cast<QWidget*>(cancel_)}) {
    statusBar()->addPermanentWidget(w);
    w->hide();
  }
  statusBar()->addPermanentWidget(research);
  statusBar()->setSizeGripEnabled(false);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    session_.cancel();
    cancel_->setEnabled(false);
    progressText_->setText(tr("Cancelling"));
  });
}

void MainWindow::connectSession() {
  connect(rail_, &StepRail::stepChosen, this, &MainWindow::showStep);
  connect(load_, &LoadPage::openWanted, this, &MainWindow::openFolder);
  connect(load_, &LoadPage::syntheticWanted, this, &MainWindow::openSynthetic);
  connect(load_, &LoadPage::pathWanted, this, &MainWindow::openPath);
  connect(load_, &LoadPage::regionWanted, this, &MainWindow::takeRegion);
  connect(load_, &LoadPage::filesWanted, this, &MainWindow::openFiles);
  connect(load_, &LoadPage::segmentWanted, this, [this] { showStep(Step::Segment); });
  connect(segment_, &SegmentPage::importWanted, this, &MainWindow::importOutlines);
  connect(segment_, &SegmentPage::helpWanted, this, &MainWindow::showKeys);
  connect(segment_, &SegmentPage::secondReaderWanted, this, &MainWindow::loadSecondReader);
  connect(&session_, &Session::readersCompared, this, [this](const QString& text) {
    auto* box = new QMessageBox(QMessageBox::Information, tr("Two readers"), text, QMessageBox::Ok, this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->setObjectName(QStringLiteral("readersBox"));
    box->open();
  });
  connect(&session_, &Session::saved, this, [this](int version) {
    statusBar()->showMessage(tr("Saved, version %1.").arg(version), 6000);
    remember(session_.caseFolder() + QStringLiteral("/case.json"));
  });
  connect(&session_, &Session::saveFailed, this, [this](const QString& reason) {
    statusBar()->showMessage(tr("Not saved: %1 The outlines are kept.").arg(reason));
  });
  connect(compare_, &ComparePage::exported, this, [this](int files, const QString& reason) {
    statusBar()->showMessage(
        reason.isEmpty() ? tr("Exported %1 files.").arg(files) : tr("Not exported: %1").arg(reason), 12000);
  });
  connect(compare_, &ComparePage::placeChosen, this, [this](const Eigen::Vector3d& p_lps) {
    for (views::SliceView* view : {segment_->mriView(), segment_->mreView()}) {
      view->showPoint(p_lps);
      view->setCursor(p_lps);
    }
  });
  connect(model_, &ModelPage::runWanted, this, &MainWindow::run);
  connect(retract_, &RetractPage::runWanted, this, &MainWindow::run);
  connect(&session_, &Session::statusChanged, this, &MainWindow::updateStatus);
  connect(&session_, &Session::toolChanged, this, &MainWindow::updateStatus);
  connect(&session_, &Session::message, this, [this](const QString& text) { statusBar()->showMessage(text, 12000); });
  connect(&session_, &Session::progressed, this, &MainWindow::showProgress);
  connect(&session_, &Session::workStarted, this, [this](const QString& what) {
    cancel_->setEnabled(true);
    showProgress(0.0, what, -1.0);
    for (QWidget* w :
         {static_cast<QWidget*>(progressText_), static_cast<QWidget*>(progress_), static_cast<QWidget*>(cancel_)})
      w->show();
  });
  connect(&session_, &Session::workEnded, this, [this](bool, const QString& reason) {
    for (QWidget* w :
         {static_cast<QWidget*>(progressText_), static_cast<QWidget*>(progress_), static_cast<QWidget*>(cancel_)})
      w->hide();
    if (!reason.isEmpty()) statusBar()->showMessage(reason);
  });
  connect(&session_, &Session::loaded, this, [this] {
    const QString folder = session_.caseFolder();
    remember(folder.isEmpty() ? session_.path() : folder + QStringLiteral("/case.json"));
    if (session_.images().mri && step() == Step::Load && !load_->correcting()) showStep(Step::Segment);
  });
  connect(&session_, &Session::asked, this, &MainWindow::askAboutImages);
  connect(load_, &LoadPage::answerWanted, this, &MainWindow::askAboutImages);
  connect(&session_, &Session::runFinished, this, [this] { showStep(Step::Compare); });
}

void MainWindow::showProgress(double fraction, const QString& what, double secondsLeft) {
  progress_->setValue(static_cast<int>(std::lround(fraction * 1000.0)));
  if (cancel_->isEnabled()) progressText_->setText(what + session::timeLeft(secondsLeft));
}

void MainWindow::updateStatus() {
  for (const Step step : session::steps) rail_->setStatus(step, session_.status(step));
  const bool open = session_.images().mri != nullptr;
  const QString undo = placing() ? session_.undoPlacementText() : session_.undoText();
  const QString redo = placing() ? session_.redoPlacementText() : session_.redoText();
  undoAction_->setEnabled(placing() ? session_.canUndoPlacement() : session_.canUndo());
  undoAction_->setText(undo.isEmpty() ? tr("&Undo") : tr("&Undo %1").arg(undo));
  redoAction_->setEnabled(placing() ? session_.canRedoPlacement() : session_.canRedo());
  redoAction_->setText(redo.isEmpty() ? tr("&Redo") : tr("&Redo %1").arg(redo));
  importAction_->setEnabled(open);
  saveAction_->setEnabled(open);
  saveAsAction_->setEnabled(open);
  runAction_->setEnabled(open && !session_.busy());
  const session::OutlineCoverage outlines = session_.coverage();
  interpolateAction_->setEnabled(outlines.drawn.size() > 1 &&
                                 outlines.empty.size() + outlines.interpolated.size() > 0 && !session_.busy());
  acceptAllAction_->setEnabled(!outlines.interpolated.empty());
  const bool second = !session_.secondReader().polygons.empty();
  compareReadersAction_->setEnabled(second);
  putAwayAction_->setEnabled(second);
  exportAction_->setEnabled(session_.picture() != nullptr && !session_.busy());
  formatsAction_->setEnabled(open && !session_.busy());
  setWindowModified(session_.modified());
}

void MainWindow::refreshIcons() {
  for (QPushButton* b : findChildren<QPushButton*>()) {
    const QString name = b->property("iconName").toString();
    if (name.isEmpty()) continue;
    QIcon shown = icon(name, b->property("primary").toBool() ? QColor(Qt::white) : QColor());
    // A button that cannot be pressed has another ground.
    const QIcon faint = icon(name, palette().color(QPalette::Disabled, QPalette::ButtonText));
    for (const QSize& size : faint.availableSizes()) shown.addPixmap(faint.pixmap(size), QIcon::Disabled);
    b->setIcon(shown);
  }
}

void MainWindow::showStep(Step step) {
  rail_->setCurrent(step);
  pages_->setCurrentIndex(static_cast<int>(step));
  if (step == Step::Segment) segment_->mriView()->setFocus();
  updateStatus();
}

// Undo takes back what the page shows: outlines are not on the pages of model and retraction.
bool MainWindow::placing() const {
  return step() == Step::Model || step() == Step::Retract;
}

Step MainWindow::step() const {
  return static_cast<Step>(pages_->currentIndex());
}

void MainWindow::attempt(const QString& title, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception&) {
    QMessageBox::warning(this, title, session::reasonOf(std::current_exception()));
  }
}

void MainWindow::run() {
  if (session_.acceptedCount() == 0) {
    showStep(Step::Segment);
    statusBar()->showMessage(tr("Outline the liver first: there is nothing to retract."));
    return;
  }
  if (step() == Step::Load || step() == Step::Segment) showStep(Step::Retract);
  session_.run();
}

namespace {

/// Libraries that are linked, with their licences (SPDX).
QString libraries() {
  constexpr std::array<std::array<const char*, 2>, 17> all = {
      {{"Qt 6", "LGPL-3.0"},
       {"VTK", "BSD-3-Clause"},
       {"ITK", "Apache-2.0"},
       {"DCMTK", "BSD-3-Clause"},
       {"Eigen", "MPL-2.0"},
       {"CGAL", "GPL-3.0-or-later"},
       {"SuiteSparse CHOLMOD", "GPL-2.0-or-later"},
       {"OpenBLAS", "BSD-3-Clause"},
       {"oneTBB", "Apache-2.0"},
       {"OpenIGTLink", "BSD-3-Clause"},
       {"OpenSSL", "Apache-2.0"},
       {"libarchive", "BSD-2-Clause"},
       {"cairo", "LGPL-2.1 or MPL-1.1"},
       {"FreeType", "FTL"},
       {"libpng, zlib, OpenJPEG", "libpng-2.0, Zlib, BSD-2-Clause"},
       {"nlohmann/json", "MIT"},
       {"CLI11", "BSD-3-Clause"}}};
  QString text;
  for (const auto& [name, licence] : all)
    text += QStringLiteral("\n%1: %2").arg(QLatin1String(name), QLatin1String(licence));
  return text;
}

}  // namespace

void MainWindow::about() {
  QMessageBox box(this);
  box.setWindowTitle(tr("About Glisson"));
  box.setIconPixmap(icon(QStringLiteral("glisson")).pixmap(72, 72));
  box.setText(tr("<h2>Glisson %1</h2><p><b>%2</b></p><p>Patient-specific biomechanics of the liver from MRI and MR "
                 "elastography.</p><p>Numbers and reference ranges only, never a diagnosis.</p>"
                 "<p>Free software under the GNU General Public License, version 3 or later.</p>")
                  .arg(QString::fromStdString(version()), tr(researchUseOnly)));
  box.setInformativeText(tr(
      "<p>By the Glisson maintainers. It reproduces, and goes on from: Barrow et al., <i>Patient Specific Biomechanics "
      "Are Clinically Significant In Accurate Computer Aided Surgical Image Guidance</i>. Cite that paper, and Glisson "
      "with its version.</p>"));
  box.setDetailedText(tr("Built with these libraries, under their own licences:") + libraries());
  box.exec();
}

void MainWindow::showKeys() {
  if (!sheet_) sheet_ = new KeySheet(*keys_, this);
  sheet_->show();
  sheet_->raise();
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!mayDiscard()) {
    event->ignore();
    return;
  }
  if (remembers_) QSettings().setValue(geometryKey, saveGeometry());
  event->accept();
}

void MainWindow::rememberPlace() {
  remembers_ = true;
  restoreGeometry(QSettings().value(geometryKey).toByteArray());
}

}  // namespace glisson::panels

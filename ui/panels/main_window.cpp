#include "panels/main_window.h"

#include <QAction>
#include <QActionGroup>
#include <QApplication>
#include <QCloseEvent>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QStackedWidget>
#include <QStatusBar>
#include <cmath>

#include "base/version.h"
#include "panels/compare_page.h"
#include "panels/load_page.h"
#include "panels/model_page.h"
#include "panels/retract_page.h"
#include "panels/segment_page.h"
#include "panels/step_rail.h"
#include "panels/theme.h"
#include "views/slice_view.h"

namespace glisson::panels {

using session::Session;
using session::Step;

namespace {

QString timeText(double seconds) {
  if (seconds < 0.0) return {};
  if (seconds < 60.0) return MainWindow::tr(", %1 s left").arg(std::ceil(seconds), 0, 'f', 0);
  return MainWindow::tr(", %1 min left").arg(std::ceil(seconds / 60.0), 0, 'f', 0);
}

}  // namespace

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent),
      rail_(new StepRail),
      pages_(new QStackedWidget),
      load_(new LoadPage(session_)),
      segment_(new SegmentPage(session_)),
      model_(new ModelPage(session_)),
      retract_(new RetractPage(session_)),
      compare_(new ComparePage(session_)),
      progress_(new QProgressBar),
      progressText_(new QLabel),
      cancel_(new QPushButton(tr("Cancel"))) {
  setObjectName(QStringLiteral("mainWindow"));
  setWindowTitle(tr("Glisson[*] – %1").arg(tr(researchUseOnly)));
  setWindowIcon(icon(QStringLiteral("glisson")));
  setAcceptDrops(true);
  resize(1480, 900);
  for (QWidget* page : {static_cast<QWidget*>(load_), static_cast<QWidget*>(segment_), static_cast<QWidget*>(model_),
                        static_cast<QWidget*>(retract_), static_cast<QWidget*>(compare_)})
    pages_->addWidget(page);
  auto* centre = new QWidget;
  auto* row = new QHBoxLayout(centre);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  row->addWidget(rail_);
  row->addWidget(pages_, 1);
  setCentralWidget(centre);
  makeMenus();
  makeStatusLine();
  connectSession();
  refreshIcons();
  showStep(Step::Load);
  updateStatus();
}

void MainWindow::makeMenus() {
  const auto add = [this](QMenu* menu, const char* name, const QString& text, const QKeySequence& keys, auto slot) {
    QAction* action = menu->addAction(text);
    action->setObjectName(QString::fromLatin1(name));
    action->setShortcut(keys);
    connect(action, &QAction::triggered, this, slot);
    return action;
  };
  QMenu* file = menuBar()->addMenu(tr("&File"));
  add(file, "openAction", tr("&Open DICOM folder…"), QKeySequence::Open, &MainWindow::openFolder);
  add(file, "syntheticAction", tr("Synthetic &patient"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_N),
      &MainWindow::openSynthetic);
  file->addSeparator();
  importAction_ = add(file, "importAction", tr("&Import outlines…"), QKeySequence(Qt::CTRL | Qt::Key_I),
                      &MainWindow::importOutlines);
  saveAction_ = add(file, "saveAction", tr("&Save case…"), QKeySequence::Save, &MainWindow::saveCase);
  file->addSeparator();
  add(file, "quitAction", tr("&Quit"), QKeySequence::Quit, &QWidget::close);
  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  undoAction_ = add(edit, "undoAction", tr("&Undo"), QKeySequence::Undo, [this] { session_.undo(); });
  redoAction_ =
      add(edit, "redoAction", tr("&Redo"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), [this] { session_.redo(); });
  edit->addSeparator();
  interpolateAction_ = add(edit, "interpolateAction", tr("&Interpolate between slices"), QKeySequence(Qt::Key_B),
                           [this] { session_.interpolateOutlines(); });
  acceptAllAction_ = add(edit, "acceptAllAction", tr("&Accept all interpolated outlines"),
                         QKeySequence(Qt::SHIFT | Qt::Key_B), [this] { session_.acceptInterpolated(); });
  QMenu* work = menuBar()->addMenu(tr("&Run"));
  runAction_ =
      add(work, "runAction", tr("&Build, retract and compare"), QKeySequence(Qt::CTRL | Qt::Key_R), &MainWindow::run);
  add(work, "cancelAction", tr("&Cancel"), QKeySequence(Qt::CTRL | Qt::Key_Period), [this] { session_.cancel(); });
  QMenu* view = menuBar()->addMenu(tr("&View"));
  auto* themes = new QActionGroup(this);
  for (const Theme theme : {Theme::Dark, Theme::Light}) {
    QAction* action = add(view, theme == Theme::Dark ? "darkTheme" : "lightTheme",
                          theme == Theme::Dark ? tr("&Dark theme") : tr("&Light theme"), {}, [this, theme] {
                            applyTheme(theme);
                            refreshIcons();
                          });
    action->setCheckable(true);
    action->setChecked(theme == currentTheme());
    themes->addAction(action);
  }
  view->addSeparator();
  add(view, "fitAction", tr("&Fit images"), QKeySequence(Qt::CTRL | Qt::Key_0), [this] {
    segment_->mriView()->fit();
    segment_->mreView()->fit();
  });
  QMenu* help = menuBar()->addMenu(tr("&Help"));
  add(help, "aboutAction", tr("&About Glisson"), {}, &MainWindow::about);
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
  connect(segment_, &SegmentPage::importWanted, this, &MainWindow::importOutlines);
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
    if (session_.images().mri && step() == Step::Load) showStep(Step::Segment);
  });
  connect(&session_, &Session::runFinished, this, [this] { showStep(Step::Compare); });
}

void MainWindow::showProgress(double fraction, const QString& what, double secondsLeft) {
  progress_->setValue(static_cast<int>(std::lround(fraction * 1000.0)));
  if (cancel_->isEnabled()) progressText_->setText(what + timeText(secondsLeft));
}

void MainWindow::updateStatus() {
  for (const Step step : session::steps) rail_->setStatus(step, session_.status(step));
  const bool open = session_.images().mri != nullptr;
  undoAction_->setEnabled(session_.canUndo());
  undoAction_->setText(session_.canUndo() ? tr("&Undo %1").arg(session_.undoText()) : tr("&Undo"));
  redoAction_->setEnabled(session_.canRedo());
  redoAction_->setText(session_.canRedo() ? tr("&Redo %1").arg(session_.redoText()) : tr("&Redo"));
  importAction_->setEnabled(open);
  saveAction_->setEnabled(open);
  runAction_->setEnabled(session_.acceptedCount() > 0 && !session_.busy());
  const session::OutlineCoverage outlines = session_.coverage();
  interpolateAction_->setEnabled(outlines.drawn.size() > 1 &&
                                 outlines.empty.size() + outlines.interpolated.size() > 0 && !session_.busy());
  acceptAllAction_->setEnabled(!outlines.interpolated.empty());
  setWindowModified(session_.modified());
}

void MainWindow::refreshIcons() {
  for (QPushButton* b : findChildren<QPushButton*>()) {
    const QString name = b->property("iconName").toString();
    if (!name.isEmpty()) b->setIcon(icon(name, b->property("primary").toBool() ? QColor(Qt::white) : QColor()));
  }
}

void MainWindow::showStep(Step step) {
  rail_->setCurrent(step);
  pages_->setCurrentIndex(static_cast<int>(step));
  if (step == Step::Segment) segment_->mriView()->setFocus();
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

bool MainWindow::mayDiscard() {
  if (!session_.modified()) return true;
  return QMessageBox::question(this, tr("Outlines are not saved"),
                               tr("The outlines of this case are not saved. Go on without saving them?"),
                               QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Cancel) == QMessageBox::Discard;
}

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
  if (file.isEmpty()) return;
  attempt(tr("Import outlines"), [&] { session_.importContours(file); });
  showStep(Step::Segment);
}

void MainWindow::saveCase() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Save case into a folder"));
  if (folder.isEmpty()) return;
  attempt(tr("Save case"), [&] {
    session_.saveCase(folder);
    statusBar()->showMessage(tr("Saved. Run it again with: glisson-cli run scene.json"), 12000);
  });
}

void MainWindow::run() {
  if (step() == Step::Load || step() == Step::Segment) showStep(Step::Retract);
  session_.run();
}

void MainWindow::about() {
  QMessageBox box(this);
  box.setWindowTitle(tr("About Glisson"));
  box.setIconPixmap(icon(QStringLiteral("glisson")).pixmap(72, 72));
  box.setText(tr("<h2>Glisson %1</h2><p><b>%2</b></p><p>Patient-specific biomechanics of the liver from MRI and MR "
                 "elastography.</p><p>Numbers and reference ranges only, never a diagnosis.</p>"
                 "<p>Free software under the GNU General Public License, version 3 or later.</p>")
                  .arg(QString::fromStdString(version()), tr(researchUseOnly)));
  box.exec();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.isEmpty() || !urls.front().isLocalFile() || !mayDiscard()) return;
  showStep(Step::Load);
  session_.openPath(urls.front().toLocalFile());
}

void MainWindow::closeEvent(QCloseEvent* event) {
  mayDiscard() ? event->accept() : event->ignore();
}

}  // namespace glisson::panels

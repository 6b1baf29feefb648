// The 3-D views through real events, on one window with the synthetic patient: what they show, what the mouse places
// and chooses in them, and that the window answers while they draw.
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QSlider>
#include <QTest>
#include <cmath>

#include "panels/compare_page.h"
#include "panels/live_bar.h"
#include "panels/main_window.h"
#include "panels/retract_page.h"
#include "panels/theme.h"
#include "session/stall_monitor.h"
#include "support/support.h"
#include "views/scene_view.h"

using glisson::panels::MainWindow;
using glisson::session::Session;
using glisson::session::StallMonitor;
using glisson::session::Step;
using glisson::views::SceneView;

namespace {

constexpr int wait_ms = 300000;

}  // namespace

class Scene3D : public QObject {
  Q_OBJECT

 private:
  glisson::test::TemporaryFolder folder_;
  std::unique_ptr<MainWindow> window_;

  Session& session() { return window_->session(); }
  template <typename W>
  W* find(const char* name) {
    W* found = window_->findChild<W*>(QString::fromLatin1(name));
    if (!found) qFatal("no widget is called %s", name);
    return found;
  }
  QString path(const char* name) { return QString::fromStdString((folder_ / name).string()); }
  /// A window with the synthetic patient and the outlines of its own structure set.
  std::unique_ptr<MainWindow> open() {
    auto window = std::make_unique<MainWindow>();
    window->session().setJournalFolder(path("journals"));
    window->session().setWorkFolder(path("work"));
    window->show();
    QSignalSpy loaded(&window->session(), &Session::loaded);
    window->session().openSynthetic(3, path("patients"));
    if (!loaded.wait(wait_ms)) qFatal("the synthetic patient was not opened");
    window->session().importContours(path("patients/synthetic-patient-3/rtstruct.dcm"));
    return window;
  }
  /// Turns the view with the left button, in steps of some pixels.
  void turn(QWidget* canvas, int steps) {
    const QPoint from(canvas->width() / 4, canvas->height() / 4);
    QTest::mousePress(canvas, Qt::LeftButton, {}, from);
    for (int n = 1; n <= steps; ++n) {
      QTest::mouseMove(canvas, from + QPoint(3 * n, n));
      QTest::qWait(15);
    }
    QTest::mouseRelease(canvas, Qt::LeftButton, {}, from + QPoint(3 * steps, steps));
  }

 private slots:
  void initTestCase() {
    glisson::panels::applyTheme(glisson::panels::Theme::Dark);
    QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, path("settings"));
    window_ = open();
    auto parameters = session().parameters();
    parameters.cell_mm = 6.0;
    session().setParameters(parameters);
  }

  void theWindowAnswersWhileTheFirstSceneIsDrawn() {
    auto* compare = window_->findChild<glisson::panels::ComparePage*>();
    auto* live = window_->findChild<glisson::panels::LiveBar*>();
    auto* view = find<SceneView>("retractView");
    QSignalSpy ended(&session(), &Session::workEnded);
    QSignalSpy retractDrawn(view, &SceneView::rendered);
    QSignalSpy compareDrawn(compare->sceneView(), &SceneView::rendered);
    StallMonitor all, part;
    const auto told = [&part](const char* when) {
      const auto r = part.report();
      qInfo("%s: %zu looks, 99 %% within %.1f ms, the longest %.1f ms", when, r.looks, r.p99_ms, r.max_ms);
      part.restart();
    };
    window_->showStep(Step::Retract);
    QTest::mouseClick(find<QPushButton>("runButton"), Qt::LeftButton);
    QVERIFY(ended.wait(wait_ms));
    QVERIFY(session().result());
    told("running");
    QVERIFY(compareDrawn.count() > 0 || compareDrawn.wait(wait_ms));
    told("first scene, Compare");
    QTRY_VERIFY_WITH_TIMEOUT(live->isReady(), wait_ms);
    window_->showStep(Step::Retract);
    QVERIFY(retractDrawn.count() > 0 || retractDrawn.wait(wait_ms));
    told("first scene, Retract");
    const auto before = view->camera();
    turn(view, 40);
    QVERIFY(!(view->camera() == before));
    QTest::qWait(400);
    told("turned");
    find<QSlider>("timeSlider")->setValue(50);
    QVERIFY(retractDrawn.wait(wait_ms));
    told("half of the way");
    QTest::mouseClick(find<QPushButton>("liveButton"), Qt::LeftButton);
    QVERIFY(retractDrawn.wait(wait_ms));
    told("live");
    auto* slider = find<QSlider>("liveSliderP");
    const auto frames = retractDrawn.count();
    for (int n = 0; n < 30; ++n) {
      QTest::keyClick(slider, Qt::Key_Right);
      QTest::qWait(15);
    }
    QVERIFY(retractDrawn.count() > frames || retractDrawn.wait(wait_ms));
    told("moved live");
    QTest::mouseClick(find<QPushButton>("liveButton"), Qt::LeftButton);
    const auto r = all.report();
    qInfo("all of it: %zu looks, 99 %% within %.1f ms, the longest %.1f ms", r.looks, r.p99_ms, r.max_ms);
    QVERIFY2(r.p99_ms <= 50.0, qPrintable(QString::number(r.p99_ms)));
    QVERIFY2(r.max_ms <= 100.0, qPrintable(QString::number(r.max_ms)));
  }

  void cleanupTestCase() { window_.reset(); }
};

QTEST_MAIN(Scene3D)
#include "scene3d_test.moc"

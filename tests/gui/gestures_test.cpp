// Gestures and keys through real events, on one window with the synthetic patient; random events; stalls; recovery.
#include <QApplication>
#include <QDialog>
#include <QMenu>
#include <QMouseEvent>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QTest>
#include <QTreeWidget>
#include <QWheelEvent>
#include <cmath>

#include "base/random.h"
#include "panels/image_layers.h"
#include "panels/main_window.h"
#include "panels/segment_page.h"
#include "panels/theme.h"
#include "pipeline/sources.h"
#include "roi/contour_stack.h"
#include "session/stall_monitor.h"
#include "support/support.h"
#include "tools/keymap.h"
#include "views/slice_view.h"

using glisson::Random;
using glisson::panels::ImageLayers;
using glisson::panels::MainWindow;
using glisson::panels::SegmentPage;
using glisson::session::Session;
using glisson::session::StallMonitor;
using glisson::tools::ToolState;
using glisson::views::SliceView;

namespace {

constexpr int wait_ms = 300000;

bool same(const glisson::roi::ContourStack& a, const glisson::roi::ContourStack& b) {
  if (a.polygons.size() != b.polygons.size()) return false;
  for (std::size_t p = 0; p < a.polygons.size(); ++p)
    if (a.polygons[p].points_lps_mm.cols() != b.polygons[p].points_lps_mm.cols() ||
        a.polygons[p].points_lps_mm != b.polygons[p].points_lps_mm || a.polygons[p].state != b.polygons[p].state)
      return false;
  return true;
}

void wheel(QWidget* on, const QPoint& at, int delta, Qt::KeyboardModifiers modifiers = {}) {
  QWheelEvent event(at, on->mapToGlobal(at), {}, {0, delta}, Qt::NoButton, modifiers, Qt::NoScrollPhase, false);
  QApplication::sendEvent(on, &event);
}

void mouse(QWidget* on, QEvent::Type type, const QPoint& at, Qt::MouseButton button, Qt::MouseButtons buttons,
           Qt::KeyboardModifiers modifiers = {}) {
  QMouseEvent event(type, at, on->mapToGlobal(at), button, buttons, modifiers);
  QApplication::sendEvent(on, &event);
}

void drag(QWidget* on, const QPoint& from, const QPoint& to, Qt::MouseButton button = Qt::LeftButton,
          Qt::KeyboardModifiers modifiers = {}) {
  mouse(on, QEvent::MouseButtonPress, from, button, button, modifiers);
  for (int s = 1; s <= 8; ++s)
    mouse(on, QEvent::MouseMove, from + (to - from) * s / 8, Qt::NoButton, button, modifiers);
  mouse(on, QEvent::MouseButtonRelease, to, button, Qt::NoButton, modifiers);
}

}  // namespace

class Gestures : public QObject {
  Q_OBJECT

 private:
  glisson::test::TemporaryFolder folder_;
  std::unique_ptr<MainWindow> window_;

  Session& session() { return window_->session(); }
  SliceView* mri() { return window_->findChild<SliceView*>("mriView"); }
  SliceView* mre() { return window_->findChild<SliceView*>("mreView"); }
  SegmentPage* page() { return window_->findChild<SegmentPage*>(); }
  QString path(const char* name) { return QString::fromStdString((folder_ / name).string()); }
  const auto& polygons() { return session().contours().polygons; }
  void clean() {
    while (session().canUndo()) session().undo();
    session().tool().deselect();
  }
  /// Where the elastogram is trusted most, in pixels of the MRI view: well inside the liver.
  QPoint liver() {
    const auto& map = *session().images().stiffness;
    const auto& grid = map.values_kPa.grid;
    const int k = grid.size.z() / 2;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double n = 0.0;
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        if (map.confidence->at(i, j, k) >= 0.95F) sum += grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k}), n += 1.0;
    mri()->showPoint(sum / n);
    const Eigen::Vector2d px = mri()->plane().toPixel(sum / n);
    return QPointF(px.x(), px.y()).toPoint();
  }
  void square(int x, int y, int side) {
    for (const QPoint at : {QPoint(x, y), QPoint(x + side, y), QPoint(x + side, y + side), QPoint(x, y + side)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
    QTest::keyClick(mri(), Qt::Key_Return);
  }
  std::unique_ptr<MainWindow> open(const QString& journals) {
    auto window = std::make_unique<MainWindow>();
    window->session().setWorkFolder(path("work"));
    window->session().setJournalFolder(journals);
    window->show();
    return window;
  }

 private slots:
  void initTestCase() {
    QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, path("settings"));
    glisson::panels::applyTheme(glisson::panels::Theme::Dark);
    window_ = open(path("journals"));
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QSignalSpy loaded(&session(), &Session::loaded);
    session().openSynthetic(3, path("patients"));
    QVERIFY(loaded.wait(wait_ms));
    QVERIFY(session().images().mri && session().images().stiffness);
    mri()->setSlice(mri()->sliceCount() / 2);
  }

  void zoomPanAndWindowKeepTheDrawing() {
    QTest::mouseClick(mri(), Qt::LeftButton, {}, QPoint(150, 150));
    QTest::mouseClick(mri(), Qt::LeftButton, {}, QPoint(250, 150));
    const Eigen::Matrix3Xd drawn = session().tool().drawing();
    const double zoom = mri()->zoom_px_mm(), low = mri()->volume().low, high = mri()->volume().high;
    drag(mri(), {200, 200}, {200, 140}, Qt::RightButton);
    QVERIFY(mri()->zoom_px_mm() > zoom);
    const Eigen::Vector3d centre = mri()->centre_lps();
    drag(mri(), {200, 200}, {230, 220}, Qt::MiddleButton);
    QVERIFY((mri()->centre_lps() - centre).norm() > 1.0);
    QTest::keyPress(mri(), Qt::Key_Space);
    drag(mri(), {230, 220}, {200, 200});
    QTest::keyRelease(mri(), Qt::Key_Space);
    QVERIFY((mri()->centre_lps() - centre).norm() < 1e-9);
    wheel(mri(), {200, 200}, -120, Qt::ControlModifier);
    drag(mri(), {200, 200}, {260, 230}, Qt::LeftButton, Qt::AltModifier);
    QVERIFY(mri()->volume().low != low || mri()->volume().high != high);
    QCOMPARE(session().tool().state(), ToolState::Drawing);
    QVERIFY(session().tool().drawing() == drawn);
    QVERIFY(polygons().empty());
    mri()->fit();
    QTest::keyClick(mri(), Qt::Key_0);
    QCOMPARE(mri()->volume().low, low);
    QCOMPARE(mri()->volume().high, high);
  }

  void theWheelChangesTheSliceAndParksTheDrawing() {
    const int slice = mri()->slice();
    wheel(mri(), {200, 200}, 120);
    QCOMPARE(mri()->slice(), slice + 1);
    QCOMPARE(polygons().size(), std::size_t{1});
    QCOMPARE(polygons()[0].state, glisson::roi::PolygonState::Draft);
    clean();
  }

  void linkedViewsMoveTogetherAndUnlinkedOnesDoNot() {
    QVERIFY(page()->linked());
    wheel(mri(), {200, 200}, 120, Qt::ControlModifier);
    QCOMPARE(mre()->zoom_px_mm(), mri()->zoom_px_mm());
    QVERIFY((mre()->centre_lps() - mri()->centre_lps()).head<2>().norm() < 1.0);
    QTest::keyClick(mri(), Qt::Key_L);
    wheel(mri(), {200, 200}, 120, Qt::ControlModifier);
    QVERIFY(mre()->zoom_px_mm() != mri()->zoom_px_mm());
    QTest::keyClick(mri(), Qt::Key_L);
    mri()->fit();
    mre()->fit();
  }

  void keysOfSlicesMarksAndPaste() {
    clean();
    const int middle = mri()->sliceCount() / 2;
    mri()->setSlice(middle);
    square(160, 160, 120);
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(session().acceptedCount(), std::size_t{1});
    QTest::keyClick(mri(), Qt::Key_C, Qt::ControlModifier);
    mri()->setSlice(middle + 4);
    QTest::keyClick(mri(), Qt::Key_V, Qt::ControlModifier | Qt::ShiftModifier);
    QCOMPARE(polygons().size(), std::size_t{5});
    QCOMPARE(session().coverage().interpolated.size(), std::size_t{4});
    session().undo();  // one step
    QCOMPARE(polygons().size(), std::size_t{1});
    QTest::keyClick(mri(), Qt::Key_V, Qt::ControlModifier);
    QCOMPARE(polygons().size(), std::size_t{2});
    QCOMPARE(glisson::tools::sliceOf(polygons()[1], mri()->plane().grid), middle + 4);
    QCOMPARE(session().tool().state(), ToolState::Editing);
    const Eigen::Matrix3Xd before = polygons()[1].points_lps_mm;
    QTest::keyClick(mri(), Qt::Key_Right, Qt::ShiftModifier);
    QVERIFY(std::abs((polygons()[1].points_lps_mm - before).col(0).norm() - mri()->plane().grid.spacing_mm.x()) < 1e-9);
    QTest::keyClick(mri(), Qt::Key_X);
    QVERIFY(polygons()[1].exclude);
    QTest::keyClick(mri(), Qt::Key_I);
    QVERIFY(!polygons()[1].exclude);
    QTest::keyClick(mri(), Qt::Key_D, Qt::ControlModifier);
    QTest::keyClick(mri(), Qt::Key_Up);
    QCOMPARE(mri()->slice(), middle + 5);
    QTest::keyClick(mri(), Qt::Key_End);
    QCOMPARE(mri()->slice(), mri()->sliceCount() - 1);
    QTest::keyClick(mri(), Qt::Key_A);
    QCOMPARE(session().markOf(mri()->slice()), glisson::commands::SliceMark::NoLiver);
    QTest::keyClick(mri(), Qt::Key_N);
    QCOMPARE(mri()->slice(), 0);
    mri()->setSlice(middle);
    QTest::keyClick(mri(), Qt::Key_A);
    QVERIFY(!session().markOf(middle));  // there is an outline
    QTest::keyClick(mri(), Qt::Key_S);
    QCOMPARE(session().markOf(middle), glisson::commands::SliceMark::NoWave);
    session().undo();
    QVERIFY(!session().markOf(middle));
  }

  void theInnerRegionErodesWhatIsMeasured() {
    clean();
    const QPoint at = liver();
    square(at.x() - 50, at.y() - 50, 100);
    QTest::keyClick(mri(), Qt::Key_Return);
    QTRY_VERIFY(session().statistics().pooled.has_value());
    const auto whole = session().statistics().pooled->pooled.n_before_mask;
    QTest::keyClick(mri(), Qt::Key_E);
    QTRY_VERIFY(session().statistics().pooled && session().statistics().pooled->pooled.n_before_mask < whole);
    const auto three = session().statistics().pooled->pooled.n_before_mask;
    QVERIFY(session().innerMask());
    QTest::keyClick(mri(), Qt::Key_BracketRight);
    QCOMPARE(session().measureSettings().erosion_pixels, 4);
    QTRY_VERIFY(session().statistics().pooled && session().statistics().pooled->pooled.n_before_mask < three);
    QTest::keyClick(mri(), Qt::Key_BracketLeft);
    QTest::keyClick(mri(), Qt::Key_E);
    QTRY_VERIFY(session().statistics().pooled && session().statistics().pooled->pooled.n_before_mask == whole);
  }

  void aSliceWithoutWaveIsLeftOutHereAndByTheCommandLine() {
    QTRY_VERIFY(session().statistics().pooled.has_value());
    const auto whole = session().statistics().pooled->pooled.n;
    const int k = mri()->slice();
    QTest::keyClick(mri(), Qt::Key_C, Qt::ControlModifier);
    mri()->setSlice(k + 8);
    QTest::keyClick(mri(), Qt::Key_V, Qt::ControlModifier | Qt::ShiftModifier);
    QTRY_VERIFY(session().statistics().pooled && session().statistics().pooled->pooled.n > whole);
    const auto more = session().statistics().pooled->pooled.n;
    QTest::keyClick(mri(), Qt::Key_S);
    QTRY_VERIFY(session().statistics().pooled && session().statistics().pooled->pooled.n < more);
    session().saveCase(path("no-wave"));
    const auto& images = session().images();
    glisson::pipeline::LoadedRoi roi =
        glisson::pipeline::loadRoi(folder_ / "no-wave" / "contours-measured.json", {}, 0);
    const auto mapped = glisson::pipeline::mapRoi(roi, images.mri->grid, *images.stiffness);
    const auto again = glisson::elastography::measure(*images.stiffness, mapped.mask);
    QTRY_COMPARE(session().statistics().pooled->pooled.n, again.pooled.n);
    QCOMPARE(session().statistics().pooled->pooled.mean_kPa, again.pooled.mean_kPa);
    QCOMPARE(session().statistics().pooled->pooled.sd_kPa, again.pooled.sd_kPa);
  }

  void twoReadersAreCompared() {
    session().loadSecondReader(path("no-wave"));
    QSignalSpy compared(&session(), &Session::readersCompared);
    session().compareReaders();
    QVERIFY(compared.wait(wait_ms));
    QVERIFY2(compared[0][0].toString().contains("Dice 1.000"), qPrintable(compared[0][0].toString()));
    if (auto* box = window_->findChild<QDialog*>("readersBox")) box->close();
    session().loadSecondReader({});
    QVERIFY(session().secondReader().polygons.empty());
  }

  void scalesPresetsLayersAndRuler() {
    QTest::keyClick(mri(), Qt::Key_K);
    QCOMPARE(mre()->volume().high, 20.0);
    QTest::keyClick(mri(), Qt::Key_K);
    QCOMPARE(mre()->volume().high, 8.0);
    const double high = mri()->volume().high;
    QTest::keyClick(mri(), Qt::Key_5);
    QVERIFY(mri()->volume().high < high);
    QTest::keyClick(mri(), Qt::Key_0);
    for (const char* layer : {"layerMagnitude", "layerWave", "layerConfidence", "layerStiffness"}) {
      auto* b = window_->findChild<QPushButton*>(layer);
      QVERIFY(b && b->isEnabled());
      QTest::mouseClick(b, Qt::LeftButton);
      QVERIFY(mre()->hasVolume());
    }
    QVERIFY(mre()->volume().stiffness);
    QTest::keyClick(mri(), Qt::Key_M);
    const auto count = polygons().size();
    drag(mri(), {100, 100}, {100, 200});
    QCOMPARE(polygons().size(), count);
    QCOMPARE(page()->measurements().distances().size(), std::size_t{1});
    QVERIFY(std::abs(page()->measurements().distances()[0].length_mm() - 100.0 / mri()->zoom_px_mm()) < 1e-6);
    QTest::keyClick(mri(), Qt::Key_P);
    QCOMPARE(page()->hand(), SegmentPage::Hand::Outline);
  }

  void theSheetListsEveryKeyAndGesture() {
    QTest::keyClick(mri(), Qt::Key_F1);
    auto* sheet = window_->findChild<QDialog*>("keySheet");
    QVERIFY(sheet && sheet->isVisible());
    QCOMPARE(static_cast<std::size_t>(sheet->findChild<QTreeWidget*>("keyTable")->topLevelItemCount()),
             glisson::tools::commandCount);
    QCOMPARE(static_cast<std::size_t>(sheet->findChild<QTreeWidget*>("gestureTable")->topLevelItemCount()),
             glisson::tools::gestureTable().size());
    sheet->close();
  }

  void aRightClickOpensTheMenuAndADoubleClickTheProperties() {
    clean();
    square(160, 160, 120);
    QTest::keyClick(mri(), Qt::Key_Return);
    QTest::keyClick(mri(), Qt::Key_D, Qt::ControlModifier);
    QTest::mouseClick(mri(), Qt::RightButton, {}, QPoint(220, 220));
    auto* menu = window_->findChild<QMenu*>("outlineMenu");
    QVERIFY(menu && menu->isVisible());
    menu->close();
    QTest::keyClick(mri(), Qt::Key_D, Qt::ControlModifier);
    QTest::mouseClick(mri(), Qt::LeftButton, {}, QPoint(220, 220));
    mouse(mri(), QEvent::MouseButtonDblClick, {220, 220}, Qt::LeftButton, Qt::LeftButton);
    mouse(mri(), QEvent::MouseButtonRelease, {220, 220}, Qt::LeftButton, Qt::NoButton);
    auto* properties = window_->findChild<QDialog*>("outlineProperties");
    QVERIFY(properties && properties->isVisible());
    properties->close();
    QCOMPARE(polygons().size(), std::size_t{1});
    QCOMPARE(session().tool().drawing().cols(), Eigen::Index{0});
  }

  void theReadoutFollowsADragWithoutAStall() {
    clean();
    const QPoint middle = liver();
    square(middle.x() - 60, middle.y() - 60, 120);
    QTest::qWait(200);
    StallMonitor stalls;
    mouse(mri(), QEvent::MouseButtonPress, middle, Qt::LeftButton, Qt::LeftButton);
    for (int s = 0; s < 240; ++s) {
      const QPoint at =
          middle + QPoint(static_cast<int>(40 * std::sin(s * 0.1)), static_cast<int>(30 * std::cos(s * 0.07)));
      mouse(mri(), QEvent::MouseMove, at, Qt::NoButton, Qt::LeftButton);
      QTest::qWait(4);
    }
    mouse(mri(), QEvent::MouseButtonRelease, middle, Qt::LeftButton, Qt::NoButton);
    const auto r = stalls.report();
    qInfo("while dragging: p99 %.1f ms, longest %.1f ms, %zu looks", r.p99_ms, r.max_ms, r.looks);
    QVERIFY2(r.p99_ms <= 50.0, qPrintable(QString::number(r.p99_ms)));
    QVERIFY2(r.max_ms <= 100.0, qPrintable(QString::number(r.max_ms)));
  }

  /// 100,000 with GLISSON_RANDOM_EVENTS=100000.
  void randomEventsBreakNothingAndUndoGoesAllTheWay() {
    clean();
    const int events = std::max(qEnvironmentVariableIntValue("GLISSON_RANDOM_EVENTS"), 1500);
    Random random(static_cast<std::uint64_t>(std::max(qEnvironmentVariableIntValue("GLISSON_RANDOM_SEED"), 7)));
    const std::vector<int> keys = {Qt::Key_P,      Qt::Key_F,         Qt::Key_R,    Qt::Key_M,      Qt::Key_W,
                                   Qt::Key_Return, Qt::Key_Backspace, Qt::Key_Plus, Qt::Key_Minus,  Qt::Key_Escape,
                                   Qt::Key_Left,   Qt::Key_Up,        Qt::Key_N,    Qt::Key_A,      Qt::Key_S,
                                   Qt::Key_I,      Qt::Key_X,         Qt::Key_E,    Qt::Key_K,      Qt::Key_L,
                                   Qt::Key_Home,   Qt::Key_PageUp,    Qt::Key_2,    Qt::Key_Delete, Qt::Key_H};
    const std::vector<int> withCtrl = {Qt::Key_A, Qt::Key_D, Qt::Key_C, Qt::Key_V, Qt::Key_Z, Qt::Key_Return};
    for (int n = 0; n < events; ++n) {
      const QPoint at(static_cast<int>(random.below(static_cast<std::uint64_t>(mri()->width()))),
                      static_cast<int>(random.below(static_cast<std::uint64_t>(mri()->height()))));
      const QPoint to(static_cast<int>(random.below(static_cast<std::uint64_t>(mri()->width()))),
                      static_cast<int>(random.below(static_cast<std::uint64_t>(mri()->height()))));
      Qt::KeyboardModifiers modifiers;
      if (random.uniform() < 0.15) modifiers |= Qt::ShiftModifier;
      if (random.uniform() < 0.1) modifiers |= Qt::ControlModifier;
      switch (random.below(9)) {
        case 0:
        case 1:
        case 2:
          QTest::mouseClick(mri(), Qt::LeftButton, modifiers, at);
          break;
        case 3:
          drag(mri(), at, to, Qt::LeftButton, modifiers);
          break;
        case 4:
          drag(mri(), at, to, random.uniform() < 0.5 ? Qt::RightButton : Qt::MiddleButton);
          break;
        case 5:
          wheel(mri(), at, random.uniform() < 0.5 ? 120 : -120, modifiers);
          break;
        case 6:
          QTest::keyClick(mri(), static_cast<Qt::Key>(keys[random.below(keys.size())]));
          break;
        case 7:
          QTest::keyClick(mri(), static_cast<Qt::Key>(withCtrl[random.below(withCtrl.size())]), Qt::ControlModifier);
          break;
        default:
          mouse(mri(), QEvent::MouseButtonDblClick, at, Qt::LeftButton, Qt::LeftButton);
          mouse(mri(), QEvent::MouseButtonRelease, at, Qt::LeftButton, Qt::NoButton);
      }
      if (n % 50 == 0) {
        QCoreApplication::processEvents();
        for (QDialog* dialog : window_->findChildren<QDialog*>()) dialog->close();
        for (QMenu* menu : window_->findChildren<QMenu*>("outlineMenu")) menu->close();
        if (mri()->zoom_px_mm() > 20.0 || mri()->zoom_px_mm() < 0.5) mri()->fit();
      }
      // Outlines of a long day: the oldest go, as a hand would delete them.
      if (polygons().size() > 60) clean();
      for (const auto& p : polygons()) QVERIFY2(p.points_lps_mm.allFinite(), qPrintable(QString::number(n)));
      if (session().tool().selected()) QVERIFY(*session().tool().selected() < polygons().size());
    }
    for (QDialog* dialog : window_->findChildren<QDialog*>()) dialog->close();
    QTest::keyClick(mri(), Qt::Key_P);
    clean();
    QVERIFY(!session().canUndo());
    mri()->fit();
  }

  void aCaseComesBackAsItWasSaved() {
    clean();
    mri()->setSlice(mri()->sliceCount() / 2);
    square(160, 160, 120);
    QTest::keyClick(mri(), Qt::Key_Return);
    mri()->setSlice(0);
    QTest::keyClick(mri(), Qt::Key_A);
    session().saveCase(path("case"));
    QVERIFY(!session().modified());
    const auto saved = session().contours();
    window_.reset();  // gives the lock back
    window_ = open(path("journals"));
    QSignalSpy loaded(&session(), &Session::loaded);
    session().openPath(path("case") + "/case.json");
    QVERIFY(loaded.wait(wait_ms));
    QVERIFY(same(session().contours(), saved));
    QVERIFY(session().contours().marks == saved.marks);
    QCOMPARE(session().caseFolder(), path("case"));
    auto second = open(path("journals2"));
    QSignalSpy ended(&second->session(), &Session::workEnded);
    second->session().openPath(path("case"));
    QVERIFY(ended.wait(wait_ms));
    QVERIFY2(ended[0][1].toString().contains("open in another window"), qPrintable(ended[0][1].toString()));
  }

  void whatACrashLeftIsOfferedAndComesBackWithTheDrawingInWork() {
    mri()->setSlice(3);
    square(180, 180, 100);
    QTest::keyClick(mri(), Qt::Key_D, Qt::ControlModifier);
    for (const QPoint at : {QPoint(320, 160), QPoint(380, 160), QPoint(380, 220)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
    const auto drawn = session().contours();
    const Eigen::Matrix3Xd inWork = session().tool().drawing();
    QCOMPARE(inWork.cols(), Eigen::Index{3});
    // A copy of the journal is what a killed program leaves.
    std::filesystem::create_directories(folder_ / "crashed");
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "journals"))
      std::filesystem::copy_file(entry.path(), folder_ / "crashed" / "journal-1-0");
    window_.reset();
    window_ = open(path("crashed"));
    auto* recover = [&]() -> QPushButton* {
      QPushButton* found = nullptr;
      if (!QTest::qWaitFor([&] { return (found = window_->findChild<QPushButton*>("recoverButton")) != nullptr; }))
        return nullptr;
      return found;
    }();
    QVERIFY(recover);
    QSignalSpy loaded(&session(), &Session::loaded);
    QTest::mouseClick(recover, Qt::LeftButton);
    QVERIFY(loaded.wait(wait_ms));
    QCOMPARE(polygons().size(), drawn.polygons.size() + 1);
    QVERIFY(polygons().back().points_lps_mm == inWork);
    QCOMPARE(polygons().back().state, glisson::roi::PolygonState::Draft);
    for (std::size_t p = 0; p < drawn.polygons.size(); ++p)
      QVERIFY(polygons()[p].points_lps_mm == drawn.polygons[p].points_lps_mm);
    QVERIFY(session().modified());
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) {
  qputenv("QTEST_FUNCTION_TIMEOUT", "3600000");  // the long run of random events
  QApplication app(argc, argv);
  Gestures tests;
  return QTest::qExec(&tests, argc, argv);
}
#include "gestures_test.moc"

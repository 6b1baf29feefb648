// SPDX-License-Identifier: GPL-3.0-or-later

// Gestures and keys through real events, on one window with the synthetic patient; stalls; recovery.
#include <QDialog>
#include <QMenu>
#include <QPushButton>
#include <QTreeWidget>
#include <cmath>

#include "panels/image_layers.h"
#include "pipeline/sources.h"
#include "roi/agreement.h"
#include "session/stall_monitor.h"
#include "support/same_outlines.h"
#include "tools/keymap.h"
#include "window_bench.h"

using glisson::panels::SegmentPage;
using glisson::session::Session;
using glisson::session::StallMonitor;
using glisson::test::drag;
using glisson::test::mouse;
using glisson::test::same;
using glisson::test::wait_ms;
using glisson::test::wheel;
using glisson::tools::ToolState;

class Gestures : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private slots:
  void initTestCase() {
    QVERIFY(openSynthetic());
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
    QVERIFY(session().measureSettings().innerRoi);  // unless the reader wants the edge
    session().setMeasureSettings({false, 3});
    const QPoint at = showLiver();
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
        glisson::pipeline::loadRoi(folder() / "no-wave" / "contours-measured.json", {}, 0);
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
    if (auto* box = window().findChild<QDialog*>("readersBox")) box->close();
    session().loadSecondReader({});
    QVERIFY(session().secondReader().polygons.empty());
  }

  void aFirstOutlineIsProposedFromUnderTheMouse() {
    clean();
    const QPoint at = showLiver();
    const int k = mri()->slice();
    mouse(mri(), QEvent::MouseMove, at, Qt::NoButton, Qt::NoButton);
    QSignalSpy ended(&session(), &Session::workEnded);
    QTest::keyClick(mri(), Qt::Key_G);
    QVERIFY(session().busy());
    QVERIFY(ended.wait(wait_ms));
    QVERIFY2(ended[0][0].toBool(), qPrintable(ended[0][1].toString()));
    QVERIFY(!polygons().empty());
    for (const auto& p : polygons())
      QCOMPARE(p.state, glisson::roi::PolygonState::Interpolated);  // a proposal, no more
    QVERIFY(session().coverage().interpolated.contains(k));
    QVERIFY(session().coverage().interpolated.size() > 5);
    // It lies on the liver: on the reader's own outlines of this patient.
    const auto& grid = session().images().mri->grid;
    const auto truth =
        glisson::pipeline::loadRoi(folder() / "patients" / "synthetic-patient-3" / "rtstruct.dcm", {}, 0);
    QVERIFY(truth.contours.has_value());
    const auto agreement = glisson::roi::agreement(glisson::roi::rasterise(session().contours(), grid),
                                                   glisson::roi::rasterise(*truth.contours, grid));
    qInfo("proposed from one click: Dice %.3f against the patient's own outlines", agreement.dice);
    QVERIFY(agreement.dice > 0.8);
    // It is edited like any other: a vertex is moved, and the slice is accepted with that.
    const std::size_t accepted = session().acceptedCount();
    std::size_t mine = polygons().size();
    for (std::size_t p = 0; p < polygons().size(); ++p)
      if (mri()->plane().holds(polygons()[p])) mine = p;
    QVERIFY(mine < polygons().size());
    const QPoint vertex = pixelOf(polygons()[mine].points_lps_mm.col(0));
    drag(mri(), vertex, vertex + QPoint(0, 8));
    QVERIFY(session().acceptedCount() > accepted);
    session().undo();
    QCOMPARE(session().acceptedCount(), accepted);
    session().undo();  // the proposal is one step
    QVERIFY(polygons().empty());
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
      auto* b = window().findChild<QPushButton*>(layer);
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
    auto* sheet = window().findChild<QDialog*>("keySheet");
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
    auto* menu = window().findChild<QMenu*>("outlineMenu");
    QVERIFY(menu && menu->isVisible());
    menu->close();
    QTest::keyClick(mri(), Qt::Key_D, Qt::ControlModifier);
    QTest::mouseClick(mri(), Qt::LeftButton, {}, QPoint(220, 220));
    mouse(mri(), QEvent::MouseButtonDblClick, {220, 220}, Qt::LeftButton, Qt::LeftButton);
    mouse(mri(), QEvent::MouseButtonRelease, {220, 220}, Qt::LeftButton, Qt::NoButton);
    auto* properties = window().findChild<QDialog*>("outlineProperties");
    QVERIFY(properties && properties->isVisible());
    properties->close();
    QCOMPARE(polygons().size(), std::size_t{1});
    QCOMPARE(session().tool().drawing().cols(), Eigen::Index{0});
  }

  void theReadoutFollowsADragWithoutAStall() {
    clean();
    const QPoint middle = showLiver();
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
    glisson::test::judge(r);
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
    open(path("journals"));  // the window before gives the lock back
    QVERIFY(openPath(path("case") + "/case.json"));
    QVERIFY(same(session().contours(), saved));
    QVERIFY(session().contours().marks == saved.marks);
    QCOMPARE(session().caseFolder(), path("case"));
    auto second = make(path("journals2"));
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
    std::filesystem::create_directories(folder() / "crashed");
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "journals"))
      std::filesystem::copy_file(entry.path(), folder() / "crashed" / "journal-1-0");
    open(path("crashed"));
    auto* recover = [&]() -> QPushButton* {
      QPushButton* found = nullptr;
      if (!QTest::qWaitFor([&] { return (found = window().findChild<QPushButton*>("recoverButton")) != nullptr; }))
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

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Gestures)
#include "gestures_test.moc"

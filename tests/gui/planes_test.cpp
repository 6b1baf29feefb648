// SPDX-License-Identifier: GPL-3.0-or-later

// Three linked planes: reformats, the crosshair, the cut of what counts, the map over the MRI, one view alone.
#include <QApplication>
#include <QLabel>
#include <QPushButton>
#include <QSlider>

#include "image/resample.h"
#include "panels/plane_views.h"
#include "session/stall_monitor.h"
#include "tools/patient_planes.h"
#include "window_bench.h"

using glisson::panels::PlaneViews;
using glisson::session::Step;
using glisson::test::wait_ms;
using glisson::views::SliceView;

/// The functions run in order on one window with the synthetic patient and its own outlines.
class Planes : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  PlaneViews* planes() { return window().findChild<PlaneViews*>(); }
  SliceView* plane(int n) { return planes()->both()[static_cast<std::size_t>(n)]; }
  static QPoint pixelIn(const SliceView* view, const Eigen::Vector3d& p_lps) {
    const Eigen::Vector2d px = view->plane().toPixel(p_lps);
    return {qRound(px.x()), qRound(px.y())};
  }
  /// Whether the slice of a view goes through the point, to half a slice.
  static bool goesThrough(const SliceView* view, const Eigen::Vector3d& p_lps) {
    return std::abs(view->plane().grid.lpsToIndex(p_lps).z() - view->slice()) <= 0.501;
  }

 private slots:
  void initTestCase() {
    QVERIFY(openSynthetic());
    session().importContours(
        QString::fromStdString((folder() / "patients" / "synthetic-patient-3" / "rtstruct.dcm").string()));
    window().showStep(Step::Segment);
  }

  void theOtherPlanesAreReformatsOfTheSameVoxels() {
    QVERIFY(!planes()->isVisible());
    QSignalSpy made(planes(), &PlaneViews::reformatted);
    click("planesButton");
    QVERIFY(planes()->isVisible());
    QVERIFY(made.count() > 0 || made.wait(wait_ms));
    const auto& image = *session().images().mri;
    const auto across = glisson::tools::planesAcross(image.grid);
    for (int n = 0; n < 2; ++n) {
      const auto& reformat = *plane(n)->volume().values;
      QCOMPARE(glisson::tools::planeOf(reformat.grid), across[static_cast<std::size_t>(n)]);
      for (int step = 0; step < 50; ++step) {
        const Eigen::Vector3d p =
            image.grid.indexToLps({(step * 7) % image.grid.size.x() * 1.0, (step * 11) % image.grid.size.y() * 1.0,
                                   (step * 3) % image.grid.size.z() * 1.0});
        QCOMPARE(plane(n)->valueAt(p), std::optional<double>(mri()->valueAt(p)));
      }
    }
    QCOMPARE(plane(0)->volume().title, QStringLiteral("Coronal"));
    QCOMPARE(plane(1)->volume().title, QStringLiteral("Sagittal"));
  }

  void aClickInOnePlaneMovesTheOthersThere() {
    const Eigen::Vector3d liver = glisson::test::trustedPlace(session());
    page()->setCrosshair(liver);
    for (const SliceView* view : {mri(), plane(0), plane(1)}) QVERIFY(goesThrough(view, liver));
    // A place up and to the side, clicked in the coronal plane.
    const auto& grid = session().images().mri->grid;
    const Eigen::Vector3d wanted = liver + grid.direction * Eigen::Vector3d(20.0, 0.0, 4.0 * grid.spacing_mm.z());
    const int before = mri()->slice();
    QTest::mouseClick(plane(0), Qt::LeftButton, {}, pixelIn(plane(0), wanted));
    QCOMPARE(mri()->slice(), before + 4);
    QVERIFY(goesThrough(plane(1), wanted));
    // The wheel over the sagittal plane takes the crosshair of the coronal one along.
    const int column = plane(1)->slice();
    QTest::mouseMove(plane(1), plane(1)->rect().center());
    QTRY_VERIFY(plane(1)->underMouse());
    glisson::test::wheel(plane(1), plane(1)->rect().center(), 120);
    QCOMPARE(plane(1)->slice(), column + 1);
    // Another slice of the MRI is another height in both.
    mri()->setSlice(before);
    QVERIFY(goesThrough(mri(), liver));
  }

  void theCutIsThatOfWhatCounts() {
    QTRY_VERIFY_WITH_TIMEOUT(session().statistics().region != nullptr, wait_ms);
    page()->setCrosshair(glisson::test::trustedPlace(session()));
    const auto& region = *session().statistics().region;
    for (int n = 0; n < 2; ++n) {
      QTRY_VERIFY(!plane(n)->regionCut().empty());
      const auto& grid = plane(n)->plane().grid;
      // On one side of each edge a voxel counts, on the other none does.
      for (const auto& edge : plane(n)->regionCut()) {
        const Eigen::Vector2d along = (edge.to - edge.from).normalized(), middle = edge.from + 0.5 * along;
        const Eigen::Vector2d aside(0.5 * along.y(), 0.5 * along.x());
        const auto counts = [&](const Eigen::Vector2d& at) {
          const auto voxel =
              glisson::image::voxelAt(region.grid, grid.indexToLps({at.x(), at.y(), 1.0 * plane(n)->slice()}));
          return voxel && region.at(*voxel) != 0;
        };
        QVERIFY(counts(middle + aside) != counts(middle - aside));
      }
    }
    const QString volume = find<QLabel>("liverVolume")->text();
    QVERIFY2(volume.contains(QString::number(session().statistics().volume_mL, 'f', 0)), qPrintable(volume));
    QVERIFY(session().statistics().volume_mL > 300.0);
  }

  void theMapLiesOverTheMriAsFarAsItIsAskedFor() {
    page()->setCrosshair(glisson::test::trustedPlace(session()));
    const QImage plain = mri()->grab().toImage(), plainCoronal = plane(0)->grab().toImage();
    const Eigen::Vector3d liver = glisson::test::trustedPlace(session());
    QVERIFY(!mri()->fusedAt(liver));
    find<QSlider>("fusionSlider")->setValue(60);
    QCOMPARE(mri()->fusion().opacity, 0.6);
    QVERIFY(glisson::test::changed(plain, mri()->grab().toImage()) > 500);
    QVERIFY(glisson::test::changed(plainCoronal, plane(0)->grab().toImage()) > 100);
    const auto& map = session().images().stiffness->values_kPa;
    QCOMPARE(*mri()->fusedAt(liver), static_cast<double>(map.at(*glisson::image::voxelAt(map.grid, liver))));
    QTest::keyClick(mri(), Qt::Key_O);
    QCOMPARE(mri()->fusion().opacity, 0.0);
    QCOMPARE(find<QSlider>("fusionSlider")->value(), 0);
    QCOMPARE(glisson::test::changed(plain, mri()->grab().toImage()), 0);
    QTest::keyClick(mri(), Qt::Key_O);
    QCOMPARE(mri()->fusion().opacity, 0.6);
  }

  void anyViewFillsTheWindowAndGivesItBack() {
    const auto visible = [this] {
      return std::array{mri()->isVisible(), mre()->isVisible(), plane(0)->isVisible(), plane(1)->isVisible()};
    };
    const std::array all{true, true, true, true};
    QCOMPARE(visible(), all);
    const QSize small = plane(0)->size();
    QTest::mouseDClick(plane(0), Qt::LeftButton, {}, plane(0)->rect().center());
    QCOMPARE(visible(), (std::array{false, false, true, false}));
    QTRY_VERIFY2(plane(0)->width() > 3 * small.width() / 2 && plane(0)->height() > 3 * small.height() / 2,
                 qPrintable(QString("%1 × %2").arg(plane(0)->width()).arg(plane(0)->height())));
    QTest::mouseDClick(plane(0), Qt::LeftButton, {}, plane(0)->rect().center());
    QCOMPARE(visible(), all);
    QTest::mouseDClick(mre(), Qt::LeftButton, {}, mre()->rect().center());
    QCOMPARE(visible(), (std::array{false, true, false, false}));
    QTest::keyClick(mre(), Qt::Key_Z);
    QCOMPARE(visible(), all);
    QApplication::setActiveWindow(&window());  // a display without a window manager activates none
    mri()->setFocus();
    QTRY_VERIFY(mri()->hasFocus());
    QTest::keyClick(mri(), Qt::Key_Z);
    QCOMPARE(visible(), (std::array{true, false, false, false}));
    QTest::keyClick(mri(), Qt::Key_Z);
    QCOMPARE(visible(), all);
    QTest::keyClick(mri(), Qt::Key_T);
    QCOMPARE(visible(), (std::array{true, true, false, false}));
    QTest::keyClick(mri(), Qt::Key_T);
    QCOMPARE(visible(), all);
  }

  void slicesChangeAndTheMouseDrawsWithoutAStallWithAllPlanesOpen() {
    glisson::session::StallMonitor stalls;
    for (int step = 0; step < 30; ++step) {
      mri()->setSlice(mri()->slice() + (step < 15 ? 1 : -1));
      QTest::qWait(15);
    }
    qInfo("longest time without an answer with three planes: %.0f ms", stalls.report().max_ms);
    glisson::test::judge(stalls.report());
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Planes)
#include "planes_test.moc"

// SPDX-License-Identifier: GPL-3.0-or-later

// What is told about outlines while they are drawn and accepted, and what copies of them hold.
#include <QComboBox>
#include <QLabel>
#include <QStatusBar>
#include <QTreeWidget>

#include "panels/series_tree.h"
#include "window_bench.h"

namespace {

/// Counts how often something has got another size.
class Resizes : public QObject {
 public:
  int count = 0;
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() == QEvent::Resize) ++count;
    return false;
  }
};

}  // namespace

class Outlines : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private slots:
  void initTestCase() { QVERIFY(openSynthetic()); }

  void theSliceViewKeepsItsSizeWhileItIsDrawnOn() {
    clean();
    const Eigen::Vector3d centre = glisson::test::trustedPlace(session());
    mri()->showPoint(centre);
    const int here = mri()->slice();
    Resizes resizes;
    mri()->installEventFilter(&resizes);
    const QSize size = mri()->size();
    ellipse(centre, 30.0, 24.0, 12);
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(session().acceptedCount(), std::size_t{1});
    // A second outline is being drawn when the numbers of the first come, and everything else that the window may say.
    mri()->setSlice(here + 2);
    const QPoint first = pixelOf(centre);
    for (const QPoint off : {QPoint(0, 0), QPoint(60, 0), QPoint(60, 60)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, first + off);
    QTRY_VERIFY(session().statistics().pooled.has_value());
    QTRY_VERIFY(find<QLabel>("liveMean")->text().contains("kPa"));
    click("moreNumbers");
    emit session().message(QString(400, QLatin1Char('w')));
    emit session().workStarted(QString(60, QLatin1Char('w')));
    QTest::qWait(50);
    emit session().workEnded(true, {});
    QTest::qWait(50);
    qInfo("view of %d × %d before, %d × %d after; resized %d times", size.width(), size.height(), mri()->width(),
          mri()->height(), resizes.count);
    QCOMPARE(session().tool().state(), glisson::tools::ToolState::Drawing);
    QCOMPARE(resizes.count, 0);
    QCOMPARE(mri()->size(), size);
    QCOMPARE(pixelOf(centre), first);
    click("moreNumbers");
    QTest::keyClick(mri(), Qt::Key_Return);
    clean();
    mri()->setSlice(here);
  }

  void aHoleStaysLeftOutWhereverItIsPasted() {
    clean();
    const int here = mri()->slice();
    square(160, 160, 160);
    QTest::keyClick(mri(), Qt::Key_Return);
    const auto hole = [this] {
      QTest::mouseClick(mri(), Qt::LeftButton, Qt::ShiftModifier, {220, 220});
      for (const QPoint at : {QPoint(260, 220), QPoint(260, 260), QPoint(220, 260)})
        QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
      QTest::keyClick(mri(), Qt::Key_Return);
      QTest::keyClick(mri(), Qt::Key_Return);
    };
    hole();
    QCOMPARE(polygons().size(), std::size_t{2});
    session().copyOutlines();
    mri()->setSlice(here + 1);
    session().pasteOutlines();
    QVERIFY(polygons().back().exclude);
    session().undo();
    // The region takes its hole along, and one Enter accepts both.
    mri()->setSlice(here);
    session().tool().selectPolygon(0);
    session().copyOutlines();
    mri()->setSlice(here + 1);
    session().pasteOutlines();
    QCOMPARE(polygons().size(), std::size_t{4});
    QCOMPARE(session().tool().selected(), std::optional<std::size_t>(2));
    QVERIFY(!polygons()[2].exclude && polygons()[3].exclude);
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(session().acceptedCount(), std::size_t{4});
    clean();
    mri()->setSlice(here);
  }

  void aSliceBetweenThoseOfTheElastogramSaysWhichOneCounts() {
    clean();
    const int here = mri()->slice();
    const QPoint at = pixelOf(glisson::test::trustedPlace(session()));
    for (const int slice : {here, here + 1}) {
      mri()->setSlice(slice);
      square(at.x() - 40, at.y() - 40, 80);
      QTest::keyClick(mri(), Qt::Key_Return);
    }
    const QString note = QStringLiteral("slice %1 counts there").arg(here + 1);
    QTRY_VERIFY(find<QLabel>("liveReadout")->text().contains(note));
    mri()->setSlice(here);
    QTRY_VERIFY(!find<QLabel>("liveReadout")->text().contains("counts there"));
    clean();
  }

  void theStatusLineSaysWhatHappenedLast() {
    clean();
    const auto said = [this] { return window().statusBar()->currentMessage(); };
    square(160, 160, 120);
    QVERIFY2(said().startsWith("Closed."), qPrintable(said()));
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(said(), QStringLiteral("Accepted."));
    session().undo();
    QVERIFY2(said().startsWith("Undone"), qPrintable(said()));
    session().undo();
    for (const QPoint at : {QPoint(160, 160), QPoint(260, 260), QPoint(260, 160), QPoint(160, 260)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
    QTest::keyClick(mri(), Qt::Key_Return);
    QVERIFY2(said().contains("crosses itself"), qPrintable(said()));
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(said(), QStringLiteral("Accepted."));
    QTest::keyClick(mri(), Qt::Key_Delete);
    QVERIFY2(!said().contains("Accepted"), qPrintable(said()));
    clean();
    const int here = mri()->slice();
    for (const int slice : {here, here + 2}) {
      mri()->setSlice(slice);
      square(160, 160, 120);
      QTest::keyClick(mri(), Qt::Key_Return);
    }
    session().interpolateOutlines();
    QTRY_VERIFY2(said().contains("interpolated between"), qPrintable(said()));
    session().acceptInterpolated();
    QCOMPARE(said(), QStringLiteral("Interpolated outlines accepted: 1."));
    clean();
    mri()->setSlice(here);
  }

  void aCorrectedRoleStaysOnItsPageWhichMarksWhatIsInUse() {
    using glisson::session::Step;
    window().showStep(Step::Load);
    using glisson::panels::SeriesTree;
    auto* tree = find<SeriesTree>("seriesTree");
    const int mri = session().images().mriSeries, map = session().images().stiffnessSeries;
    const int confidence = session().images().confidenceSeries;
    for (int series = 0; series < static_cast<int>(session().scan().series.size()); ++series)
      QCOMPARE(tree->itemOf(series)->checkState(SeriesTree::Use) == Qt::Checked,
               series == mri || series == map || series == confidence);
    auto* role = tree->itemWidget(tree->itemOf(map), SeriesTree::Role)->findChild<QComboBox*>();
    QVERIFY(role);
    QSignalSpy loaded(&session(), &glisson::session::Session::loaded);
    role->setCurrentIndex(role->findData(static_cast<int>(glisson::dicom::SeriesRole::Other)));
    emit role->activated(role->currentIndex());
    QVERIFY(loaded.wait(glisson::test::wait_ms));
    QVERIFY(!session().images().stiffness && find<QWidget>("toSegmentButton")->isVisible());
    QCOMPARE(tree->itemOf(map)->checkState(SeriesTree::Use), Qt::Unchecked);
    click("toSegmentButton");
    QVERIFY(this->mri()->isVisible());
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Outlines)
#include "outlines_test.moc"

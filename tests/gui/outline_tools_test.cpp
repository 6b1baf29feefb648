// SPDX-License-Identifier: GPL-3.0-or-later

// Ellipse, brush, eraser, livewire, spline and combined outlines through real events, on the synthetic patient.
#include <QAction>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QStatusBar>

#include "session/journal.h"
#include "support/same_outlines.h"
#include "window_bench.h"

using glisson::roi::PolygonState;
using glisson::test::drag;
using glisson::test::mouse;
using glisson::tools::ToolMode;
using glisson::tools::ToolState;

class OutlineTools : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

  /// A picture of the window where GLISSON_SCREENSHOTS names a folder.
  void picture(const char* name) {
    if (const QString folder = qEnvironmentVariable("GLISSON_SCREENSHOTS"); !folder.isEmpty())
      window().grab().save(QStringLiteral("%1/%2.png").arg(folder, QLatin1String(name)));
  }
  void key(int key, Qt::KeyboardModifiers modifiers = {}) {
    QTest::keyClick(mri(), static_cast<Qt::Key>(key), modifiers);
  }
  QString said() { return window().statusBar()->currentMessage(); }
  double area() { return glisson::roi::area_mm2(session().contours()); }
  std::unique_ptr<glisson::session::Journalled> journalled() {
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "journals"))
      if (auto read = glisson::session::Journal::read(entry.path()))
        return std::make_unique<glisson::session::Journalled>(std::move(*read));
    return nullptr;
  }

 private slots:
  void initTestCase() { QVERIFY(openSynthetic()); }
  void init() {
    clean();
    key(Qt::Key_P);
  }

  void keysAndButtonsTakeTheToolsAndEachSaysWhatItDoes() {
    const struct {
      const char* button;
      int key;
      Qt::KeyboardModifiers modifiers;
      ToolMode mode;
    } tools[] = {{"ellipseTool", Qt::Key_Q, {}, ToolMode::Ellipse},
                 {"brushTool", Qt::Key_D, {}, ToolMode::Brush},
                 {"eraserTool", Qt::Key_D, Qt::ShiftModifier, ToolMode::Eraser},
                 {"livewireTool", Qt::Key_J, {}, ToolMode::Livewire},
                 {"splineTool", Qt::Key_Y, {}, ToolMode::Spline}};
    QStringList hints;
    for (const auto& tool : tools) {
      key(tool.key, tool.modifiers);
      QCOMPARE(session().tool().mode(), tool.mode);
      QVERIFY(find<QPushButton>(tool.button)->isChecked());
      QVERIFY2(find<QPushButton>(tool.button)->toolTip().contains('('), tool.button);
      const QString hint = find<QLabel>("toolState")->text();
      QVERIFY2(!hints.contains(hint), qPrintable(hint));
      hints << hint;
      key(Qt::Key_P);
      click(tool.button);
      QCOMPARE(session().tool().mode(), tool.mode);
    }
    const double erosion = session().measureSettings().erosion_pixels;
    key(Qt::Key_D);
    const double radius = session().tool().brushRadius();
    key(Qt::Key_BracketRight);
    QVERIFY(session().tool().brushRadius() > radius);
    key(Qt::Key_BracketLeft);
    QCOMPARE(session().tool().brushRadius(), radius);
    QCOMPARE(session().measureSettings().erosion_pixels, erosion);
  }

  void anEllipseIsDraggedAcceptedAndMeasured() {
    const QPoint at = showLiver();
    key(Qt::Key_Q);
    mouse(mri(), QEvent::MouseButtonPress, at - QPoint(70, 45), Qt::LeftButton, Qt::LeftButton);
    for (int s = 1; s <= 6; ++s)
      mouse(mri(), QEvent::MouseMove, at - QPoint(70, 45) + QPoint(140, 90) * s / 6, Qt::NoButton, Qt::LeftButton);
    QCOMPARE(session().tool().shape().size(), std::size_t{1});
    picture("ellipse");
    mouse(mri(), QEvent::MouseButtonRelease, at + QPoint(70, 45), Qt::LeftButton, Qt::NoButton);
    QCOMPARE(session().tool().state(), ToolState::Editing);
    key(Qt::Key_Return);
    QCOMPARE(session().acceptedCount(), std::size_t{1});
    const double scale = mri()->zoom_px_mm();
    QVERIFY(std::abs(area() - M_PI * 70.0 * 45.0 / (scale * scale)) < 1e-6 * area());
    QTRY_VERIFY(session().statistics().pooled.has_value());
    QCOMPARE(session().undoText(), QStringLiteral("accept outline"));
  }

  void theBrushKeepsToTheLiverAndEveryStrokeIsOneStepInTheJournal() {
    const QPoint at = showLiver();
    key(Qt::Key_D);
    mouse(mri(), QEvent::MouseButtonPress, at, Qt::LeftButton, Qt::LeftButton);
    for (int s = 1; s <= 20; ++s)
      mouse(mri(), QEvent::MouseMove, at + QPoint(-8 * s, 3 * s), Qt::NoButton, Qt::LeftButton);
    picture("brush-stroke");
    mouse(mri(), QEvent::MouseButtonRelease, at + QPoint(-160, 60), Qt::LeftButton, Qt::NoButton);
    QVERIFY(!polygons().empty());
    QCOMPARE(session().undoText(), QStringLiteral("brush"));
    key(Qt::Key_Return);
    const double painted = area();
    const auto before = session().contours();
    drag(mri(), at, at + QPoint(40, -40));
    QVERIFY(area() > painted);
    QCOMPARE(session().acceptedCount(), polygons().size());
    picture("brush");
    QVERIFY(glisson::test::same(journalled()->outlines, session().contours()));
    const double grown = area();
    key(Qt::Key_D, Qt::ShiftModifier);
    mouse(mri(), QEvent::MouseButtonPress, at, Qt::LeftButton, Qt::LeftButton);
    picture("eraser");
    mouse(mri(), QEvent::MouseButtonRelease, at, Qt::LeftButton, Qt::NoButton);
    QVERIFY(area() < grown);
    QVERIFY(glisson::test::same(journalled()->outlines, session().contours()));
    QCOMPARE(session().undoText(), QStringLiteral("erase"));
    session().undo();
    session().undo();
    QVERIFY(glisson::test::same(session().contours(), before));
    session().saveCase(path("painted"));
    const auto saved = session().contours();
    open(path("journals"));
    QVERIFY(openPath(path("painted") + "/case.json"));
    QVERIFY(glisson::test::same(session().contours(), saved));
    QVERIFY(openSynthetic());  // outlines of a case are not undone
  }

  void livewireAndSplineFollowTheClicksAndComeBackFromTheJournal() {
    const QPoint at = showLiver();
    for (const int tool : {Qt::Key_J, Qt::Key_Y}) {
      clean();
      key(tool);
      for (const QPoint to : {QPoint(-70, -30), QPoint(40, -70), QPoint(80, 20), QPoint(-10, 70)}) {
        QTest::mouseMove(mri(), at + to);
        QTest::mouseClick(mri(), Qt::LeftButton, {}, at + to);
      }
      QCOMPARE(session().tool().drawing().cols(), Eigen::Index{4});
      QVERIFY(session().tool().curve().cols() > 8);
      picture(tool == Qt::Key_J ? "livewire" : "spline");
      QVERIFY(journalled()->inWork.points_lps_mm == session().tool().outlineInWork());
      QTest::mouseClick(mri(), Qt::RightButton, {}, at);
      QCOMPARE(polygons().size(), std::size_t{1});
      QVERIFY(polygons()[0].points_lps_mm.cols() > 8);
      QCOMPARE(session().tool().state(), ToolState::Editing);
    }
  }

  void outlinesAreCombinedByKeyAndByMenu() {
    const QPoint at = showLiver();
    key(Qt::Key_Q);
    drag(mri(), at - QPoint(80, 50), at + QPoint(40, 50));
    key(Qt::Key_Return);
    QTest::keyClick(mri(), Qt::Key_D, Qt::ControlModifier);
    drag(mri(), at + QPoint(80, 80), at + QPoint(0, -20));
    QCOMPARE(polygons().size(), std::size_t{2});
    const auto both = session().contours();
    const double first = area();
    picture("two-outlines");
    key(Qt::Key_U);
    QCOMPARE(polygons().size(), std::size_t{1});
    QVERIFY(area() > first);
    QVERIFY2(said().contains("one region"), qPrintable(said()));
    picture("united");
    session().undo();
    QVERIFY(glisson::test::same(session().contours(), both));
    session().tool().selectPolygon(1);
    key(Qt::Key_U, Qt::ControlModifier);
    QCOMPARE(polygons().size(), std::size_t{1});
    const double shared = area();
    session().undo();
    session().tool().selectPolygon(1);
    QTest::mouseClick(mri(), Qt::RightButton, {}, at + QPoint(40, 30));
    auto* menu = page()->findChild<QMenu*>("outlineMenu");
    QVERIFY(menu);
    QAction* takeOut = nullptr;
    for (QAction* action : menu->actions())
      if (action->text().startsWith("Take out")) takeOut = action;
    QVERIFY(takeOut && takeOut->isEnabled());
    takeOut->trigger();
    menu->close();
    QCOMPARE(polygons().size(), std::size_t{1});
    QVERIFY(std::abs(area() + shared - first) < 1e-9 * first);
    QCOMPARE(session().undoText(), QStringLiteral("take outline out"));
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(OutlineTools)
#include "outline_tools_test.moc"

// SPDX-License-Identifier: GPL-3.0-or-later

// The Segment page in detail: what is shown first, what is told, what the wheel leaves alone, and work without a mouse.
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QHeaderView>
#include <QInputDialog>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QStatusBar>
#include <QTreeWidget>
#include <cmath>

#include "panels/image_layers.h"
#include "panels/step_rail.h"
#include "window_bench.h"

using glisson::panels::Theme;
using glisson::roi::PolygonState;
using glisson::test::drag;
using glisson::test::wheel;
using glisson::tools::ToolState;

namespace {

/// Pixels of a picture that are nearly of this colour.
int pixelsOf(const QImage& picture, const QColor& colour) {
  int n = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const QColor c = picture.pixelColor(x, y);
      n +=
          std::abs(c.red() - colour.red()) + std::abs(c.green() - colour.green()) + std::abs(c.blue() - colour.blue()) <
          40;
    }
  return n;
}

}  // namespace

class Segment : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

  const QColor crossing_{255, 82, 160};

 private slots:
  void initTestCase() { QVERIFY(openSynthetic()); }

  void theFirstSliceLiesOnOneOfTheElastogramAndHasItsNumberAtOnce() {
    const glisson::image::Grid& map = session().images().stiffness->values_kPa.grid;
    const auto plane = mri()->plane();
    const double k = map.lpsToIndex(plane.toLps(plane.offset_px)).z();
    QVERIFY2(std::abs(k - std::round(k)) * map.spacing_mm.z() <= 0.5 * plane.grid.spacing_mm.z() + 1e-6,
             qPrintable(QString::number(k)));
    const QPoint at = pixelOf(glisson::test::trustedPlace(session()));
    square(at.x() - 40, at.y() - 40, 80);
    QTRY_VERIFY(session().statistics().pooled.has_value());
    QVERIFY(session().statistics().slice.has_value());
    // A slice between two of the elastogram's: within half a slice, the number is there as well.
    clean();
    const int first = mri()->slice();
    for (int s = first + 1; s <= first + 3; ++s) {
      mri()->setSlice(s);
      square(at.x() - 40, at.y() - 40, 80);
      QTRY_VERIFY2(session().statistics().pooled.has_value(), qPrintable(session().statistics().reason));
      clean();
      QTRY_VERIFY(!session().statistics().pooled.has_value());
    }
    mri()->setSlice(first);
  }

  void bothViewsShowTheSamePlaceFromTheStartAndAfterAResize() {
    const auto together = [this] {
      return mre()->zoom_px_mm() == mri()->zoom_px_mm() &&
             (mre()->centre_lps() - mri()->centre_lps()).head<2>().norm() < 1.0;
    };
    QVERIFY(together());
    const double zoom = mri()->zoom_px_mm();
    window().resize(1200, 700);
    QTRY_VERIFY(mri()->zoom_px_mm() != zoom);
    QVERIFY(together());
    window().resize(1480, 900);
    QTRY_COMPARE(mri()->zoom_px_mm(), zoom);
    QVERIFY(together());
  }

  void anOutlineThatCrossesItselfKeepsItsColourOnceClosed() {
    clean();
    QCOMPARE(pixelsOf(mri()->grab().toImage(), crossing_), 0);
    for (const QPoint at : {QPoint(160, 160), QPoint(260, 260), QPoint(260, 160), QPoint(160, 260)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(session().tool().state(), ToolState::Editing);
    session().tool().deselect();
    QTest::mouseMove(mri(), QPoint(30, 30));
    QVERIFY(pixelsOf(mri()->grab().toImage(), crossing_) > 100);
    QVERIFY(pixelsOf(mre()->grab().toImage(), crossing_) > 100);
    session().undo();
    QCOMPARE(pixelsOf(mri()->grab().toImage(), crossing_), 0);
    // An accepted one dragged across itself is a draft again, and asked about.
    square(160, 160, 120);
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(session().acceptedCount(), std::size_t{1});
    drag(mri(), {160, 160}, {220, 340});
    QCOMPARE(session().acceptedCount(), std::size_t{0});
    QVERIFY(window().statusBar()->currentMessage().contains("draft again"));
    QVERIFY(pixelsOf(mri()->grab().toImage(), crossing_) > 100);
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(session().acceptedCount(), std::size_t{1});
    clean();
  }

  void theStiffnessScaleIsNotDraggedAndTheWaveStaysAroundZero() {
    drag(mre(), {100, 100}, {200, 160}, Qt::LeftButton, Qt::AltModifier);
    QCOMPARE(mre()->volume().low, 0.0);
    QCOMPARE(mre()->volume().high, 8.0);
    QVERIFY2(window().statusBar()->currentMessage().contains("kPa"),
             qPrintable(window().statusBar()->currentMessage()));
    QTest::keyClick(mri(), Qt::Key_W);
    drag(mre(), {100, 100}, {200, 160});
    QCOMPARE(mre()->volume().high, 8.0);
    const double low = mri()->volume().low;
    drag(mri(), {100, 100}, {140, 130});
    QVERIFY(mri()->volume().low != low);
    click("layerWave");
    const double high = mre()->volume().high;
    drag(mre(), {100, 100}, {200, 160});
    QVERIFY(mre()->volume().high > high);
    QCOMPARE(mre()->volume().low, -mre()->volume().high);
    click("layerStiffness");
    QCOMPARE(mre()->volume().high, 8.0);
    QTest::keyClick(mri(), Qt::Key_P);
    QTest::keyClick(mri(), Qt::Key_0);
  }

  void theWheelScrollsPastFieldsWithoutTheFocus() {
    auto* erosion = find<QSpinBox>("erosionPixels");
    mri()->setFocus();
    const int px = erosion->value();
    wheel(erosion, {5, 5}, 120);
    QCOMPARE(erosion->value(), px);
    QVERIFY(!erosion->hasFocus());
    QApplication::setActiveWindow(&window());
    erosion->setFocus();
    wheel(erosion, {5, 5}, 120);
    QCOMPARE(erosion->value(), px + 1);
    erosion->setValue(px);
    mri()->setFocus();
    int seen = 0;
    for (const char* step : {"stepModel", "stepRetract", "stepCompare", "stepLoad", "stepSegment"}) click(step);
    for (QComboBox* box : window().findChildren<QComboBox*>()) {
      QVERIFY2(box->focusPolicy() != Qt::WheelFocus, qPrintable(box->objectName()));
      if (box->count() < 2) continue;
      const int index = box->currentIndex();
      wheel(box, {5, 5}, index == 0 ? -120 : 120);
      QVERIFY2(box->currentIndex() == index, qPrintable(box->objectName()));
      ++seen;
    }
    QVERIFY(seen >= 4);
    for (QAbstractSpinBox* box : window().findChildren<QAbstractSpinBox*>()) {
      const QString text = box->text();
      wheel(box, {5, 5}, 120);
      QVERIFY2(box->text() == text, qPrintable(box->objectName()));
    }
  }

  void anOutlineIsDrawnWithoutAMouse() {
    clean();
    mri()->setFocus();
    const glisson::image::Grid grid = mri()->plane().grid;
    QTest::keyClick(mri(), Qt::Key_C);
    QCOMPARE(session().tool().drawing().cols(), Eigen::Index{1});
    const Eigen::Vector3d start = grid.lpsToIndex(session().tool().drawing().col(0));
    for (const Qt::Key way : {Qt::Key_Right, Qt::Key_Down, Qt::Key_Left}) {
      QTest::keyClick(mri(), way, Qt::ControlModifier | Qt::ShiftModifier);
      QTest::keyClick(mri(), way, Qt::ControlModifier);
      QTest::keyClick(mri(), way, Qt::ControlModifier);
      QTest::keyClick(mri(), Qt::Key_C);
    }
    const Eigen::Vector2d sign = mri()->plane().scale_px_mm.cwiseSign();
    const Eigen::Matrix3Xd drawn = session().tool().drawing();
    QCOMPARE(drawn.cols(), Eigen::Index{4});
    const double steps[4][2] = {{0, 0}, {12, 0}, {12, 12}, {0, 12}};
    for (int v = 0; v < 4; ++v) {
      const Eigen::Vector3d way = grid.lpsToIndex(drawn.col(v)) - start;
      QVERIFY((way - Eigen::Vector3d(steps[v][0] * sign.x(), steps[v][1] * sign.y(), 0.0)).norm() < 1e-6);
    }
    QVERIFY(mri()->cursorByKeys());
    // Back on the first vertex, where a click closes.
    QTest::keyClick(mri(), Qt::Key_Up, Qt::ControlModifier | Qt::ShiftModifier);
    QTest::keyClick(mri(), Qt::Key_Up, Qt::ControlModifier);
    QTest::keyClick(mri(), Qt::Key_Up, Qt::ControlModifier);
    QVERIFY(session().tool().closes());
    QTest::keyClick(mri(), Qt::Key_C);
    QCOMPARE(polygons().size(), std::size_t{1});
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(polygons()[0].state, PolygonState::Accepted);
    // A click on its edge selects it, and arrows nudge.
    session().tool().deselect();
    QTest::keyClick(mri(), Qt::Key_C);
    QVERIFY(session().tool().selected().has_value());
    QTest::mouseMove(mri(), QPoint(50, 60));
    QTest::mouseMove(mri(), QPoint(52, 60));
    QTRY_VERIFY(!mri()->cursorByKeys());
    clean();
  }

  void theSpacingOfFreehandIsChosenAndKept() {
    auto* spacing = find<QSpinBox>("freehandSpacing");
    QVERIFY(!spacing->isVisible());
    QTest::keyClick(mri(), Qt::Key_F);
    QVERIFY(spacing->isVisible());
    QCOMPARE(spacing->value(), 8);
    spacing->setValue(25);
    QCOMPARE(session().tool().freehandSpacing(), 25.0);
    auto another = make(path("journals-spacing"));
    QCOMPARE(another->session().tool().freehandSpacing(), 25.0);
    spacing->setValue(8);
    QTest::keyClick(mri(), Qt::Key_P);
    QVERIFY(!spacing->isVisible());
  }

  void everyStatisticIsShown() {
    clean();
    const QPoint at = showLiver();
    square(at.x() - 40, at.y() - 40, 80);
    QTest::keyClick(mri(), Qt::Key_Return);
    QTRY_VERIFY(session().statistics().slice.has_value());
    auto* full = find<QLabel>("fullReadout");
    QVERIFY(!full->isVisible());
    click("moreNumbers");
    QVERIFY(full->isVisible());
    const auto& all = *session().statistics().pooled;
    for (const double number : {all.pooled.median_kPa, all.pooled.min_kPa, all.pooled.max_kPa, all.areaWeightedMean_kPa,
                                session().statistics().slice->median_kPa})
      QVERIFY2(full->text().contains(QString::number(number, 'f', 2)), qPrintable(full->text()));
    click("moreNumbers");
    QTest::keyClick(mri(), Qt::Key_D, Qt::ControlModifier);
    QTest::mouseDClick(mri(), Qt::LeftButton, {}, at);
    auto* properties = window().findChild<QInputDialog*>("outlineProperties");
    QVERIFY(properties);
    QVERIFY2(properties->labelText().contains(full->text()), qPrintable(properties->labelText()));
    properties->close();
    clean();
  }

  void redoCanBePressedWhileDrawing() {
    clean();
    square(200, 300, 60);  // there is nothing else to be done again
    session().tool().deselect();
    QTest::mouseClick(mri(), Qt::LeftButton, {}, QPoint(320, 300));
    QTest::mouseClick(mri(), Qt::LeftButton, {}, QPoint(370, 300));
    QVERIFY2(!find<QPushButton>("redoButton")->isEnabled(), qPrintable(session().redoText()));
    click("undoButton");
    QVERIFY(find<QPushButton>("redoButton")->isEnabled());
    QVERIFY(find<QAction>("redoAction")->isEnabled());
    click("redoButton");
    QCOMPARE(session().tool().drawing().cols(), Eigen::Index{2});
    QVERIFY(!find<QPushButton>("redoButton")->isEnabled());
    clean();
  }

  void theListShowsTheSliceThatIsShown() {
    clean();
    const int last = mri()->sliceCount() - 1;
    mri()->setSlice(0);
    square(160, 160, 120);
    QTest::keyClick(mri(), Qt::Key_C, Qt::ControlModifier);
    session().pasteTo(1, last);
    auto* list = find<QTreeWidget>("outlineList");
    QVERIFY(list->topLevelItemCount() > 20);
    for (const int k : {last, last / 2, 1}) {
      mri()->setSlice(k);
      QTreeWidgetItem* row = nullptr;
      for (int i = 0; i < list->topLevelItemCount(); ++i)
        if (list->topLevelItem(i)->data(0, Qt::UserRole).toInt() == k) row = list->topLevelItem(i);
      QVERIFY(row);
      const QRect seen = list->visualItemRect(row);
      QVERIFY2(seen.top() >= 0 && seen.bottom() <= list->viewport()->height(),
               qPrintable(QStringLiteral("%1: %2 to %3 of %4")
                              .arg(k)
                              .arg(seen.top())
                              .arg(seen.bottom())
                              .arg(list->viewport()->height())));
    }
    clean();
    showLiver();
  }

  void theWaveStopsWithItsPictureAndItsButtonSaysSo() {
    glisson::views::SliceView view;
    glisson::panels::ImageLayers layers(&view);
    glisson::session::OpenImages images = session().images();
    while (images.wave.size() < 4) images.wave.push_back(images.wave.front());
    layers.setImages(images);
    auto* play = layers.findChild<QPushButton*>("playWave");
    const auto shown = [play] { return play->property("iconName").toString(); };
    layers.togglePlay();
    QVERIFY(layers.playing());
    QCOMPARE(shown(), QStringLiteral("pause"));
    QTRY_VERIFY(layers.phase() > 0);
    layers.show(glisson::panels::ImageLayers::Layer::Stiffness);
    QVERIFY(!layers.playing());
    QCOMPARE(shown(), QStringLiteral("play"));
    layers.togglePlay();
    layers.setImages(images);  // another patient
    QCOMPARE(shown(), QStringLiteral("play"));
  }

  void theSheetShowsEveryTextWholeAndTheKeysOfStepsAndMenus() {
    QTest::keyClick(mri(), Qt::Key_F1);
    auto* sheet = window().findChild<QDialog*>("keySheet");
    QVERIFY(sheet && QTest::qWaitForWindowExposed(sheet));
    auto* tabs = sheet->findChild<QTabWidget*>();
    for (int t = 0; t < tabs->count(); ++t) {
      tabs->setCurrentIndex(t);
      QTest::qWait(50);
      auto* table = qobject_cast<QTreeWidget*>(tabs->widget(t));
      QVERIFY(table && table->topLevelItemCount() > 5);
      for (int i = 0; i < table->topLevelItemCount(); ++i)
        for (int c = 0; c < table->columnCount(); ++c) {
          const QString text = table->topLevelItem(i)->text(c);
          // What the style sheet leaves of a cell for its text: 5 px of padding on both sides, and the style's margin.
          const QSize room = table->visualRect(table->model()->index(i, c)).size() - QSize(16, 8);
          const QRect needed =
              table->fontMetrics().boundingRect(QRect(0, 0, room.width(), 1000), Qt::TextWordWrap, text);
          QVERIFY2(needed.height() <= room.height() && needed.width() <= room.width(), qPrintable(text));
        }
    }
    auto* menus = sheet->findChild<QTreeWidget*>("menuKeyTable");
    for (const char* key : {"Ctrl+1", "Ctrl+5", "Ctrl+R", "Ctrl+S", "Ctrl+I", "Ctrl+."})
      QVERIFY2(menus->findItems(QString::fromLatin1(key), Qt::MatchExactly, 1).size() == 1, key);
    QVERIFY(menus->findItems("Ctrl+Z", Qt::MatchExactly, 1).empty());  // a key of the outlines, in their table
    sheet->close();
    QVERIFY(window().findChild<glisson::panels::StepButton*>("stepModel")->toolTip().contains("Ctrl+3"));
  }

  void aCheckedBoxHasATickInBothThemes() {
    auto* inner = find<QCheckBox>("innerRegion");
    for (const Theme theme : {Theme::Light, Theme::Dark}) {
      glisson::panels::applyTheme(theme);
      inner->setChecked(false);
      const auto white = [inner] {
        const QImage box = inner->grab(QRect(0, 0, 18, inner->height())).toImage();
        return pixelsOf(box, QColor(Qt::white));
      };
      const int before = theme == Theme::Light ? 0 : white();
      inner->setChecked(true);
      QVERIFY2(white() > before + 5, theme == Theme::Light ? "light" : "dark");
      QVERIFY(pixelsOf(inner->grab(QRect(0, 0, 18, inner->height())).toImage(), glisson::panels::accent()) > 40);
    }
    inner->setChecked(false);
  }

  void theInnerRegionOfACaseIsSeenWhenItIsOpenedAgain() {
    clean();
    session().setMeasureSettings({true, 4});
    QVERIFY(find<QCheckBox>("innerRegion")->isChecked());
    session().saveCase(path("inner"));
    open(path("journals"));
    QCOMPARE(find<QSpinBox>("erosionPixels")->value(), 3);
    QVERIFY(openPath(path("inner") + "/case.json"));
    QVERIFY(find<QCheckBox>("innerRegion")->isChecked());
    QCOMPARE(find<QSpinBox>("erosionPixels")->value(), 4);
  }

  // 1366 x 768, less what a desktop takes.
  void theWindowFitsOnASmallScreen() {
    click("freehandTool");  // has one more field
    click("layerWave");
    for (const glisson::session::Step step : glisson::session::steps) {
      window().showStep(step);
      const QSize least = window().minimumSizeHint();
      QVERIFY2(least.width() <= 1340 && least.height() <= 700,
               qPrintable(QStringLiteral("%1 x %2").arg(least.width()).arg(least.height())));
    }
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Segment)
#include "segment_test.moc"

// SPDX-License-Identifier: GPL-3.0-or-later

// The 3-D views through real events, on one window with the synthetic patient: what they show, what the mouse places
// and chooses in them, and that the window answers while they draw.
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QSlider>
#include <QTest>
#include <QTreeWidget>
#include <cmath>

#include "panels/compare_page.h"
#include "panels/live_bar.h"
#include "panels/main_window.h"
#include "panels/placement_editor.h"
#include "panels/retract_page.h"
#include "pipeline/run.h"
#include "session/model_preview.h"
#include "session/stall_monitor.h"
#include "views/picture_view.h"
#include "views/scene_view.h"
#include "views/slice_view.h"
#include "window_bench.h"

using glisson::panels::PlacementEditor;
using glisson::session::Session;
using glisson::session::StallMonitor;
using glisson::session::Step;
using glisson::test::changed;
using glisson::test::drag;
using glisson::test::wait_ms;
using glisson::views::Mark;
using glisson::views::SceneView;
using glisson::views::SliceView;

class Scene3D : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  Eigen::Vector3d laid_ = Eigen::Vector3d::Zero();
  double energy_J_ = 0.0;

  const Mark* mark(const SceneView* view, int id) {
    for (const Mark& m : view->marks())
      if (m.id == id) return &m;
    return nullptr;
  }
  /// The fine picture that follows an act.
  template <typename Act>
  QImage after(SceneView* view, const Act& act) {
    QSignalSpy drawn(view, &SceneView::rendered);
    act();
    const bool came = drawn.count() > 0 || drawn.wait(wait_ms);
    return came ? settled(view) : QImage();
  }
  /// The picture once none has come for a while.
  QImage settled(SceneView* view) {
    QSignalSpy drawn(view, &SceneView::rendered);
    while (drawn.wait(1500)) {
    }
    return view->picture();
  }
  /// A picture of the window in both themes, for people, where GLISSON_SCREENSHOTS names a folder.
  void keep(const char* name) {
    const QString folder = qEnvironmentVariable("GLISSON_SCREENSHOTS");
    if (folder.isEmpty()) return;
    for (const auto theme : {glisson::panels::Theme::Light, glisson::panels::Theme::Dark}) {
      glisson::panels::applyTheme(theme);
      QTest::qWait(300);
      const char* suffix = theme == glisson::panels::Theme::Light ? "light" : "dark";
      window().grab().save(QStringLiteral("%1/%2-%3.png").arg(folder, QLatin1String(name), QLatin1String(suffix)));
    }
  }
  void undo() { find<QAction>("undoAction")->trigger(); }
  glisson::retraction::Retractor writtenBar() {
    session().saveCase(path("placed"));
    const auto scene = glisson::pipeline::readScene(folder() / "placed" / "scene.json");
    return std::get<glisson::retraction::Retractor>(scene.setup.loads.front());
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
    QVERIFY(openSynthetic());
    // With the outlines of its own structure set.
    session().importContours(path("patients/synthetic-patient-3/rtstruct.dcm"));
    auto parameters = session().parameters();
    parameters.cell_mm = 6.0;
    session().setParameters(parameters);
  }

  void theModelIsShownAndItsPartsAreSwitchedOff() {
    window().showStep(Step::Model);
    auto* view = find<SceneView>("modelView");
    QTRY_VERIFY_WITH_TIMEOUT(view->hasModel(), wait_ms);
    const auto model = session().preview().picture();
    QVERIFY(model->liver.triangles.cols() > 100);
    QVERIFY(model->vessels.triangles.cols() > 100);
    QVERIFY(model->bar.has_value());
    QVERIFY2(model->barProblem.empty(), model->barProblem.c_str());
    QCOMPARE(model->supports.size(), std::size_t{2});
    // Colours are those of the elastogram: every vertex lies between the softest and the stiffest cell, and they
    // differ.
    QVERIFY(model->fromMre);
    QVERIFY(static_cast<double>(model->shear_kPa.minCoeff()) >= model->least_kPa - 1e-3);
    QVERIFY(static_cast<double>(model->shear_kPa.maxCoeff()) <= model->most_kPa + 1e-3);
    QVERIFY(model->shear_kPa.maxCoeff() > 1.2F * model->shear_kPa.minCoeff());
    QVERIFY(find<QLabel>("modelWords")->text().contains(QString::number(model->sites)));
    QImage before = settled(view);
    keep("model");
    for (const char* name : {"showSupports", "showBar", "showSites", "showStiffness", "showVessels", "showSurface"}) {
      const QImage now = after(view, [&] { QTest::mouseClick(find<QPushButton>(name), Qt::LeftButton); });
      const int pixels = changed(before, now);
      qInfo("%s: %d pixels", name, pixels);
      QVERIFY2(pixels > 60, name);
      before = now;
    }
    for (const char* name : {"showSurface", "showStiffness", "showVessels", "showSites", "showBar", "showSupports"})
      QTest::mouseClick(find<QPushButton>(name), Qt::LeftButton);
    // Another scale, other colours.
    before = settled(view);
    find<QComboBox>("modelScale")->setCurrentIndex(1);
    QTRY_VERIFY_WITH_TIMEOUT(changed(before, view->picture()) > 1000, wait_ms);
    find<QComboBox>("modelScale")->setCurrentIndex(0);
  }

  void barHoistAndHoldsAreLaidWithTheMouse() {
    window().showStep(Step::Retract);
    auto* view = find<SceneView>("retractView");
    QTRY_VERIFY_WITH_TIMEOUT(view->hasModel() && !view->picture().isNull(), wait_ms);
    QTRY_VERIFY(mark(view, PlacementEditor::contact) != nullptr);
    const auto proposed = session().parameters();
    const QString words = find<QLabel>("placementNumbers")->text();

    // The bar over the surface.
    QPoint from = view->pixelOf(mark(view, PlacementEditor::contact)->at_lps).toPoint();
    drag(view, from, from + QPoint(12, -10));
    const auto moved = session().parameters().placement;
    QVERIFY(moved.barAt_lps.has_value());
    const Eigen::Matrix3Xd vertices = session().preview().picture()->liver.vertices_lps_mm;  // pictures are replaced
    QVERIFY((vertices.colwise() - *moved.barAt_lps).colwise().norm().minCoeff() < 1e-9);
    QVERIFY(find<QLabel>("placementNumbers")->text() != words);
    // Turned and widened by its end, which stays across the hoist.
    from = view->pixelOf(mark(view, PlacementEditor::barEndB)->at_lps).toPoint();
    drag(view, from, from + QPoint(18, 14));
    const auto turned = session().parameters();
    QVERIFY(turned.placement.barAxis.cross(moved.barAxis).norm() > 0.02);
    QVERIFY(std::abs(turned.placement.barAxis.dot(turned.placement.hoistDirection)) < 1e-9);
    QVERIFY(turned.retractorLength_mm != proposed.retractorLength_mm);
    // The hoist by its arrow.
    from = view->pixelOf(mark(view, PlacementEditor::hoist)->at_lps).toPoint();
    drag(view, from, from + QPoint(-16, -20));
    const auto hoisted = session().parameters();
    QVERIFY(hoisted.placement.hoistDirection.cross(turned.placement.hoistDirection).norm() > 0.02);
    QVERIFY(std::abs(hoisted.placement.hoistDirection.norm() - 1.0) < 1e-9);

    // Two blocks that are held; the mouse leaves one on the surface.
    QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy(), wait_ms);
    QTest::mouseClick(find<QPushButton>("addHold"), Qt::LeftButton);
    QTest::mouseClick(view, Qt::LeftButton, {}, QPoint(view->width() / 2, view->height() / 2));
    QCOMPARE(session().parameters().placement.holds.size(), std::size_t{1});
    QVERIFY(!find<QPushButton>("addHold")->isChecked());
    find<QDoubleSpinBox>("holdEdge")->setValue(30.0);
    QCOMPARE(session().parameters().placement.holds[0].edge_mm, 30.0);

    keep("placing");
    // What was laid is in the case and in the scene, to the last bit.
    const auto laid = session().parameters();
    const auto bar = writtenBar();
    QVERIFY(*bar.at_mm == *laid.placement.barAt_lps);
    QVERIFY((*bar.axis - laid.placement.barAxis).norm() < 1e-12);
    QVERIFY((bar.direction - laid.placement.hoistDirection).norm() < 1e-12);
    QCOMPARE(bar.length_mm, laid.retractorLength_mm);
    const auto scene = glisson::pipeline::readScene(folder() / "placed" / "scene.json");
    QCOMPARE(scene.setup.supports.size(), std::size_t{3});
    const auto& block = std::get<glisson::retraction::BoxRegion>(scene.setup.supports[2].region);
    QVERIFY((0.5 * (block.low_mm + block.high_mm) - laid.placement.holds[0].centre_lps).norm() < 1e-9);
    QVERIFY((block.high_mm - block.low_mm - Eigen::Vector3d::Constant(30.0)).norm() < 1e-9);
    QVERIFY(glisson::session::readCaseRecord(folder() / "placed").parameters.placement == laid.placement);

    // Each drag, click and number is one step back, and forth again; outlines are not touched.
    const auto outlines = session().contours().polygons.size();
    for (int n = 0; n < 5; ++n) undo();
    QVERIFY(session().parameters() == proposed);
    QVERIFY(!session().canUndoPlacement());
    for (int n = 0; n < 5; ++n) find<QAction>("redoAction")->trigger();
    QVERIFY(session().parameters() == laid);
    QCOMPARE(session().contours().polygons.size(), outlines);
    for (int n = 0; n < 5; ++n) undo();

    // The same on a slice: the bar goes with the mouse, and lands on the surface.
    auto* slice = find<SliceView>("placementSlice");
    QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy(), wait_ms);
    const Eigen::Vector3d contact = mark(view, PlacementEditor::contact)->at_lps;
    slice->showPoint(contact);
    const auto seen = slice->seenAt(contact);
    QVERIFY(seen.has_value());
    // The handles are seen there.
    const auto handles = slice->marks();
    const QImage with = slice->grab().toImage();
    slice->setMarks({});
    QVERIFY(changed(with, slice->grab().toImage()) > 60);
    slice->setMarks(handles);
    drag(slice, seen->toPoint(), seen->toPoint() + QPoint(10, 0));
    QVERIFY(session().parameters().placement.barAt_lps.has_value());
    const Eigen::Vector3d there = *session().parameters().placement.barAt_lps;
    QVERIFY((there - contact).norm() > 1.0);
    QVERIFY((vertices.colwise() - there).colwise().norm().minCoeff() < 1e-9);
    undo();
    QVERIFY(session().parameters() == proposed);
  }

  void turningTheProposedBarLeavesItWhereItLies() {
    auto* view = find<SceneView>("retractView");
    for (const int handle : {int{PlacementEditor::barEndB}, int{PlacementEditor::hoist}}) {
      QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy() && view->isSettled(), wait_ms);
      QVERIFY(!session().parameters().placement.barAt_lps.has_value());
      const Eigen::Vector3d contact = mark(view, PlacementEditor::contact)->at_lps;
      const QPoint from = view->pixelOf(mark(view, handle)->at_lps).toPoint();
      drag(view, from, from + QPoint(18, 14));
      QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy(), wait_ms);
      QVERIFY(session().parameters().placement.barAt_lps.has_value());
      QVERIFY((mark(view, PlacementEditor::contact)->at_lps - contact).norm() < 1e-9);
      // Where it is proposed is asked for.
      QTest::mouseClick(find<QPushButton>("automaticBar"), Qt::LeftButton);
      QVERIFY(!session().parameters().placement.barAt_lps.has_value());
    }
    for (int n = 0; n < 4; ++n) undo();
  }

  void theSameIsLaidWithKeysAlone() {
    auto* view = find<SceneView>("retractView");
    QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy() && view->isSettled(), wait_ms);
    const auto proposed = session().parameters();
    view->setFocus();
    // Turned, moved, zoomed, and all of it shown again.
    const auto camera = view->camera();
    QTest::keyClick(view, Qt::Key_Right);
    QVERIFY((view->camera().fromEye - camera.fromEye).norm() > 0.01);
    QTest::keyClick(view, Qt::Key_Left);
    QVERIFY((view->camera().fromEye - camera.fromEye).norm() < 1e-9);
    QTest::keyClick(view, Qt::Key_Up, Qt::ShiftModifier);
    QVERIFY((view->camera().focus_lps - camera.focus_lps).norm() > 1.0);
    QTest::keyClick(view, Qt::Key_Plus);
    QVERIFY(view->camera().halfHeight_mm < camera.halfHeight_mm);
    QTest::keyClick(view, Qt::Key_Home);
    QVERIFY(std::abs(view->camera().halfHeight_mm / camera.halfHeight_mm - 1.0) < 1e-9);
    // The bar's contact: ten millimetres to the right of the picture, on the surface.
    for (std::size_t n = 0; n <= view->marks().size() && !mark(view, PlacementEditor::contact)->current; ++n)
      QTest::keyClick(view, Qt::Key_Space);
    QVERIFY(mark(view, PlacementEditor::contact)->current);
    const Eigen::Vector3d from = mark(view, PlacementEditor::contact)->at_lps;
    QTest::keyClick(view, Qt::Key_Right, Qt::ControlModifier | Qt::ShiftModifier);
    QVERIFY(session().parameters().placement.barAt_lps.has_value());
    const double right_mm = (*session().parameters().placement.barAt_lps - from).dot(view->camera().right());
    QVERIFY2(std::abs(right_mm - 10.0) < 4.0, qPrintable(QString::number(right_mm)));  // to the nearest vertex
    // A block that is held, in the middle of the view.
    QTest::keyClick(find<QPushButton>("addHold"), Qt::Key_Space);
    QTest::keyClick(view, Qt::Key_Return);
    QCOMPARE(session().parameters().placement.holds.size(), std::size_t{1});
    QVERIFY((view->pixelOf(session().parameters().placement.holds[0].centre_lps) -
             QPointF(0.5 * view->width(), 0.5 * view->height()))
                .manhattanLength() < 1.0);
    for (int n = 0; n < 2; ++n) undo();
    QVERIFY(session().parameters() == proposed);
  }

  void theRunUsesWhatWasLaid() {
    auto* view = find<SceneView>("retractView");
    QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy(), wait_ms);
    const QPoint from = view->pixelOf(mark(view, PlacementEditor::contact)->at_lps).toPoint();
    drag(view, from, from + QPoint(10, -8));
    const auto bar = writtenBar();
    QVERIFY(bar.at_mm.has_value());
    auto scene = glisson::pipeline::readScene(folder() / "placed" / "scene.json");
    scene.outputs = {};
    const auto there = glisson::pipeline::run(scene, {});
    QVERIFY(there.primary.retractorPoint_mm.has_value());
    const double off_mm = (*there.primary.retractorPoint_mm - *bar.at_mm).norm();
    QVERIFY2(off_mm < 0.5 * bar.length_mm, qPrintable(QString::number(off_mm)));
    std::get<glisson::retraction::Retractor>(scene.setup.loads.front()).at_mm.reset();
    const auto proposed = glisson::pipeline::run(scene, {});
    QVERIFY((*proposed.primary.retractorPoint_mm - *there.primary.retractorPoint_mm).norm() > 1.0);
    QVERIFY(proposed.primary.energy_J != there.primary.energy_J);
    laid_ = *there.primary.retractorPoint_mm;
    energy_J_ = there.primary.energy_J;
  }

  void theWindowAnswersWhileTheFirstSceneIsDrawn() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    auto* live = window().findChild<glisson::panels::LiveBar*>();
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
    window().showStep(Step::Retract);
    QTest::mouseClick(find<QPushButton>("runButton"), Qt::LeftButton);
    QVERIFY(ended.wait(wait_ms));
    QVERIFY(session().result());
    // The window ran what is laid by hand, with the numbers of the scene that was written.
    QVERIFY((*session().result()->primary.retractorPoint_mm - laid_).norm() < 1e-9);
    QCOMPARE(session().result()->primary.energy_J, energy_J_);
    told("running");
    QVERIFY(compareDrawn.count() > 0 || compareDrawn.wait(wait_ms));
    told("first scene, Compare");
    QTRY_VERIFY_WITH_TIMEOUT(live->isReady(), wait_ms);
    window().showStep(Step::Retract);
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
    glisson::test::judge(r);
  }

  void aVesselIsChosenIn3D() {
    window().showStep(Step::Compare);
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    auto* view = compare->sceneView();
    auto* list = find<QTreeWidget>("vesselList");
    QVERIFY(list->topLevelItemCount() >= 2);
    QCOMPARE(static_cast<int>(view->marks().size()), list->topLevelItemCount());
    settled(view);
    QSignalSpy chosen(compare, &glisson::panels::ComparePage::placeChosen);
    QSignalSpy drawn(compare, &glisson::panels::ComparePage::overlayShown);
    // One that no other covers, and not the first.
    const Mark* wanted = nullptr;
    for (const Mark& m : view->marks()) {
      const bool alone = std::none_of(view->marks().begin(), view->marks().end(), [&](const Mark& other) {
        return other.id != m.id && QLineF(view->pixelOf(other.at_lps), view->pixelOf(m.at_lps)).length() < 1.0;
      });
      if (m.id > 1 && alone && view->rect().contains(view->pixelOf(m.at_lps).toPoint())) wanted = &m;
    }
    QVERIFY(wanted);
    const int id = wanted->id;
    QTest::mouseClick(view, Qt::LeftButton, {}, view->pixelOf(wanted->at_lps).toPoint());
    const int row = list->indexOfTopLevelItem(list->currentItem());
    QVERIFY(row >= 0);
    QCOMPARE(row, id - 1);
    QCOMPARE(chosen.count(), 1);
    QVERIFY(drawn.count() > 0 || drawn.wait(wait_ms));
    QCOMPARE(drawn.back().front().toInt() + 1, list->currentItem()->text(1).toInt());
    // The views of Segment stand at the same place.
    const auto p = chosen.front().front().value<Eigen::Vector3d>();
    auto* mri = find<SliceView>("mriView");
    settled(view);
    keep("vessel");
    QCOMPARE(mri->slice(), qRound(session().images().mri->grid.lpsToIndex(p).z()));
  }

  void arrowsAreDrawnInTheSliceAndIn3D() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    auto* view = compare->sceneView();
    const QImage scene = settled(view), slice = find<glisson::views::PictureView>("overlayView")->picture();
    QSignalSpy drawn(compare, &glisson::panels::ComparePage::overlayShown);
    find<QCheckBox>("arrowsChoice")->click();
    QVERIFY(drawn.count() > 0 || drawn.wait(wait_ms));
    QVERIFY(changed(slice, find<glisson::views::PictureView>("overlayView")->picture()) > 200);
    QTRY_VERIFY_WITH_TIMEOUT(changed(scene, view->picture()) > 200, wait_ms);
    keep("arrows");
    drawn.clear();
    find<QCheckBox>("magnifyChoice")->click();
    QVERIFY(drawn.count() > 0 || drawn.wait(wait_ms));
    // Without the magnified part, below the slice or beside it, the picture is smaller.
    const QImage plain = find<glisson::views::PictureView>("overlayView")->picture();
    QVERIFY(1.2 * plain.width() * plain.height() < slice.width() * slice.height());
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Scene3D)
#include "scene3d_test.moc"

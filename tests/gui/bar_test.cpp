// SPDX-License-Identifier: GPL-3.0-or-later

// A rigid bar in the window, bent to a hook: before the run, after it, and moved by the mouse.
#include <QLabel>
#include <QLineF>
#include <QPushButton>
#include <QSignalSpy>
#include <QTest>
#include <numbers>

#include "panels/live_bar.h"
#include "pipeline/run.h"
#include "session/model_preview.h"
#include "views/scene_view.h"
#include "window_bench.h"

using glisson::session::Session;
using glisson::session::Step;
using glisson::test::changed;
using glisson::test::wait_ms;
using glisson::views::SceneView;

/// The functions run in order on one window; each needs what those before it left.
class Bar : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  bool failed_ = false;
  std::vector<Eigen::Vector3d> shown() { return session().preview().picture()->bar->line_lps; }
  void shape(glisson::retraction::BarShape shape) {
    auto parameters = session().parameters();
    parameters.shape = shape;
    session().setParameters(parameters);
  }

 private slots:
  void init() {
    if (failed_) QSKIP("an earlier step failed");
  }
  void cleanup() { failed_ = failed_ || QTest::currentTestFailed(); }

  void initTestCase() {
    QVERIFY(openSynthetic());
    session().importContours(path("patients/synthetic-patient-3/rtstruct.dcm"));
    auto parameters = session().parameters();
    parameters.cell_mm = 8.0;
    session().setParameters(parameters);
  }

  void aHookIsShownBent() {
    window().showStep(Step::Model);
    auto* view = find<SceneView>("modelView");
    QTRY_VERIFY_WITH_TIMEOUT(view->hasModel() && !session().preview().busy() && view->isSettled(), wait_ms);
    QVERIFY2(session().preview().picture()->barProblem.empty(), session().preview().picture()->barProblem.c_str());
    QVERIFY(shown().empty());
    const QImage straight = view->picture();
    shape(glisson::retraction::BarShape::Hook);
    QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy() && !shown().empty() && view->isSettled(), wait_ms);
    QTRY_VERIFY_WITH_TIMEOUT(changed(straight, view->picture()) > 60, wait_ms);
    // A quarter turn of the bar's length: its chord and how far its middle stands out.
    const std::vector<Eigen::Vector3d> line = shown();
    const double half = 0.25 * std::numbers::pi, radius = session().parameters().retractorLength_mm / (2.0 * half);
    QVERIFY(std::abs((line.back() - line.front()).norm() - 2.0 * radius * std::sin(half)) < 1e-6);
    const Eigen::Vector3d middle = line[line.size() / 2], chord = 0.5 * (line.front() + line.back());
    QVERIFY(std::abs((middle - chord).norm() - radius * (1.0 - std::cos(half))) < 1e-6);
    const auto& bar = *session().preview().picture()->bar;
    QVERIFY(std::abs((middle - chord).dot(bar.direction)) < 1e-6);
  }

  void theRunBendsItAsItWasShown() {
    QSignalSpy ended(&session(), &Session::workEnded);
    window().showStep(Step::Retract);
    click("runButton");
    QVERIFY(ended.wait(wait_ms));
    QVERIFY2(session().result(), qPrintable(session().status(Step::Retract).detail));
    QVERIFY(session().result()->primary.contact && session().result()->placed);
    window().showStep(Step::Model);
    QTRY_VERIFY_WITH_TIMEOUT(!session().preview().busy(), wait_ms);
    const std::vector<Eigen::Vector3d> ran = session().result()->primary.contact->bar_mm, line = shown();
    QCOMPARE(ran.size(), line.size());
    double apart_mm = 0.0;
    for (std::size_t n = 0; n < line.size(); ++n) apart_mm = std::max(apart_mm, (ran[n] - line[n]).norm());
    qInfo("the hook shown lies %.2f mm from that of the run", apart_mm);
    QVERIFY2(apart_mm < 1.0, qPrintable(QString::number(apart_mm)));
  }

  void aLiverInRigidContactFollowsTheMouse() {
    auto* live = window().findChild<glisson::panels::LiveBar*>();
    auto* view = find<SceneView>("retractView");
    QTRY_VERIFY_WITH_TIMEOUT(live->isReady(), wait_ms);
    QSignalSpy rendered(view, &SceneView::rendered);
    window().showStep(Step::Retract);
    QVERIFY(rendered.count() > 0 || rendered.wait(wait_ms));
    click("liveButton");
    QVERIFY(live->isLive() && view->isLive());
    // Under the force of the run the bar goes about as far as in the run, on coarser cells.
    QTRY_VERIFY_WITH_TIMEOUT(live->isAtRest(), wait_ms);
    const auto& run = *session().result()->primary.contact;
    const double force_N = run.force_N.dot(run.hoist), travel_mm = live->frame().toolMre_mm.dot(run.hoist);
    qInfo("live %.2f N after %.1f mm, the run %.2f N after %.1f mm", live->frame().force_N.dot(run.hoist), travel_mm,
          force_N, run.travel_mm);
    QVERIFY(live->frame().mre == glisson::retraction::LiveOutcome::Borne);
    QVERIFY(std::abs(live->frame().force_N.dot(run.hoist) - force_N) < 0.01 * force_N);
    QVERIFY(std::abs(travel_mm - run.travel_mm) < 0.2 * run.travel_mm);
    // The mouse takes the bar where it is seen and lets it down, against the hoist as it is seen: liver and force
    // follow.
    QTRY_VERIFY_WITH_TIMEOUT(view->isSettled(), wait_ms);
    const Eigen::Vector3d before = live->frame().toolMre_mm;
    const Eigen::Matrix3Xd lay = live->frame().mre_mm;
    const auto seen = view->toolPixel();
    QVERIFY(seen.has_value());
    QLineF down(*seen, view->pixelOf(*session().result()->primary.retractorPoint_mm + before - 20.0 * run.hoist));
    QVERIFY(down.length() > 2.0);
    down.setLength(24.0);
    auto* canvas = static_cast<QWidget*>(view);
    QTest::mousePress(canvas, Qt::LeftButton, {}, seen->toPoint());
    for (int n = 1; n <= 12; ++n) {
      QTest::mouseMove(canvas, down.pointAt(n / 12.0).toPoint());
      QTest::qWait(20);
    }
    QTest::mouseRelease(canvas, Qt::LeftButton, {}, down.p2().toPoint());
    QTRY_VERIFY_WITH_TIMEOUT(live->isAtRest(), wait_ms);
    QTRY_VERIFY_WITH_TIMEOUT(QLineF(*view->toolPixel(), down.p2()).length() < 2.0, wait_ms);
    const auto& there = live->frame();
    const double let_mm = (there.toolMre_mm - before).dot(run.hoist);
    qInfo("let down by %.1f mm: %.2f N, %.0f ms a frame", -let_mm, there.force_N.dot(run.hoist), 1e3 * there.seconds);
    QVERIFY(let_mm < -1.0);
    QVERIFY(there.force_N.dot(run.hoist) < 0.98 * force_N);
    QVERIFY((there.mre_mm - lay).colwise().norm().maxCoeff() > 1.0);
    QVERIFY(there.remaining_mm < 0.3);
    QVERIFY(find<QLabel>("liveSpeed")->text().contains("degrees of freedom"));
    // And back to the force of the run.
    click("liveReset");
    QTRY_VERIFY_WITH_TIMEOUT(
        live->isAtRest() && std::abs(live->frame().force_N.dot(run.hoist) - force_N) < 0.01 * force_N, wait_ms);
    click("liveButton");
    QVERIFY(!view->isLive());
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Bar)
#include "bar_test.moc"

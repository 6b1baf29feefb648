// SPDX-License-Identifier: GPL-3.0-or-later

// From a DICOM folder to the overlay, as a hand would do it.
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QPushButton>
#include <QSet>
#include <QSlider>
#include <QTreeWidget>
#include <algorithm>
#include <cmath>
#include <thread>

#include "base/sha256.h"
#include "panels/compare_page.h"
#include "panels/live_bar.h"
#include "panels/method_chart.h"
#include "panels/step_rail.h"
#include "pipeline/run.h"
#include "session/stall_monitor.h"
#include "views/picture_view.h"
#include "views/scene_view.h"
#include "window_bench.h"

using glisson::session::Session;
using glisson::session::StallMonitor;
using glisson::session::Step;
using glisson::session::StepState;
using glisson::test::wait_ms;
using glisson::views::PictureView;

/// The functions run in order on one window; each needs what those before it left.
class Journey : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  bool failed_ = false;

 private slots:
  void init() {
    if (failed_) QSKIP("an earlier step of the journey failed");
  }
  void cleanup() { failed_ = failed_ || QTest::currentTestFailed(); }

  void everyStepCanBeLookedAtWhileEmpty() {
    for (const char* name : {"stepSegment", "stepModel", "stepRetract", "stepCompare", "stepLoad"}) {
      QTest::mouseClick(window().findChild<QWidget*>(name), Qt::LeftButton);
      QVERIFY(window().isVisible());
    }
    QCOMPARE(session().status(Step::Segment).state, StepState::Empty);
    QVERIFY(find<QLabel>("researchUse")->text().contains("not for clinical use"));
  }

  void opensTheSyntheticPatientFromDicom() {
    QSignalSpy loaded(&session(), &Session::loaded);
    StallMonitor stalls;
    session().openSynthetic(3, QString::fromStdString(folder().string()));
    QCOMPARE(session().status(Step::Load).state, StepState::Running);
    QVERIFY(loaded.wait(wait_ms));
    QVERIFY2(session().images().mri, qPrintable(session().status(Step::Load).detail));
    QVERIFY(session().images().stiffness);
    QVERIFY(session().images().stiffness->confidence);
    QCOMPARE(session().status(Step::Load).state, StepState::Done);
    QCOMPARE(window().step(), Step::Segment);
    auto* series = find<QTreeWidget>("seriesTree");
    QCOMPARE(series->topLevelItemCount(), 1);  // one patient
    QVERIFY(series->topLevelItem(0)->child(0)->childCount() >= 5);
    qInfo("longest time without an answer while opening: %.0f ms", stalls.report().max_ms);
    glisson::test::judge(stalls.report());
  }

  void showsNoPatientText() {
    for (const QLabel* label : window().findChildren<QLabel*>())
      QVERIFY2(!label->text().contains("PHANTOM"), qPrintable(label->text()));
    QVERIFY(!window().windowTitle().contains("PHANTOM"));
  }

  void drawsOutlinesWithTheMouse() {
    const Eigen::Vector3d centre = glisson::test::trustedPlace(session());
    QTest::mouseMove(mri(), QPoint(5, 5));
    mri()->showPoint(centre);
    const int middle = mri()->slice();
    std::size_t accepted = 0;
    for (const int slice : {middle - 6, middle - 2, middle + 2, middle + 6}) {
      mri()->setSlice(slice);
      ellipse(centre, 30.0, 24.0, 12);
      QCOMPARE(session().tool().state(), glisson::tools::ToolState::Editing);
      QTest::keyClick(mri(), Qt::Key_Return);
      QCOMPARE(session().acceptedCount(), ++accepted);
    }
    mri()->setSlice(middle);
    // Measured by a worker: the numbers of the last outline come after those of the first.
    QTRY_VERIFY(session().statistics().pooled && session().statistics().pooled->pooled.n > 100);
    QTRY_VERIFY(find<QLabel>("liveMean")->text().contains("kPa"));
    QCOMPARE(session().status(Step::Segment).state, StepState::Done);
  }

  void undoGoesBackToTheSliceAndRedoRestores() {
    const auto before = session().contours().polygons.size();
    const int slice = mri()->slice();
    mri()->setSlice(slice + 1);
    mri()->setSlice(0);
    QTest::mouseClick(find<QPushButton>("undoButton"), Qt::LeftButton);  // accept of the last outline
    QVERIFY(mri()->slice() != 0);
    QTest::mouseClick(find<QPushButton>("undoButton"), Qt::LeftButton);  // its drawing
    QCOMPARE(session().contours().polygons.size(), before - 1);
    QTest::mouseClick(find<QPushButton>("redoButton"), Qt::LeftButton);
    QTest::mouseClick(find<QPushButton>("redoButton"), Qt::LeftButton);
    QCOMPARE(session().contours().polygons.size(), before);
    QCOMPARE(session().acceptedCount(), before);
  }

  void aDraftIsParkedNotLost() {
    const auto before = session().contours().polygons.size();
    mri()->setSlice(2);
    for (const QPoint at : {QPoint(120, 120), QPoint(200, 120), QPoint(200, 200)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
    mri()->setSlice(3);
    QCOMPARE(session().contours().polygons.size(), before + 1);
    QCOMPARE(session().contours().polygons.back().state, glisson::roi::PolygonState::Draft);
    session().undo();
    QCOMPARE(session().contours().polygons.size(), before);
  }

  void interpolatesBetweenTheDrawnSlices() {
    const auto drawn = session().contours();
    QCOMPARE(session().coverage().empty.size(), std::size_t{9});
    QVERIFY(!find<QPushButton>("acceptAllButton")->isEnabled());
    click("interpolateButton");
    QTRY_COMPARE(session().coverage().interpolated.size(), std::size_t{9});
    QVERIFY(session().coverage().empty.empty());
    QCOMPARE(session().acceptedCount(), std::size_t{4});
    for (std::size_t p = 0; p < 4; ++p)
      QVERIFY(session().contours().polygons[p].points_lps_mm == drawn.polygons[p].points_lps_mm);
    const auto* list = find<QTreeWidget>("outlineList");
    QCOMPARE(list->findItems("interpolated", Qt::MatchExactly, 2).size(), 9);
    QCOMPARE(list->findItems("drawn", Qt::MatchExactly, 2).size(), 4);
    session().undo();  // one step
    QCOMPARE(session().contours().polygons.size(), drawn.polygons.size());
    QCOMPARE(list->findItems("empty", Qt::MatchExactly, 2).size(), 9);
    session().redo();
    QCOMPARE(session().coverage().interpolated.size(), std::size_t{9});
    click("acceptAllButton");
    QCOMPARE(session().acceptedCount(), std::size_t{13});
    session().undo();
    QCOMPARE(session().acceptedCount(), std::size_t{4});
  }

  void whatIsNoLiverTakesThePatch() {
    // A prism as small as this one has no place for a rigid bar: the published patch, in linear theory, is chosen. It
    // is also what is moved live below; what a rigid bar does is asked of a whole liver, at the end.
    window().showStep(Step::Retract);
    QCOMPARE(find<QComboBox>("contactKind")->currentIndex(), 0);
    QVERIFY(!find<QWidget>("retractorSpread")->isEnabled() && find<QWidget>("capsule")->isEnabled());
    QVERIFY(find<QWidget>("retractorSpread")->toolTip().contains("rigid"));
    find<QComboBox>("contactKind")->setCurrentIndex(1);
    QVERIFY(session().parameters().contact == glisson::retraction::ContactKind::Patch);
    QVERIFY(find<QWidget>("retractorSpread")->isEnabled());
    for (const char* name : {"capsule", "capsuleTension", "barShape", "retractorTravel"}) {
      QVERIFY2(!find<QWidget>(name)->isEnabled(), name);
      QVERIFY2(find<QWidget>(name)->toolTip().contains("patch"), name);
    }
    window().showStep(Step::Model);
    // Where none is offered the page says why, and keeps what was chosen.
    find<QComboBox>("analysis")->setCurrentIndex(1);
    QVERIFY(!find<QComboBox>("contactKind")->isEnabled());
    QVERIFY(find<QComboBox>("contactKind")->toolTip().contains("time steps"));
    find<QComboBox>("analysis")->setCurrentIndex(0);
    QVERIFY(find<QComboBox>("contactKind")->isEnabled());
    find<QComboBox>("kinematics")->setCurrentIndex(0);
    QVERIFY(session().parameters().kinematics == glisson::retraction::Kinematics::Linear);
  }

  void cancelAnswersWithinAQuarterOfASecond() {
    window().showStep(Step::Model);
    find<QDoubleSpinBox>("cellSize")->setValue(6.0);
    QSignalSpy ended(&session(), &Session::workEnded);
    QSignalSpy progress(&session(), &Session::progressed);
    click("modelRunButton");
    QCOMPARE(session().status(Step::Retract).state, StepState::Running);
    QVERIFY(progress.wait(wait_ms));
    QElapsedTimer clock;
    clock.start();
    QTest::mouseClick(find<QPushButton>("cancelButton"), Qt::LeftButton);
    QVERIFY(ended.count() > 0 || ended.wait(wait_ms));
    qInfo("cancelled after %lld ms", static_cast<long long>(clock.elapsed()));
    QVERIFY(!session().result());
    QVERIFY(!session().busy());
  }

  void runsAndShowsTheOverlay() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    QSignalSpy finished(&session(), &Session::runFinished);
    QSignalSpy drawn(compare, &glisson::panels::ComparePage::overlayShown);
    QSignalSpy ended(&session(), &Session::workEnded);
    window().showStep(Step::Retract);
    // Before a run the bar can be laid at once, and there is nothing to play.
    QVERIFY(find<QWidget>("addHold")->isVisible() && find<QWidget>("automaticBar")->isVisible());
    QVERIFY(!find<QWidget>("playButton")->isVisible() && !find<QWidget>("movedButton")->isEnabled());
    StallMonitor stalls;
    click("runButton");
    QVERIFY(ended.wait(wait_ms));
    QVERIFY2(finished.count() == 1, qPrintable(session().status(Step::Retract).detail));
    QVERIFY(drawn.count() > 0 || drawn.wait(wait_ms));
    qInfo("longest time without an answer while running: %.0f ms", stalls.report().max_ms);
    glisson::test::judge(stalls.report());
    QCOMPARE(window().step(), Step::Compare);
    QCOMPARE(session().status(Step::Compare).state, StepState::Done);
    const QImage overlay = find<PictureView>("overlayView")->picture();
    int coloured = 0;
    for (int y = 0; y < overlay.height(); y += 2)
      for (int x = 0; x < overlay.width(); x += 2) {
        const QRgb p = overlay.pixel(x, y);
        if (std::abs(qRed(p) - qBlue(p)) > 24) ++coloured;
      }
    QVERIFY2(coloured > 50, "the overlay shows no difference between MRE and atlas");
    QVERIFY(find<QLabel>("differenceAtRetractor")->text().contains("mm"));
    // Four ellipses of 12 vertices, and what was interpolated between them: one prism over 13 slices.
    const double area_mm2 = 0.5 * 12.0 * std::sin(2.0 * M_PI / 12.0) * 30.0 * 24.0;
    const double prism_mL = 1e-3 * area_mm2 * 13.0 * session().images().mri->grid.spacing_mm.z();
    const double volume_mL = session().result()->model.volume_mL;
    QVERIFY2(std::abs(volume_mL - prism_mL) < 0.1 * prism_mL,
             qPrintable(QString("%1 mL instead of %2").arg(volume_mL).arg(prism_mL)));
    QVERIFY(std::any_of(session().result()->warnings.begin(), session().result()->warnings.end(),
                        [](const auto& w) { return w.find("outlines on 4 of 13 slices") != std::string::npos; }));
  }

  void theToolIsMovedLive() {
    auto* live = window().findChild<glisson::panels::LiveBar*>();
    auto* view = find<glisson::views::SceneView>("retractView");
    QTRY_VERIFY_WITH_TIMEOUT(live->isReady(), wait_ms);
    QSignalSpy rendered(view, &glisson::views::SceneView::rendered);
    window().showStep(Step::Retract);
    QVERIFY(rendered.wait(wait_ms));
    // After a run it can be played and moved at once; laying is one click away, and back.
    const auto shows = [this](bool moving) {
      for (const char* name : {"playButton", "timeSlider", "liveButton"})
        if (find<QWidget>(name)->isVisible() != moving) return false;
      return find<QWidget>("addHold")->isVisible() != moving;
    };
    QVERIFY(shows(true));
    click("placeButton");
    QVERIFY(shows(false));
    click("movedButton");
    QVERIFY(shows(true));
    click("liveButton");
    QVERIFY(live->isLive() && view->isLive());
    // Under the force of the run the live livers lie where the run put them, on their coarser cells.
    const auto& run = *session().result()->difference;
    const double close = (session().result()->placed ? 0.15 : 1e-3) * std::max(run.vesselMax_mm, 1.0);
    QTRY_VERIFY_WITH_TIMEOUT(live->isAtRest(), wait_ms);
    QVERIFY2(std::abs(live->frame().vesselMax_mm - run.vesselMax_mm) < close,
             qPrintable(QString("%1 instead of %2 mm").arg(live->frame().vesselMax_mm).arg(run.vesselMax_mm)));
    QVERIFY(std::abs(live->frame().vesselMean_mm - run.vesselMean_mm) < close);
    QVERIFY(rendered.wait(wait_ms));
    // The mouse takes the tool where it is seen; twelve pixels up, the contact follows.
    auto* canvas = static_cast<QWidget*>(view);
    const auto seen = view->toolPixel();
    QVERIFY(seen.has_value());
    const QPoint at = seen->toPoint();
    const Eigen::Vector3d before = live->frame().toolMre_mm;
    QTest::mousePress(canvas, Qt::LeftButton, {}, at);
    double slowest_s = 0.0, sum_s = 0.0;
    for (int n = 1; n <= 12; ++n) {
      QTest::mouseMove(canvas, at - QPoint(0, n));
      QTest::qWait(20);
      slowest_s = std::max(slowest_s, live->frame().seconds);
      sum_s += live->frame().seconds;
    }
    QTest::mouseRelease(canvas, Qt::LeftButton, {}, at - QPoint(0, 12));
    QTRY_VERIFY_WITH_TIMEOUT(QLineF(*view->toolPixel(), *seen - QPointF(0, 12)).length() < 2.0, wait_ms);
    QTRY_VERIFY_WITH_TIMEOUT(live->isAtRest(), wait_ms);
    QVERIFY((live->frame().toolMre_mm - before).norm() > 1.0);
    qInfo("frame of the simulation: %.2f ms, slowest %.2f ms, for %lld points", 1e3 * sum_s / 12.0, 1e3 * slowest_s,
          static_cast<long long>(live->frame().mre_mm.cols()));
    // Without a mouse: a slider's arrow key is one millimetre.
    auto* slider = find<QSlider>("liveSliderP");
    const Eigen::Vector3d held = live->frame().toolMre_mm;
    QTest::keyClick(slider, Qt::Key_Right);
    QTRY_VERIFY_WITH_TIMEOUT(std::abs(live->frame().toolMre_mm.y() - held.y() - 1.0) < 0.06, wait_ms);
    QVERIFY(find<QLabel>("liveNumbers")->text().contains("mm"));
    click("liveReset");
    QTRY_VERIFY_WITH_TIMEOUT(live->isAtRest() && std::abs(live->frame().vesselMax_mm - run.vesselMax_mm) < close,
                             wait_ms);
    click("liveButton");
    QVERIFY(!view->isLive());
    window().showStep(Step::Compare);
  }

  void vesselsBeyondFiveMillimetresAreListedAndFound() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    auto* list = find<QTreeWidget>("vesselList");
    const auto& apart = session().result()->difference->vessel_mm;
    const auto beyond = std::count_if(apart.begin(), apart.end(), [](double d) { return d >= 5.0; });
    QCOMPARE(static_cast<std::ptrdiff_t>(list->topLevelItemCount()), beyond);
    QSignalSpy drawn(compare, &glisson::panels::ComparePage::overlayShown);
    if (beyond > 0) {
      list->setCurrentItem(list->topLevelItem(0));
      QVERIFY(drawn.count() > 0 || drawn.wait(wait_ms));
      QCOMPARE(drawn.back().front().toInt() + 1, list->topLevelItem(0)->text(1).toInt());
      drawn.clear();
    }
    const QImage overlay = find<PictureView>("overlayView")->picture();
    find<QComboBox>("sliceChoice")->setCurrentIndex(1);
    QVERIFY(drawn.count() > 0 || drawn.wait(wait_ms));
    QVERIFY(find<PictureView>("overlayView")->picture() != overlay);
    find<QComboBox>("sliceChoice")->setCurrentIndex(0);
    QTRY_VERIFY(find<PictureView>("boxPlotView")->hasPicture());
    QVERIFY(find<QLabel>("validityText")->text().contains("cells of"));
  }

  void methodsAreMeasuredOnThisPatient() {
    auto* chart = window().findChild<glisson::panels::MethodChart*>();
    find<QComboBox>("besideChoice")->setCurrentIndex(2);
    QVERIFY(!chart->isReady());
    // On request only, and it can be stopped.
    QSignalSpy stopped(chart, &glisson::panels::MethodChart::stopped);
    QSignalSpy ready(chart, &glisson::panels::MethodChart::ready);
    click("methodStart");
    click("methodCancel");
    QVERIFY(stopped.count() > 0 || stopped.wait(wait_ms));
    QVERIFY2(stopped.front().front().toString().isEmpty(), qPrintable(stopped.front().front().toString()));
    QVERIFY(!chart->isReady());
    StallMonitor stalls;
    click("methodStart");
    QVERIFY(ready.wait(wait_ms));
    qInfo("longest time without an answer while methods are measured: %.0f ms", stalls.report().max_ms);
    glisson::test::judge(stalls.report());
    QVERIFY(find<PictureView>("methodPicture")->hasPicture());
    auto* rows = find<QTreeWidget>("methodRows");
    QVERIFY(rows->topLevelItemCount() > 10);
    int marked = 0, exact = 0;
    for (int r = 0; r < rows->topLevelItemCount(); ++r) {
      const QString name = rows->topLevelItem(r)->text(0);
      if (name.contains("default") && name.contains("your choice") && name.startsWith("H8-incompatible")) ++marked;
      if (rows->topLevelItem(r)->text(1).endsWith("mm")) ++exact;
    }
    QCOMPARE(marked, 1);
    QVERIFY(exact > 8);
    QVERIFY(find<QLabel>("methodWords")->text().contains("The default method errs by at most"));
    find<QComboBox>("besideChoice")->setCurrentIndex(0);
  }

  void picturesAndReportAreExported() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    QSignalSpy exported(compare, &glisson::panels::ComparePage::exported);
    const auto target = folder() / "exported";
    compare->exportTo(path("exported"));
    QVERIFY(exported.wait(wait_ms));
    QVERIFY2(exported.front()[1].toString().isEmpty(), qPrintable(exported.front()[1].toString()));
    for (const char* name : {"overlay-largest-difference.png", "difference-map.png", "overlay-3d-oblique.png",
                             "difference-boxes.png", "difference-boxes.svg", "report.html", "run.json"})
      QVERIFY2(std::filesystem::file_size(target / name) > 1000, name);
    // The record names what lies there, no more and no less, each with its own digest.
    QFile file(path("exported/run.json"));
    QVERIFY(file.open(QIODevice::ReadOnly));
    const QJsonObject record = QJsonDocument::fromJson(file.readAll()).object();
    QSet<QString> named{QStringLiteral("run.json")};
    for (const char* list : {"outputs", "charts"})
      for (const QJsonValue& one : record[QLatin1String(list)].toArray()) {
        const QString name = one["file"].toString();
        named.insert(name);
        QCOMPARE(one["sha256"].toString().toStdString(), glisson::sha256OfFile(target / name.toStdString()));
      }
    QSet<QString> there;
    for (const auto& entry : std::filesystem::directory_iterator(target))
      if (entry.is_regular_file()) there.insert(QString::fromStdString(entry.path().filename().string()));
    QCOMPARE(there, named);
    // In other colours: pictures, report and record say so; the numbers are the same.
    find<QComboBox>("paletteChoice")->setCurrentIndex(1);
    exported.clear();
    compare->exportTo(path("exported-orange"));
    QVERIFY(exported.wait(wait_ms));
    find<QComboBox>("paletteChoice")->setCurrentIndex(0);
    QFile other(path("exported-orange/run.json"));
    QVERIFY(other.open(QIODevice::ReadOnly));
    const QJsonObject orange = QJsonDocument::fromJson(other.readAll()).object();
    QCOMPARE(record["palette"].toString(), QStringLiteral("red-blue"));
    QCOMPARE(orange["palette"].toString(), QStringLiteral("colour-blind"));
    QCOMPARE(orange["results_sha256"], record["results_sha256"]);
    QFile report(path("exported-orange/report.html"));
    QVERIFY(report.open(QIODevice::ReadOnly));
    QVERIFY(report.readAll().contains("textbook in orange"));
    const auto picture = [&](const char* where) {
      return glisson::sha256OfFile(folder() / where / "overlay-largest-difference.png");
    };
    QVERIFY(picture("exported") != picture("exported-orange"));
    QCOMPARE(QString::fromStdString(picture("exported")),
             QString::fromStdString(glisson::sha256OfFile(std::filesystem::path(session().runFolder().toStdString()) /
                                                          "overlay-largest-difference.png")));
  }

  void theRetractionIsFilmed() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    QVERIFY(find<QPushButton>("videoButton")->isEnabled());
    QSignalSpy exported(compare, &glisson::panels::ComparePage::exported);
    glisson::session::VideoWish wish;
    wish.width = 320;
    wish.height = 240;
    wish.moving = 5;
    wish.resting = wish.holding = 2;
    session().exportVideo(path("film.webm"), wish);
    QVERIFY(exported.wait(wait_ms));
    QVERIFY2(exported.front()[1].toString().isEmpty(), qPrintable(exported.front()[1].toString()));
    QVERIFY(std::filesystem::file_size(folder() / "film.webm") > 2000);
    // Broken off, nothing of it stays.
    exported.clear();
    QSignalSpy progress(&session(), &Session::progressed);
    compare->filmTo(path("cancelled.mp4"));
    QVERIFY(progress.count() > 0 || progress.wait(wait_ms));
    click("cancelButton");
    QVERIFY(exported.count() > 0 || exported.wait(wait_ms));
    QCOMPARE(exported.front()[0].toInt(), 0);
    QVERIFY(!std::filesystem::exists(folder() / "cancelled.mp4"));
  }

  void anExportShowsHowFarItIsAndCanBeCancelled() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    QSignalSpy exported(compare, &glisson::panels::ComparePage::exported);
    QSignalSpy progress(&session(), &Session::progressed);
    compare->exportTo(path("cancelled"));
    QVERIFY(find<QPushButton>("cancelButton")->isVisible() && !find<QPushButton>("exportButton")->isEnabled());
    QVERIFY(progress.count() > 0 || progress.wait(wait_ms));
    click("cancelButton");
    QVERIFY(exported.count() > 0 || exported.wait(wait_ms));
    QCOMPARE(exported.front()[0].toInt(), 0);
    QVERIFY(!exported.front()[1].toString().isEmpty());
    QVERIFY2(std::filesystem::is_empty(folder() / "cancelled"), "half an export would pass for a whole one");
    QVERIFY(find<QPushButton>("exportButton")->isEnabled());
  }

  void aSavedCaseShowsItsLastRunWhenItIsOpenedAgain() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    const char* shown[] = {"differenceAtRetractor", "differenceNumbers", "vesselNumbers", "validityText",
                           "solutionNumbers"};
    QStringList before;
    for (const char* name : shown) before << find<QLabel>(name)->text();
    const auto numbers = session().result();
    session().saveCase(path("kept"));
    QSignalSpy ran(&session(), &Session::runFinished);
    QSignalSpy drawn(compare, &glisson::panels::ComparePage::overlayShown);
    QVERIFY(openPath(path("kept")));
    QVERIFY(session().result() && session().result() != numbers && session().picture());
    QCOMPARE(session().result()->json, numbers->json);
    QCOMPARE(session().status(Step::Compare).state, StepState::Done);
    QVERIFY(drawn.count() > 0 || drawn.wait(wait_ms));
    for (std::size_t n = 0; n < std::size(shown); ++n)
      QCOMPARE(find<QLabel>(shown[n])->text(), before[static_cast<qsizetype>(n)]);
    QVERIFY2(ran.isEmpty(), "nothing was solved again");
    // The tool can be taken at once, and the report is that of the run.
    auto* live = window().findChild<glisson::panels::LiveBar*>();
    QTRY_VERIFY_WITH_TIMEOUT(live->isReady(), wait_ms);
    QSignalSpy exported(compare, &glisson::panels::ComparePage::exported);
    compare->exportTo(path("exported-again"));
    QVERIFY(exported.wait(wait_ms));
    QVERIFY2(exported.front()[1].toString().isEmpty(), qPrintable(exported.front()[1].toString()));
    QCOMPARE(QString::fromStdString(glisson::sha256OfFile(folder() / "exported-again" / "report.html")),
             QString::fromStdString(glisson::sha256OfFile(folder() / "exported" / "report.html")));
    // One byte of it changed: the case opens, and says that it must be run again.
    QFile file(path("kept") + "/last-run/results/result.glisson");
    QVERIFY(file.open(QIODevice::ReadWrite) && file.seek(file.size() / 2));
    char byte = 0;
    QVERIFY(file.peek(&byte, 1) == 1);
    byte = static_cast<char>(byte ^ 1);
    QVERIFY(file.write(&byte, 1) == 1);
    file.close();
    QSignalSpy said(&session(), &Session::message);
    QVERIFY(openPath(path("kept")));
    QVERIFY(!session().result() && session().images().mri && session().acceptedCount() > 0);
    QVERIFY(std::any_of(said.begin(), said.end(),
                        [](const auto& text) { return text.front().toString().contains("run the case again"); }));
    byte = static_cast<char>(byte ^ 1);
    QVERIFY(file.open(QIODevice::ReadWrite) && file.seek(file.size() / 2) && file.write(&byte, 1) == 1);
    file.close();
    QVERIFY(openPath(path("kept")) && session().result());
    window().showStep(Step::Compare);
  }

  void theCommandLineGivesTheSameNumbers() {
    // What the window ran is the case on disk: run it again from there, as the command line does.
    const auto scene = glisson::pipeline::readScene(folder() / "work" / "scene.json");
    glisson::pipeline::RunOptions options;
    options.output = folder() / "again";
    glisson::pipeline::RunResult again;
    std::exception_ptr failure;
    // On a thread of its own: here the window's OpenGL context is current, and the pictures need one of theirs.
    std::thread([&] {
      try {
        again = glisson::pipeline::run(scene, options);
      } catch (...) {
        failure = std::current_exception();
      }
    }).join();
    QVERIFY2(!failure, qPrintable(glisson::session::reasonOf(failure)));
    QVERIFY(again.difference && session().result()->difference);
    QCOMPARE(again.difference->mean_mm, session().result()->difference->mean_mm);
    QCOMPARE(again.difference->max_mm, session().result()->difference->max_mm);
    QCOMPARE(again.difference->at_retractor_mm, session().result()->difference->at_retractor_mm);
  }

  void aChangeUpstreamMakesTheResultStale() {
    window().showStep(Step::Retract);
    find<QDoubleSpinBox>("retractorDiameter")->setValue(12.0);
    QCOMPARE(session().status(Step::Compare).state, StepState::Stale);
    find<QDoubleSpinBox>("retractorDiameter")->setValue(10.0);
  }

  void theWindowsSceneIsThatOfTheSyntheticPatient() {
    // Outlines of the patient's own structure set and the parameters as the window starts with them, against the scene
    // that lies beside the patient: the same mechanics, and the same numbers. Pictures are left out on both sides, they
    // change no number; cells are larger, so that it takes less long.
    const auto patient = folder() / "synthetic-patient-3";
    session().importContours(QString::fromStdString((patient / "rtstruct.dcm").string()));
    session().setParameters({});
    const auto saved = folder() / "saved";
    session().saveCase(QString::fromStdString(saved.string()));
    const auto numbers = [](const std::filesystem::path& file) {
      auto scene = glisson::pipeline::readScene(file);
      scene.outputs = {};
      scene.geometry.cell_mm.setConstant(6.0);
      glisson::pipeline::RunOptions options;
      options.discretisation = false;
      return glisson::pipeline::run(scene, options);
    };
    const auto mechanics = [](const std::filesystem::path& file) {
      QJsonObject scene =
          QJsonDocument::fromJson(QByteArray::fromStdString(toJson(glisson::pipeline::readScene(file)))).object();
      for (const char* other : {"geometry", "seed", "outputs"}) scene.remove(QLatin1String(other));
      QJsonArray loads = scene["loads"].toArray();
      QJsonObject bar = loads[0].toObject();
      if (!bar.contains("contact")) bar["contact"] = "rigid";  // what a scene that does not say it has
      loads[0] = bar;
      scene["loads"] = loads;
      return QString::fromUtf8(QJsonDocument(scene).toJson());
    };
    QCOMPARE(mechanics(saved / "scene.json"), mechanics(patient / "scene.json"));
    const auto window = numbers(saved / "scene.json"), own = numbers(patient / "scene.json");
    QCOMPARE(window.model.cells, own.model.cells);
    QCOMPARE(window.model.mass_kg, own.model.mass_kg);
    QCOMPARE(window.primary.max_displacement_mm, own.primary.max_displacement_mm);
    QCOMPARE(window.primary.energy_J, own.primary.energy_J);
    QCOMPARE(window.primary.max_strain, own.primary.max_strain);
    QCOMPARE(window.difference->mean_mm, own.difference->mean_mm);
    QCOMPARE(window.difference->at_retractor_mm, own.difference->at_retractor_mm);
    QVERIFY(own.difference->at_retractor_mm > 0.0);
    QVERIFY(window.primary.contact && window.primary.kinematics == glisson::retraction::Kinematics::Hyperelastic);
    QCOMPARE(window.primary.contact->travel_mm, own.primary.contact->travel_mm);
    QCOMPARE(*window.difference->travel_mm, *own.difference->travel_mm);
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Journey)
#include "journey_test.moc"

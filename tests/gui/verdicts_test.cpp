// SPDX-License-Identifier: GPL-3.0-or-later

// What the window says of its numbers: whose they are, of which slice, what counts, how far to trust them and what to
// do about it.
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QTreeWidget>

#include "panels/compare_page.h"
#include "session/trust.h"
#include "views/picture_view.h"
#include "views/scene_view.h"
#include "window_bench.h"

using glisson::commands::MadeBy;
using glisson::roi::PolygonState;
using glisson::session::Parameters;
using glisson::session::Remedy;
using glisson::session::Session;
using glisson::session::Step;
using glisson::session::StepState;
using glisson::test::changed;
using glisson::test::wait_ms;

/// The functions run in order on one window with the synthetic patient.
class Verdicts : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  QString textOf(const char* name) { return find<QLabel>(name)->text(); }
  /// The statistics of the map's slice under the MRI slice shown, as they were measured.
  std::optional<glisson::elastography::Statistics> measuredHere() {
    const auto& mre = session().images().stiffness->values_kPa.grid;
    const auto& mri = session().images().mri->grid;
    const Eigen::Vector3d here = mri.indexToLps({0.5 * mri.size.x(), 0.5 * mri.size.y(), 1.0 * this->mri()->slice()});
    const auto k = static_cast<int>(std::lround(mre.lpsToIndex(here).z()));
    for (const auto& s : session().statistics().pooled->slices)
      if (s.slice == k) return s.statistics;
    return std::nullopt;
  }

 private slots:
  void initTestCase() {
    QVERIFY(openSynthetic());
    window().showStep(Step::Segment);
  }

  void aDraftIsNamedWhereverItDoesNotCount() {
    const QPoint at = showLiver();
    const QString slice = QString::number(mri()->slice() + 1);
    for (const QPoint corner : {QPoint(-40, -40), QPoint(40, -40), QPoint(40, 40)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at + corner);
    QTest::keyClick(mri(), Qt::Key_Escape);
    session().tool().deselect();
    QCOMPARE(polygons().size(), 1u);
    QCOMPARE(polygons().front().state, PolygonState::Draft);
    QVERIFY2(textOf("outlineCoverage").contains("slices " + slice), qPrintable(textOf("outlineCoverage")));
    QVERIFY(find<QLabel>("draftsNote")->isVisibleTo(find<QWidget>("runButton")->parentWidget()));
    QVERIFY(textOf("draftsNote").contains(slice));
    // Enter accepts it on its slice, without its having to be clicked.
    QTest::keyClick(mri(), Qt::Key_Return);
    QCOMPARE(polygons().front().state, PolygonState::Accepted);
    QVERIFY(!textOf("outlineCoverage").contains("Drafts"));
    QVERIFY(textOf("draftsNote").isEmpty());
    session().tool().deselect();
    QSignalSpy said(&session(), &Session::message);
    QTest::keyClick(mri(), Qt::Key_Return);
    QVERIFY(!said.isEmpty() && said.back().front().toString().contains("waits"));
    clean();
  }

  void whatTheProgramMadeIsNotCalledDrawn() {
    const Eigen::Vector3d place = glisson::test::trustedPlace(session());
    const int middle = static_cast<int>(std::lround(session().images().mri->grid.lpsToIndex(place).z()));
    for (const int k : {middle, middle + 6}) {
      mri()->setSlice(k);
      Eigen::Vector3d on = session().images().mri->grid.lpsToIndex(place);
      on.z() = k;
      ellipse(session().images().mri->grid.indexToLps(on), 30.0, 24.0, 12);
      QTest::keyClick(mri(), Qt::Key_Return);
      session().tool().deselect();
    }
    QSignalSpy ended(&session(), &Session::workEnded);
    QTest::keyClick(mri(), Qt::Key_B);
    QVERIFY(ended.count() > 0 || ended.wait(wait_ms));
    QVERIFY2(textOf("outlineCoverage").startsWith("2 drawn, 5 interpolated, 0 empty"),
             qPrintable(textOf("outlineCoverage")));
    session().acceptInterpolated();
    QVERIFY2(textOf("outlineCoverage").contains("2 drawn, 5 interpolated"), "accepted, and still drawn by nobody");
    QVERIFY(textOf("outlineCoverage").contains("5 were accepted"));
    // What is kept in a case is still told from what was drawn.
    session().saveCase(path("made"));
    QVERIFY(openPath(path("made")));
    QVERIFY(textOf("outlineCoverage").contains("2 drawn, 5 interpolated"));
  }

  void theNumberShownIsThatOfTheSliceShown() {
    session().importContours(
        QString::fromStdString((folder() / "patients" / "synthetic-patient-3" / "rtstruct.dcm").string()));
    mri()->showPoint(glisson::test::trustedPlace(session()));
    QTRY_VERIFY_WITH_TIMEOUT(session().statistics().pooled && session().statistics().pooled->slices.size() > 3,
                             wait_ms);
    QTRY_VERIFY(!session().statistics().reason.size());
    for (int n = 0; n < 16; ++n) {
      glisson::test::wheel(mri(), {200, 200}, n < 10 ? 120 : -120);
      const auto here = measuredHere();  // at once: nothing is waited for
      QCOMPARE(session().statistics().slice.has_value(), here.has_value());
      if (!here) continue;
      QCOMPARE(session().statistics().slice->mean_kPa, here->mean_kPa);
      QVERIFY(textOf("liveReadout").contains(QString::number(here->n)));
    }
  }

  void aMeanHasWhatAReaderMustKnowBesideIt() {
    QTRY_VERIFY(session().statistics().pooled.has_value());
    const auto& m = *session().statistics().pooled;
    QVERIFY(m.rim > 0);  // the edge is left out unless the reader wants it
    const QString words = textOf("readingText");
    QVERIFY2(words.contains(QString::number(0.19 * m.pooled.mean_kPa, 'f', 2)), qPrintable(words));
    const double share = 100.0 * static_cast<double>(m.pooled.n) / static_cast<double>(m.drawn);
    QVERIFY2(words.contains(QString::number(share, 'f', 0) + " %"), qPrintable(words));
    QVERIFY2(words.contains(QString::number(m.meanOfAll_kPa, 'f', 2)), qPrintable(words));
  }

  void aRunIsJudgedAndItsRemediesAreOffered() {
    Parameters p = session().parameters();
    p.contact = glisson::retraction::ContactKind::Patch;
    p.kinematics = glisson::retraction::Kinematics::Linear;
    p.cell_mm = 9.0;
    session().setParameters(p);
    QSignalSpy finished(&session(), &Session::runFinished);
    session().run();
    QVERIFY(finished.count() > 0 || finished.wait(wait_ms));
    QCOMPARE(window().step(), Step::Compare);
    const auto doubts = glisson::session::doubtsAbout(*session().result());
    QVERIFY2(!doubts.empty(), "linear theory under the liver's weight without a doubt");
    for (const char* panel : {"validityText", "retractValidity"})
      for (const auto& d : doubts) {
        QString plain = textOf(panel);
        plain.remove(QRegularExpression("<[^>]*>"));
        QVERIFY2(plain.contains(d.text.mid(1).toHtmlEscaped()), qPrintable(d.text));
      }
    const auto* large =
        find<QPushButton>(("remedy" + std::to_string(static_cast<int>(Remedy::LargeDeformation))).c_str());
    QVERIFY(large->isEnabled());
    // The verdict knows its own error.
    const auto significance = glisson::pipeline::significanceOf(*session().result());
    QCOMPARE(textOf("differenceVerdict").startsWith("Cannot be told"),
             significance == glisson::pipeline::Significance::Open);
  }

  void resultsOfOtherParametersAreGreyedUntilTheyAreBack() {
    auto* compare = window().findChild<glisson::panels::ComparePage*>();
    auto* overlay = find<glisson::views::PictureView>("overlayView");
    QTRY_VERIFY_WITH_TIMEOUT(overlay->hasPicture(), wait_ms);
    QVERIFY(!find<QWidget>("outdatedCard")->isVisible());
    const QImage before = overlay->grab().toImage();
    const Parameters ran = session().parameters();
    Parameters other = ran;
    other.atlasShear_kPa += 0.5;
    session().setParameters(other);
    QVERIFY(find<QWidget>("outdatedCard")->isVisible());
    QVERIFY2(textOf("outdatedText").contains("other parameters"), qPrintable(textOf("outdatedText")));
    QVERIFY(!find<QLabel>("differenceAtRetractor")->isEnabled() && !find<QLabel>("differenceNumbers")->isEnabled());
    QVERIFY(changed(before, overlay->grab().toImage()) > before.width() * before.height() / 20);
    QCOMPARE(session().status(Step::Compare).state, StepState::Stale);
    session().setParameters(ran);
    QVERIFY(!find<QWidget>("outdatedCard")->isVisible());
    QVERIFY(find<QLabel>("differenceAtRetractor")->isEnabled());
    QVERIFY(changed(before, overlay->grab().toImage()) == 0);
    QCOMPARE(session().status(Step::Compare).state, StepState::Done);
    // Outlines are told from parameters.
    mri()->setSlice(2);
    session().toggleMark(glisson::commands::SliceMark::NoLiver);
    QVERIFY2(textOf("outdatedText").contains("earlier outlines"), qPrintable(textOf("outdatedText")));
    QVERIFY(compare->isVisible());
  }

  void aRemedyChangesWhatItSaysAndRuns() {
    const std::string name = "remedy" + std::to_string(static_cast<int>(Remedy::LargeDeformation));
    QSignalSpy started(&session(), &Session::workStarted);
    QSignalSpy ended(&session(), &Session::workEnded);
    click(name.c_str());
    QCOMPARE(session().parameters().kinematics, glisson::retraction::Kinematics::Hyperelastic);
    QCOMPARE(started.count(), 1);
    QVERIFY(session().busy());
    session().cancel();
    QVERIFY(ended.count() > 0 || ended.wait(wait_ms));
  }
};

QTEST_MAIN(Verdicts)
#include "verdicts_test.moc"

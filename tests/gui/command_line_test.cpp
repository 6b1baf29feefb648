// SPDX-License-Identifier: GPL-3.0-or-later

// What was done with the mouse, run again by `glisson-cli run case.json`: the same numbers and the same files, to the
// last bit.
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QProcess>
#include <QPushButton>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "panels/placement_editor.h"
#include "session/model_preview.h"
#include "session/session.h"
#include "views/scene_view.h"
#include "window_bench.h"

using glisson::panels::PlacementEditor;
using glisson::session::Step;
using glisson::test::wait_ms;
using glisson::views::SceneView;
using Json = nlohmann::json;

class CommandLine : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  struct Answer {
    int code = -1;
    QString out, error;
  };
  static Answer cli(const QStringList& arguments) {
    QProcess process;
    process.start(QStringLiteral(GLISSON_CLI), arguments);
    Answer a;
    if (!process.waitForFinished(wait_ms)) return a;
    a.code = process.exitCode();
    a.out = QString::fromUtf8(process.readAllStandardOutput());
    a.error = QString::fromUtf8(process.readAllStandardError());
    return a;
  }
  static Json read(const std::filesystem::path& file) { return Json::parse(glisson::readWhole(file)); }
  static Json parametersOf(Json record) { return record.at("parameters"); }
  /// What must be the same: all numbers and words, every file but the record itself.
  void expectSame(const Json& window, const Json& again) {
    QCOMPARE(again.at("results_sha256").get<std::string>(), window.at("results_sha256").get<std::string>());
    QVERIFY(parametersOf(again) == parametersOf(window));
    std::map<std::string, std::string> files, others;
    for (const Json& f : window.at("outputs")) files[f.at("file")] = f.at("sha256");
    for (const Json& f : again.at("outputs")) others[f.at("file")] = f.at("sha256");
    QVERIFY(files.size() > 5);
    for (const auto& [file, digest] : files)
      QVERIFY2(others[file] == digest, qPrintable(QStringLiteral("%1 differs").arg(QString::fromStdString(file))));
    QCOMPARE(others.size(), files.size());
  }
  void runHere() {
    QSignalSpy ended(&session(), &glisson::session::Session::workEnded);
    window().showStep(Step::Retract);
    click("runButton");
    QVERIFY(ended.wait(wait_ms));
    QVERIFY2(session().result() && !session().resultIsStale(), qPrintable(session().status(Step::Retract).detail));
    session().saveCase(path("case"));
  }

 private slots:
  void initTestCase() {
    QVERIFY(openSynthetic());
    // Outlines, a mark, parameters: with the mouse and the keys.
    const Eigen::Vector3d centre = glisson::test::trustedPlace(session());
    mri()->showPoint(centre);
    const int middle = mri()->slice();
    for (const int slice : {middle - 6, middle, middle + 6}) {
      mri()->setSlice(slice);
      ellipse(centre, 32.0, 25.0, 14);
      QTest::keyClick(mri(), Qt::Key_Return);
    }
    mri()->setSlice(0);
    QTest::keyClick(mri(), Qt::Key_A);
    QCOMPARE(session().acceptedCount(), std::size_t{3});
    window().showStep(Step::Model);
    find<QDoubleSpinBox>("cellSize")->setValue(5.5);
    find<QDoubleSpinBox>("poisson")->setValue(0.43);
    window().showStep(Step::Retract);
    // A prism as small as this one has no place for a rigid bar.
    find<QComboBox>("contactKind")->setCurrentIndex(1);
    find<QDoubleSpinBox>("retractorDiameter")->setValue(11.0);
  }

  void theCaseOfTheWindowGivesTheSameFiles() {
    runHere();
    const Answer a = cli({"run", path("case/case.json"), "--output", path("again"), "--json", "--quiet"});
    QVERIFY2(a.code == 0, qPrintable(a.error));
    expectSame(read(folder() / "work" / "results" / "run.json"), read(folder() / "again" / "run.json"));
    QVERIFY(Json::parse(a.out.toStdString()).at("difference") ==
            read(folder() / "work" / "results" / "run.json").at("difference"));
  }

  void aVersionGivesWhatItGaveThen() {
    // The first saving of the case, with the parameters that it had; meanwhile it was changed and saved again.
    window().showStep(Step::Retract);
    find<QDoubleSpinBox>("retractorDiameter")->setValue(14.0);
    mri()->setSlice(1);
    QTest::keyClick(mri(), Qt::Key_A);
    session().saveCase(path("case"));
    const Answer a =
        cli({"run", path("case/versions/000001/case.json"), "--output", path("then"), "--json", "--quiet"});
    QVERIFY2(a.code == 0, qPrintable(a.error));
    expectSame(read(folder() / "again" / "run.json"), read(folder() / "then" / "run.json"));
  }

  void aCaseAndItsPatientMayBeMovedTogether() {
    const auto moved = folder() / "moved";
    std::filesystem::create_directories(moved);
    std::filesystem::copy(folder() / "case" / "versions" / "000001", moved / "case",
                          std::filesystem::copy_options::recursive);
    std::filesystem::rename(folder() / "patients", moved / "patients");
    const Answer a = cli({"run", QString::fromStdString((moved / "case" / "case.json").string()), "--output",
                          path("elsewhere"), "--json", "--quiet"});
    std::filesystem::rename(moved / "patients", folder() / "patients");
    QVERIFY2(a.code == 0, qPrintable(a.error));
    expectSame(read(folder() / "again" / "run.json"), read(folder() / "elsewhere" / "run.json"));
  }

  void aDamagedCaseIsRefusedInOneLine() {
    const auto broken = folder() / "broken";
    std::filesystem::copy(folder() / "case", broken, std::filesystem::copy_options::recursive);
    std::ofstream(broken / "contours.json", std::ios::app) << "\n";
    const Answer a = cli({"run", path("broken/case.json"), "--output", path("nothing")});
    QCOMPARE(a.code, 3);
    QCOMPARE(a.error.trimmed().count('\n'), 0);
    QVERIFY2(a.error.contains("contours.json") && a.error.contains("versions/"), qPrintable(a.error));
    QVERIFY(!std::filesystem::exists(folder() / "nothing" / "run.json"));
  }

  void soDoesABarLaidByHand() {
    window().showStep(Step::Retract);
    auto* view = find<SceneView>("retractView");
    click("placeButton");
    QTRY_VERIFY_WITH_TIMEOUT(view->hasModel() && !session().preview().busy(), wait_ms);
    const auto contact = std::ranges::find(view->marks(), PlacementEditor::contact, &glisson::views::Mark::id);
    QVERIFY(contact != view->marks().end());
    const QPoint from = view->pixelOf(contact->at_lps).toPoint();
    glisson::test::drag(view, from, from + QPoint(14, -12));
    QVERIFY(session().parameters().placement.barAt_lps.has_value());
    runHere();
    const Answer a = cli({"run", path("case/case.json"), "--output", path("laid"), "--json", "--quiet"});
    QVERIFY2(a.code == 0, qPrintable(a.error));
    expectSame(read(folder() / "work" / "results" / "run.json"), read(folder() / "laid" / "run.json"));
    QVERIFY(read(folder() / "laid" / "run.json").at("results_sha256") !=
            read(folder() / "again" / "run.json").at("results_sha256"));
  }

  void soDoMethodsThatNeedMoreThanVoxels() {
    window().showStep(Step::Model);
    find<QDoubleSpinBox>("cellSize")->setValue(8.0);
    auto* method = find<QComboBox>("modelKind");
    for (const char* name : {"meshfree-mls", "fem-tet-delaunay-t10"}) {
      const int row = method->findData(QString::fromLatin1(name));
      QVERIFY2(row >= 0, name);
      window().showStep(Step::Model);
      method->setCurrentIndex(row);
      runHere();
      const Answer a = cli({"run", path("case/case.json"), "--output", path(name), "--json", "--quiet"});
      QVERIFY2(a.code == 0, qPrintable(QString::fromLatin1(name) + ": " + a.error));
      expectSame(read(folder() / "work" / "results" / "run.json"), read(folder() / name / "run.json"));
    }
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(CommandLine)
#include "command_line_test.moc"

// SPDX-License-Identifier: GPL-3.0-or-later

// What goes beyond the patient on screen: export, PACS, de-identification, cohort, two runs side by side. In order, on
// one window; each step needs what those before it left.
#include <QCheckBox>
#include <QComboBox>
#include <QElapsedTimer>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QProcess>
#include <QPushButton>
#include <QSpinBox>
#include <QTabWidget>
#include <QTableView>
#include <QTextBrowser>
#include <QTreeWidget>
#include <algorithm>
#include <fstream>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "cohort/records.h"
#include "panels/chart_view.h"
#include "panels/cohort_window.h"
#include "panels/deidentify_dialog.h"
#include "panels/export_dialog.h"
#include "panels/mouse_habit.h"
#include "panels/pacs_dialog.h"
#include "panels/preferences_dialog.h"
#include "panels/run_comparison.h"
#include "pipeline/sources.h"
#include "session/run_figures.h"
#include "window_bench.h"

using glisson::panels::ChartView;
using glisson::panels::CohortWindow;
using glisson::panels::DeidentifyDialog;
using glisson::panels::ExportDialog;
using glisson::panels::PacsDialog;
using glisson::panels::PreferencesDialog;
using glisson::panels::RunComparison;
using glisson::panels::WorkDialog;
using glisson::session::Session;
using glisson::test::wait_ms;

namespace {

/// A port of this computer that nobody listens on just now; 0 where none can be had.
int freePort() {
  const int s = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  const bool known = ::bind(s, reinterpret_cast<sockaddr*>(&at), size) == 0 &&
                     ::getsockname(s, reinterpret_cast<sockaddr*>(&at), &size) == 0;
  ::close(s);
  return known ? ntohs(at.sin_port) : 0;
}

}  // namespace

class Tools : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  std::filesystem::path patient_;
  bool failed_ = false;

  template <typename Dialog>
  Dialog* opened(const char* action) {
    find<QAction>(action)->trigger();
    auto* dialog = window().findChild<Dialog*>();
    if (!dialog || !QTest::qWaitForWindowExposed(dialog)) qFatal("no dialog after %s", action);
    return dialog;
  }
  template <typename W>
  static W* in(QWidget* dialog, const char* name) {
    W* found = dialog->findChild<W*>(QString::fromLatin1(name));
    if (!found) qFatal("no widget is called %s", name);
    return found;
  }
  static void write(QWidget* dialog, const char* name, const QString& text) {
    in<QLineEdit>(dialog, name)->setText(text);
  }
  /// Presses a button and waits for the work it starts; the reason why that failed.
  static QString done(WorkDialog* dialog, const char* button) {
    QSignalSpy ended(dialog, &WorkDialog::ended);
    auto* start = in<QPushButton>(dialog, button);
    if (!start->isEnabled()) return QStringLiteral("the button cannot be pressed");
    QTest::mouseClick(start, Qt::LeftButton);
    if (!ended.count() && !ended.wait(wait_ms)) return QStringLiteral("no end");
    return ended.front().front().toString();
  }
  /// A picture of the dialog for somebody to look at, where GLISSON_PICTURES names a folder.
  static void picture(QWidget* dialog, const char* name) {
    const QString folder = qEnvironmentVariable("GLISSON_PICTURES");
    if (folder.isEmpty()) return;
    for (const auto theme : {glisson::panels::Theme::Light, glisson::panels::Theme::Dark}) {
      glisson::panels::applyTheme(theme);
      QTest::qWait(300);
      const char* suffix = theme == glisson::panels::Theme::Dark ? "dark" : "light";
      dialog->grab().save(QStringLiteral("%1/%2-%3.png").arg(folder, QLatin1String(name), QLatin1String(suffix)));
    }
  }
  static bool holds(const std::filesystem::path& folder, const std::string& text) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().string().find(text) != std::string::npos) return true;
      if (entry.is_regular_file() && glisson::readWhole(entry.path()).find(text) != std::string::npos) return true;
    }
    return false;
  }
  bool ran() {
    QSignalSpy ended(&session(), &Session::workEnded);
    session().run();
    return ended.wait(wait_ms) && session().result() && !session().resultIsStale();
  }
  std::filesystem::path target(const char* name) const { return folder() / name; }

  void sendsAndFetches(PacsDialog* dialog) {
    dialog->tabs()->setCurrentIndex(1);
    for (const char* format : {"send-seg", "send-rtstruct"}) {
      QVERIFY(in<QCheckBox>(dialog, format)->isEnabled());
      in<QCheckBox>(dialog, format)->setChecked(true);
    }
    in<QListWidget>(dialog, "sendFiles")->addItem(QString::fromStdString((patient_ / "mri").string()));
    QCOMPARE(done(dialog, "pacsSend"), QString());
    picture(dialog, "pacs-send");
    dialog->tabs()->setCurrentIndex(0);
    write(dialog, "pacsPatientId", "PHANTOM*");  // alone, * looks for nothing
    QCOMPARE(done(dialog, "pacsFind"), QString());
    auto* found = in<QTreeWidget>(dialog, "pacsFound");
    QCOMPARE(found->topLevelItemCount(), 1);
    QCOMPARE(found->topLevelItem(0)->text(0), QStringLiteral("Patient 1"));
    QCOMPARE(found->topLevelItem(0)->childCount(), 3);  // images, segmentation, structure set
    for (const QLabel* label : dialog->findChildren<QLabel*>()) QVERIFY(!label->text().contains("PHANTOM"));
    write(dialog, "pacsFolder", path("fetched"));
    QCOMPARE(done(dialog, "pacsFetch"), QString());
    found->topLevelItem(0)->setExpanded(true);
    picture(dialog, "pacs-find");
    // In a folder whose name tells nothing of the patient, and it can be opened.
    const auto folders = std::filesystem::directory_iterator(target("fetched"));
    QVERIFY(folders->path().filename().string().starts_with("study-"));
    const std::size_t objects =
        static_cast<std::size_t>(std::ranges::count_if(std::filesystem::recursive_directory_iterator(target("fetched")),
                                                       [](const auto& e) { return e.is_regular_file(); }));
    const std::size_t images =
        static_cast<std::size_t>(std::ranges::count_if(std::filesystem::recursive_directory_iterator(patient_ / "mri"),
                                                       [](const auto& e) { return e.is_regular_file(); }));
    QCOMPARE(objects, images + 2);
    session().saveCase(path("case"));
    QSignalSpy loaded(&session(), &Session::loaded);
    QTest::mouseClick(in<QPushButton>(dialog, "pacsOpen"), Qt::LeftButton);
    QVERIFY(loaded.count() || loaded.wait(wait_ms));
    QVERIFY(session().images().mri);
    QVERIFY(session().path().contains("study-"));
  }

  void clicksLead(CohortWindow* cohort, ChartView* histogram) {
    auto* table = in<QTableView>(cohort, "cohortTable");
    // Somewhere a column stands: a click there chooses its patients, all in one bin.
    QTRY_VERIFY_WITH_TIMEOUT(histogram->isDrawn(), wait_ms);
    int chosen = 0;
    for (int x = 60; x < histogram->width() - 20 && chosen == 0; x += 12) {
      QTest::mouseClick(histogram, Qt::LeftButton, {}, {x, histogram->height() / 2});
      const auto rows = table->selectionModel()->selectedRows(2);
      if (rows.size() < 2) continue;
      chosen = static_cast<int>(rows.size());
      const auto value = [](const QModelIndex& i) { return i.data(Qt::UserRole).toDouble(); };
      const auto [low, high] = std::ranges::minmax(rows, {}, value);
      QVERIFY(std::floor(value(low) / 0.5) == std::floor(value(high) / 0.5));
    }
    QVERIFY(chosen > 1);
    auto* boxes = in<ChartView>(cohort, "cohortBoxes");
    QTRY_VERIFY_WITH_TIMEOUT(boxes->isDrawn(), wait_ms);
    QTest::mouseClick(boxes, Qt::LeftButton, {}, {boxes->width() / 3, 40});
    QCOMPARE(table->selectionModel()->selectedRows().size(), 1);
    const QModelIndex highest = table->selectionModel()->selectedRows(2).front();
    QVERIFY(highest.data(Qt::UserRole).toDouble() > 7.0);
  }

 private slots:
  void init() {
    if (failed_) QSKIP("an earlier step failed");
  }
  void cleanup() { failed_ = failed_ || QTest::currentTestFailed(); }

  void withoutImagesNothingIsExported() {
    QVERIFY(!find<QAction>("exportFormatsAction")->isEnabled());
    QVERIFY(find<QAction>("cohortAction")->isEnabled());
  }

  void everyFormatOfTheCommandLineIsOffered() {
    const auto formats = glisson::pipeline::exportFormats();
    QCOMPARE(glisson::session::formatOffers().size(), formats.size());
    for (const auto& format : formats)
      QVERIFY2(
          std::ranges::any_of(glisson::session::formatOffers(), [&](const auto& o) { return format.name == o.name; }),
          format.name.c_str());
  }

  void outlinesAndStiffnessAreExportedWithoutARun() {
    QVERIFY(openSynthetic());
    patient_ = session().path().toStdString();
    session().importContours(QString::fromStdString((patient_ / "rtstruct.dcm").string()));
    auto* dialog = opened<ExportDialog>("exportFormatsAction");
    for (const char* later : {"format-vtu", "format-sofa", "format-slicer", "format-sc", "format-csv"}) {
      QVERIFY(!in<QCheckBox>(dialog, later)->isEnabled());
      QVERIFY(!in<QCheckBox>(dialog, later)->toolTip().isEmpty());
    }
    QVERIFY(!in<QPushButton>(dialog, "exportStart")->isEnabled());
    for (const char* format : {"format-rtstruct", "format-seg", "format-pmap", "format-sr", "format-nifti"})
      in<QCheckBox>(dialog, format)->setChecked(true);
    write(dialog, "exportFolder", path("exported"));
    QCOMPARE(done(dialog, "exportStart"), QString());
    for (const char* file : {"rtstruct.dcm", "seg.dcm", "pmap.dcm", "sr.dcm", "sr-seg.dcm", "liver.nii.gz"})
      QVERIFY2(std::filesystem::exists(target("exported") / file), file);
    QVERIFY(in<QTextBrowser>(dialog, "exportTold")->toPlainText().contains("seg.dcm"));
    // The mask is that of the outlines.
    const auto mask = glisson::pipeline::loadRoi(target("exported") / "liver.nii.gz", {}, 0);
    QTRY_VERIFY_WITH_TIMEOUT(session().statistics().region != nullptr, wait_ms);
    const auto& shown = session().statistics().region->values;
    QCOMPARE(std::ranges::count(mask.mask->values, 1), std::ranges::count(shown, 1));
    // A folder with files is not written over unasked.
    QVERIFY(done(dialog, "exportStart").contains("not empty"));
    in<QCheckBox>(dialog, "exportReplace")->setChecked(true);
    QCOMPARE(done(dialog, "exportStart"), QString());
    picture(dialog, "export-outlines");
    QTest::keyClick(dialog, Qt::Key_Escape);
    QTRY_VERIFY(!window().findChild<ExportDialog*>());
  }

  void aRunIsExportedWithoutSolvingAgain() {
    QVERIFY(ran());
    auto* dialog = opened<ExportDialog>("exportFormatsAction");
    for (const char* format : {"format-vtu", "format-sofa", "format-slicer", "format-sc", "format-csv", "format-field"})
      in<QCheckBox>(dialog, format)->setChecked(true);
    write(dialog, "exportCase", "case 7");
    write(dialog, "exportFolder", path("run"));
    QElapsedTimer clock;
    clock.start();
    QCOMPARE(done(dialog, "exportStart"), QString());
    qInfo("a run was exported in %.1f s", 1e-3 * static_cast<double>(clock.elapsed()));
    for (const char* file : {"body.vtu", "surface-deformed.vtp", "retraction.scn", "scene.mrml", "mri.nrrd",
                             "liver.seg.nrrd", "displacement-mre.nrrd", "sc-0001.dcm", "measurements.csv"})
      QVERIFY2(std::filesystem::exists(target("run") / file), file);
    QVERIFY(!std::filesystem::exists(target("run") / ".glisson-export-making"));
    // The numbers are those on screen.
    const std::string table = glisson::readWhole(target("run") / "measurements.csv");
    const auto at = table.find("at retractor,");
    QVERIFY(at != std::string::npos);
    QVERIFY(table.find("case 7") != std::string::npos);
    QCOMPARE(std::stod(table.substr(at + 13)), session().result()->difference->at_retractor_mm);
    picture(dialog, "export-run");
    dialog->close();
    QTRY_VERIFY(!window().findChild<ExportDialog*>());
  }

  void aCancelledExportLeavesNothing() {
    auto* dialog = opened<ExportDialog>("exportFormatsAction");
    for (const char* format : {"format-slicer", "format-vtu", "format-mtx"})
      in<QCheckBox>(dialog, format)->setChecked(true);
    write(dialog, "exportFolder", path("cancelled"));
    QSignalSpy ended(dialog, &WorkDialog::ended);
    QTest::mouseClick(in<QPushButton>(dialog, "exportStart"), Qt::LeftButton);
    QTest::keyClick(dialog, Qt::Key_Escape);
    QVERIFY(ended.count() || ended.wait(wait_ms));
    QVERIFY(dialog->isVisible());
    QVERIFY(!ended.front().front().toString().isEmpty());
    QVERIFY(std::filesystem::is_empty(target("cancelled")));
    QTest::keyClick(dialog, Qt::Key_Escape);
    QTRY_VERIFY(!window().findChild<ExportDialog*>());
  }

  void twoRunsStandSideBySide() {
    auto* dialog = opened<RunComparison>("compareRunsAction");
    QCOMPARE(in<QComboBox>(dialog, "firstRun")->count(), 1);
    glisson::session::Parameters p = session().parameters();
    p.poisson = 0.40;
    const double before = session().result()->difference->at_retractor_mm;
    const std::string kept = session().result()->json;
    session().setParameters(p);
    QVERIFY(ran());
    QTRY_COMPARE(in<QComboBox>(dialog, "firstRun")->count(), 2);
    auto* figures = in<QTreeWidget>(dialog, "runFigures");
    const auto rows = figures->findItems("Difference at the retractor", Qt::MatchExactly);
    QCOMPARE(rows.size(), 1);
    QVERIFY(rows[0]->text(1).startsWith(QString::number(before, 'f', 2)));
    QVERIFY(rows[0]->text(2).startsWith(QString::number(session().result()->difference->at_retractor_mm, 'f', 2)));
    const auto settings = in<QTreeWidget>(dialog, "runSettings")->findItems("poisson", Qt::MatchContains);
    QVERIFY(!settings.isEmpty());
    QCOMPARE(settings[0]->text(2), QStringLiteral("0.4"));
    // A run of elsewhere.
    std::filesystem::create_directories(target("elsewhere/results"));
    glisson::writeAtomically(target("elsewhere/results/run.json"), kept);
    QSignalSpy ended(dialog, &WorkDialog::ended);
    dialog->addFrom(path("elsewhere"));
    QVERIFY(ended.count() || ended.wait(wait_ms));
    QCOMPARE(in<QComboBox>(dialog, "secondRun")->currentIndex(), 2);
    picture(dialog, "two-runs");
    dialog->close();
  }

  void aFolderIsDeidentifiedAndWhatWasChangedIsTold() {
    auto* dialog = opened<DeidentifyDialog>("deidentifyAction");
    QVERIFY(!in<QPushButton>(dialog, "deidentifyStart")->isEnabled());
    QVERIFY(holds(patient_, "PHANTOM"));
    write(dialog, "deidentifyIn", QString::fromStdString(patient_.string()));
    write(dialog, "deidentifyOut", path("copies"));
    write(dialog, "deidentifyKey", path("project.key"));
    QCOMPARE(done(dialog, "deidentifyStart"), QString());
    QVERIFY(!holds(target("copies"), "PHANTOM"));
    const QString told = in<QTextBrowser>(dialog, "deidentifyTold")->toPlainText();
    QVERIFY2(told.contains("UIDs mapped by the key") && !told.contains("PHANTOM"), qPrintable(told));
    QVERIFY(in<QPushButton>(dialog, "deidentifyOpen")->isVisible());
    picture(dialog, "deidentify");
    QVERIFY(done(dialog, "deidentifyStart").contains("not empty"));
    dialog->close();
  }

  void aServerIsAskedSentToAndFetchedFrom() {
    const QString orthanc = QStringLiteral("/usr/sbin/Orthanc");
    if (!QFile::exists(orthanc)) QSKIP("Orthanc is not installed (packaging/debian-packages.txt)");
    const int port = freePort();
    QVERIFY(port > 0);
    std::filesystem::create_directories(target("orthanc"));
    glisson::writeAtomically(target("orthanc/orthanc.json"),
                             QStringLiteral(R"({"Name": "TEST", "StorageDirectory": "%1", "IndexDirectory": "%1",
      "Plugins": [], "HttpServerEnabled": false, "DicomServerEnabled": true, "DicomAet": "ORTHANC", "DicomPort": %2,
      "DicomCheckCalledAet": true, "DicomAlwaysAllowFind": true, "DicomAlwaysAllowGet": true,
      "DicomAlwaysAllowStore": true})")
                                 .arg(path("orthanc/db"))
                                 .arg(port)
                                 .toStdString());
    auto* dialog = opened<PacsDialog>("pacsAction");
    write(dialog, "pacsHost", "127.0.0.1");
    in<QSpinBox>(dialog, "pacsPort")->setValue(port);
    QVERIFY(done(dialog, "pacsEcho").contains("refused"));  // nobody is there yet
    QProcess server;
    server.setStandardOutputFile(QProcess::nullDevice());
    server.setStandardErrorFile(QProcess::nullDevice());
    server.start(orthanc, {path("orthanc/orthanc.json")});
    QVERIFY(server.waitForStarted());
    auto* called = in<QLineEdit>(dialog, "pacsCalled");
    called->clear();
    QTest::keyClicks(called, "ORTHANC");
    QTRY_COMPARE_WITH_TIMEOUT(done(dialog, "pacsEcho"), QString(), 30000);
    QVERIFY(in<QLabel>(dialog, "pacsSaid")->text().contains("ms"));
    sendsAndFetches(dialog);
    server.terminate();
    server.waitForFinished();
    // The server is kept, the query is not.
    const auto kept = glisson::session::keptServers();
    QCOMPARE(kept.front().node.calledTitle, std::string("ORTHANC"));
    QCOMPARE(kept.front().node.port, port);
    dialog->close();
  }

  void aCohortIsSortedFilteredAndLeadsToAPatient() {
    using glisson::cohort::CaseOutcome;
    std::filesystem::create_directories(target("patients"));
    for (int n = 1; n <= 40; ++n) {
      glisson::cohort::CaseRecord r = glisson::cohort::recordOf(
          n < 10 ? "case-00" + std::to_string(n) : "case-0" + std::to_string(n), "key", "", "");
      r.outcome.status = n == 40 ? CaseOutcome::Status::Rejected : CaseOutcome::Status::Done;
      if (n == 40) r.outcome.reason = "no bar holds this liver";
      if (n < 40) {
        r.at_retractor_mm = 1.0 + 0.17 * n + (n % 7) * 0.3;
        r.mean_mm = 0.4 * r.at_retractor_mm;
        r.shear_kPa = 1.8 + 0.1 * (n * 13 % 39);
        r.volume_mL = 1200.0 + 11.0 * (n * 7 % 40);
      }
      glisson::cohort::writeWhole(target("cohort") / "cases" / r.outcome.id / "result.json",
                                  glisson::cohort::toJson(r));
    }
    auto* cohort = opened<CohortWindow>("cohortAction");
    QSignalSpy ended(cohort, &WorkDialog::ended);
    cohort->read(path("cohort"));
    QVERIFY(ended.count() || ended.wait(wait_ms));
    auto* table = in<QTableView>(cohort, "cohortTable");
    QCOMPARE(table->model()->rowCount(), 40);
    // By the figure, not by its text; without a figure last both ways.
    for (const auto order : {Qt::AscendingOrder, Qt::DescendingOrder}) {
      table->sortByColumn(2, order);
      const auto at = [&](int row) { return table->model()->index(row, 2).data(Qt::UserRole).toDouble(); };
      QVERIFY(order == Qt::AscendingOrder ? at(0) < at(1) && at(1) < at(38) : at(0) > at(1) && at(1) > at(38));
      QCOMPARE(table->model()->index(39, 0).data().toString(), QStringLiteral("case-040"));
    }
    write(cohort, "cohortLow", "5");
    const int beyond = table->model()->rowCount();
    QVERIFY(beyond > 5 && beyond < 39);
    write(cohort, "cohortLow", "");
    write(cohort, "cohortText", "no bar");
    QCOMPARE(table->model()->rowCount(), 1);
    write(cohort, "cohortText", "");
    auto* histogram = in<ChartView>(cohort, "cohortHistogram");
    QTRY_VERIFY_WITH_TIMEOUT(histogram->isDrawn(), wait_ms);
    picture(cohort, "cohort");
    clicksLead(cohort, histogram);
    cohort->close();
  }

  void aFolderOfSavedCasesOpensOne() {
    std::filesystem::create_directories(target("cases-of-mine"));
    std::filesystem::copy(target("case"), target("cases-of-mine/one"), std::filesystem::copy_options::recursive);
    auto* cohort = opened<CohortWindow>("cohortAction");
    QSignalSpy ended(cohort, &WorkDialog::ended);
    cohort->read(path("cases-of-mine"));
    QVERIFY(ended.count() || ended.wait(wait_ms));
    auto* table = in<QTableView>(cohort, "cohortTable");
    QCOMPARE(table->model()->rowCount(), 1);
    QVERIFY(table->model()->index(0, 2).data(Qt::UserRole).toDouble() > 0.0);
    QSignalSpy loaded(&session(), &Session::loaded);
    table->selectRow(0);
    QTest::mouseClick(in<QPushButton>(cohort, "cohortOpen"), Qt::LeftButton);
    QVERIFY(loaded.count() || loaded.wait(wait_ms));
    QVERIFY(session().caseFolder().endsWith("cases-of-mine/one"));
    QVERIFY(session().result() != nullptr);
  }

  void preferencesAreThoseOfTheMenus() {
    auto* dialog = opened<PreferencesDialog>("preferencesAction");
    auto* drag = in<QComboBox>(dialog, "preferredRightDrag");
    QCOMPARE(drag->currentIndex(), 0);
    QTest::keyClick(drag, Qt::Key_Down);
    QVERIFY(find<QAction>("rightDragWindow")->isChecked());
    QCOMPARE(glisson::panels::preferredRightDrag(), glisson::panels::RightDrag::Window);
    find<QAction>("rightDragZoom")->trigger();
    QCOMPARE(drag->currentIndex(), 0);
    picture(dialog, "preferences");
    auto* theme = in<QComboBox>(dialog, "preferredTheme");
    theme->setCurrentIndex(0);
    QTest::keyClick(theme, Qt::Key_Down);
    QCOMPARE(glisson::panels::currentTheme(), glisson::panels::Theme::Light);
    click("pacsActionButton");
    QVERIFY(window().findChild<PacsDialog*>()->isVisible());
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Tools)
#include "tools_test.moc"

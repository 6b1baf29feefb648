// SPDX-License-Identifier: GPL-3.0-or-later

// What is opened, and that nothing of it is lost or passed over: roles, questions about the elastogram, the journal and
// what it brings back, what is asked before anything goes.
#include <QAbstractButton>
#include <QAction>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QMessageBox>
#include <QProcess>
#include <QProcessEnvironment>
#include <QPushButton>
#include <QStatusBar>
#include <QTimer>

#include "base/error.h"
#include "panels/language.h"
#include "panels/theme_choice.h"
#include "phantom/phantom.h"
#include "pipeline/inputs.h"
#include "pipeline/scene.h"
#include "session/journal.h"
#include "support/same_outlines.h"
#include "window_bench.h"

using glisson::dicom::SeriesRole;
using glisson::session::Journal;
using glisson::session::Parameters;
using glisson::session::Question;
using glisson::session::Session;
using glisson::session::Step;
using glisson::session::StepState;
using glisson::test::wait_ms;

class Loading : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  std::filesystem::path first_, second_;  ///< two patients

  std::filesystem::path copyOf(const char* name, std::initializer_list<std::filesystem::path> folders) {
    std::filesystem::create_directories(folder() / name);
    for (const auto& from : folders)
      std::filesystem::copy(from, folder() / name / from.filename(), std::filesystem::copy_options::recursive);
    return folder() / name;
  }
  int seriesOf(SeriesRole role) {
    const auto& series = session().scan().series;
    for (std::size_t i = 0; i < series.size(); ++i)
      if (series[i].role == role) return static_cast<int>(i);
    return -1;
  }
  std::vector<std::filesystem::path> journals() {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "journals")) found.push_back(entry.path());
    return found;
  }
  /// The journal as a killed program leaves it, and the window that is started next.
  void crash(const char* name) {
    std::filesystem::create_directories(folder() / name);
    QCOMPARE(journals().size(), std::size_t{1});
    std::filesystem::copy_file(journals().front(), folder() / name / "journal-1-0");
    open(path(name));
  }
  QPushButton* recoverButton() {
    QPushButton* found = nullptr;
    return QTest::qWaitFor([&] { return (found = window().findChild<QPushButton*>("recoverButton")) != nullptr; })
               ? found
               : nullptr;
  }
  /// Answers the next question of this name while act waits for it. Whether it was asked.
  bool answering(const char* name, const char* button, const std::function<void()>& act, QString* text = nullptr) {
    bool asked = false;
    QTimer watch;
    connect(&watch, &QTimer::timeout, this, [&] {
      auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (!box || asked) return;
      asked = box->objectName() == QLatin1String(name);
      if (text) *text = box->text();
      for (QAbstractButton* b : box->buttons())
        if (asked && (b->objectName() == QLatin1String(button) || b->text().remove('&') == QLatin1String(button))) {
          QTest::mouseClick(b, Qt::LeftButton);
          return;
        }
      QTest::keyClick(box, Qt::Key_Escape);
    });
    watch.start(20);
    act();
    return asked;
  }
  void acceptASquare() {
    mri()->setSlice(mri()->plane().grid.size.z() / 2);
    square(mri()->width() / 2 - 50, mri()->height() / 2 - 50, 100);
    QTest::keyClick(mri(), Qt::Key_Return);
  }

 private slots:
  void initTestCase() {
    qputenv("XDG_CACHE_HOME", path("cache").toUtf8());
    glisson::phantom::PhantomOptions options;
    for (int number : {1, 2}) {
      options.number = number;
      const auto patient = folder() / ("patient-" + std::to_string(number));
      glisson::phantom::writePhantom(glisson::phantom::makePhantom(static_cast<std::uint64_t>(number), options),
                                     patient);
      (number == 1 ? first_ : second_) = patient;
    }
  }
  /// Every test starts with a window that has nothing open.
  void init() {
    std::filesystem::remove_all(folder() / "journals");
    std::filesystem::create_directories(folder() / "journals");
    open(path("journals"));
  }

  void whyNothingWasOpenedIsOnThePageOnce() {
    QSettings().remove("recent");
    const auto nothing = folder() / "empty";
    std::filesystem::create_directories(nothing);
    QVERIFY(!find<QWidget>("loadNotice")->isVisible());
    QSignalSpy tried(&session(), &Session::workEnded);
    session().openPath(QString::fromStdString(nothing.string()));
    QVERIFY(tried.wait(wait_ms));
    const QString reason = session().status(Step::Load).detail;
    QCOMPARE(session().status(Step::Load).state, StepState::Failed);
    QVERIFY(find<QWidget>("loadNotice")->isVisible());
    QVERIFY(find<QLabel>("loadNoticeText")->text().contains(reason));
    QVERIFY2(reason.contains("no DICOM series"), qPrintable(reason));
    QVERIFY(window().statusBar()->currentMessage().isEmpty());
    QVERIFY(QSettings().value("recent").toStringList().isEmpty());
    // One that is not there at all; what is open stays.
    QSignalSpy ended(&session(), &Session::workEnded);
    session().openPath(path("not-there"));
    QVERIFY(ended.wait(wait_ms));
    QVERIFY(find<QLabel>("loadNoticeText")->text().contains(session().status(Step::Load).detail));
  }

  void outlinesOnASeriesChosenByHandAreInTheirOwnJournal() {
    QVERIFY(opened(first_));
    QCOMPARE(journals().size(), std::size_t{1});
    const auto waves = copyOf("waves", {second_ / "mre" / "wave"});
    QVERIFY(opened(waves));
    QVERIFY(!session().images().mri);
    QVERIFY2(journals().empty(), "the journal of the patient before would take what is drawn now");
    QVERIFY(afterLoading([&] { session().setRole(0, SeriesRole::Anatomical); }));
    QVERIFY2(session().images().mri, qPrintable(session().status(Step::Load).detail));
    const auto& series = session().scan().series[static_cast<std::size_t>(session().images().mriSeries)];
    QCOMPARE(session().contours().seriesUid, series.uid);
    QCOMPARE(session().contours().frameOfReferenceUid, series.frameOfReferenceUid);
    acceptASquare();
    QCOMPARE(session().acceptedCount(), std::size_t{1});
    const auto drawn = polygons();
    crash("crashed-by-hand");
    QPushButton* recover = recoverButton();
    QVERIFY(recover);
    QVERIFY(afterLoading([&] { QTest::mouseClick(recover, Qt::LeftButton); }));
    QVERIFY2(session().images().mri, "the role that was given by hand came back too");
    QCOMPARE(session().path().toStdString(), waves.string());
    QCOMPARE(session().acceptedCount(), std::size_t{1});
    QVERIFY(polygons().front().points_lps_mm == drawn.front().points_lps_mm);
    QVERIFY2(!std::filesystem::exists(folder() / "crashed-by-hand" / "journal-1-0"), "it is in the new journal now");
  }

  void anElastogramOfAnotherPatientIsAskedAbout() {
    QVERIFY(opened(copyOf("mixed", {first_ / "mri", second_ / "mre"})));
    QVERIFY(session().images().mri && !session().images().stiffness);
    auto* box = window().findChild<QMessageBox*>("togetherBox");
    QVERIFY(box);
    QVERIFY2(box->text().contains("different patients"), qPrintable(box->text()));
    QVERIFY(!box->informativeText().contains("--override") && !box->text().contains("--override"));
    QTest::mouseClick(box->button(QMessageBox::No), Qt::LeftButton);
    QVERIFY(!session().images().stiffness);
    QCOMPARE(session().images().choices.together, std::optional<bool>(false));
    window().showStep(Step::Load);
    QVERIFY(find<QWidget>("loadNotice")->isVisible());

    // Left out, the command line gets none either.
    window().showStep(Step::Segment);
    acceptASquare();
    session().saveCase(path("mixed-case"));
    QVERIFY(glisson::pipeline::readScene(folder() / "mixed-case" / "case.json").geometry.mre.empty());

    // The answer can be changed; then a run takes both, and says so.
    window().showStep(Step::Load);
    QTRY_VERIFY(!window().findChild<QMessageBox*>("togetherBox"));
    click("answerButton");
    box = window().findChild<QMessageBox*>("togetherBox");
    QVERIFY(box);
    QVERIFY(afterLoading([&] { QTest::mouseClick(box->button(QMessageBox::Yes), Qt::LeftButton); }));
    QVERIFY(session().images().stiffness);
    QVERIFY(!find<QWidget>("loadNotice")->isVisible());
    session().saveCase(path("mixed-case"));
    auto scene = glisson::pipeline::readScene(folder() / "mixed-case" / "case.json");
    QVERIFY(scene.geometry.overrideChecks);
    const auto inputs = glisson::pipeline::loadInputs(scene, {});
    QVERIFY(std::ranges::any_of(inputs.warnings, [](const std::string& w) {
      return w.find("different patients: overridden by the user") != std::string::npos;
    }));
    // As the command line would refuse it without the answer.
    scene.geometry.overrideChecks = false;
    QVERIFY_EXCEPTION_THROWN(glisson::pipeline::loadInputs(scene, {}), glisson::BadInput);

    // The case remembers; nobody is asked twice.
    open(path("journals"));
    QVERIFY(opened(folder() / "mixed-case"));
    QVERIFY(session().images().stiffness && !window().findChild<QMessageBox*>("togetherBox"));
  }

  void aMapWithoutUnitIsAskedAboutAndTakenAlikeByTheCommandLine() {
    QVERIFY(opened(copyOf("bare", {first_ / "mri", first_ / "mre"})));
    QVERIFY(session().images().stiffness);
    const int magnitude = seriesOf(SeriesRole::Magnitude);
    QVERIFY(magnitude >= 0);
    QVERIFY(afterLoading([&] { session().setRole(magnitude, SeriesRole::Stiffness); }));
    QVERIFY2(!session().images().stiffness, "a number without its unit was shown as kPa");
    auto* dialog = window().findChild<QDialog*>("meaningDialog");
    QVERIFY(dialog);
    auto* ok = dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
    QVERIFY(!ok->isEnabled());
    dialog->findChild<QComboBox*>("meaningQuantity")->setCurrentIndex(0);
    QVERIFY(!ok->isEnabled());
    dialog->findChild<QComboBox*>("meaningUnit")->setEditText("bar");
    QVERIFY(!ok->isEnabled());
    dialog->findChild<QComboBox*>("meaningUnit")->setEditText("0.01kPa");
    QVERIFY(ok->isEnabled());
    QVERIFY(afterLoading([&] { QTest::mouseClick(ok, Qt::LeftButton); }));
    QVERIFY(session().images().stiffness);
    const auto shown = session().images().stiffness;

    acceptASquare();
    session().saveCase(path("bare-case"));
    const auto scene = glisson::pipeline::readScene(folder() / "bare-case" / "case.json");
    QCOMPARE(scene.geometry.mreUnit, std::optional<std::string>("0.01kPa"));
    const auto loaded = glisson::pipeline::loadInputs(scene, {});
    QVERIFY(loaded.stiffness && loaded.stiffness->quantity == shown->quantity);
    const auto &a = shown->values_kPa, &b = loaded.stiffness->values_kPa;
    QVERIFY(a.grid.size == b.grid.size);
    for (int k = 0; k < a.grid.size.z(); ++k)
      for (int j = 0; j < a.grid.size.y(); ++j)
        for (int i = 0; i < a.grid.size.x(); ++i) QVERIFY(a.at(i, j, k) == b.at(i, j, k));

    open(path("journals"));
    QVERIFY(opened(folder() / "bare-case"));
    QVERIFY(session().images().stiffness && !window().findChild<QDialog*>("meaningDialog"));
  }

  void aColouredElastogramIsRefusedWithTheReason() {
    auto scan = glisson::dicom::scan(first_);
    const auto guessed = scan;
    int colour = -1;
    for (const auto& s : scan.series)
      if (s.colour) colour = s.number;
    QVERIFY(colour >= 0);
    // Another program may write palettes, which can be read as a volume.
    for (auto& s : scan.series)
      if (s.role == SeriesRole::Stiffness) s.colour = true;
    const auto images = glisson::session::readImages(scan, guessed, first_, {}, {});
    QVERIFY(images.mri && !images.stiffness);
    QVERIFY(images.question && images.question->kind == Question::Kind::None);
    QVERIFY(images.question->text.contains("colour"));
  }

  void parametersBarHoistAndHoldsComeBackAfterACrash() {
    QVERIFY(opened(first_));
    Parameters p = session().parameters();
    p.poisson = 0.41;
    p.retractorDiameter_mm = 13.5;
    session().setParameters(p);
    auto placement = p.placement;
    placement.barAt_lps = Eigen::Vector3d(1.0 / 3.0, -20.0, 7.0);
    placement.hoistDirection = Eigen::Vector3d(0.0, -0.8, 0.6);
    placement.holds.push_back({Eigen::Vector3d(10.0, 11.0, 12.5), 22.0});
    session().place(placement, 90.0, "bar");
    session().setMeasureSettings({true, 2});
    const Parameters laid = session().parameters();
    QTRY_VERIFY(Journal::read(journals().front())->settings.value_or(glisson::session::Settings{}).parameters == laid);
    crash("crashed-laid");
    QVERIFY(!(session().parameters() == laid));
    QPushButton* recover = recoverButton();
    QVERIFY(recover);
    QVERIFY(afterLoading([&] { QTest::mouseClick(recover, Qt::LeftButton); }));
    QVERIFY(session().parameters() == laid);
    QCOMPARE(session().measureSettings().erosion_pixels, 2);
    QVERIFY(session().unsaved().settings);
  }

  void recoveringAndDeletingAskFirst() {
    QVERIFY(opened(first_));
    acceptASquare();
    crash("crashed-asks");
    QPushButton* recover = recoverButton();
    QVERIFY(recover);
    const auto journal = folder() / "crashed-asks" / "journal-1-0";
    // Meanwhile something else was opened and drawn on.
    QVERIFY(opened(second_));
    acceptASquare();
    acceptASquare();
    const auto drawn = session().contours();
    QVERIFY(answering("unsavedBox", "Cancel", [&] { QTest::mouseClick(recover, Qt::LeftButton); }));
    QVERIFY(!session().busy() && glisson::test::same(session().contours(), drawn));
    QVERIFY(answering("discardBox", "Cancel", [&] { click("recoverDiscardButton"); }));
    QVERIFY(std::filesystem::exists(journal));
    QVERIFY(answering("discardBox", "yesButton", [&] { click("recoverDiscardButton"); }));
    QVERIFY(!std::filesystem::exists(journal));
  }

  void importingAsksBeforeItReplaces() {
    QVERIFY(opened(first_));
    const QString file = QString::fromStdString((first_ / "rtstruct.dcm").string());
    QVERIFY2(!answering("replaceBox", "yesButton", [&] { window().importFrom(file); }), "there was nothing to replace");
    QVERIFY(session().acceptedCount() > 3);
    while (session().canUndo()) session().undo();
    acceptASquare();
    const auto drawn = session().contours();
    QVERIFY(answering("replaceBox", "Cancel", [&] { window().importFrom(file); }));
    QVERIFY(glisson::test::same(session().contours(), drawn));
    // Another patient's are refused before anything is asked.
    const QString others = QString::fromStdString((second_ / "rtstruct.dcm").string());
    QString refusal;
    QVERIFY(!answering(
        "replaceBox", "yesButton", [&] { window().importFrom(others); }, &refusal));
    QVERIFY2(refusal.contains("another patient") && !refusal.contains("--"), qPrintable(refusal));
    QVERIFY(answering("replaceBox", "yesButton", [&] { window().importFrom(file); }));
    QVERIFY(session().acceptedCount() > 3);
    session().undo();
    QVERIFY(glisson::test::same(session().contours(), drawn));
  }

  void whatIsNotSavedIsNamedAndCanBeSavedThere() {
    QVERIFY(opened(first_));
    acceptASquare();
    session().saveCase(path("kept"));
    Parameters p = session().parameters();
    p.poisson = 0.4;
    session().setParameters(p);
    QString text;
    QVERIFY(answering(
        "unsavedBox", "Cancel", [&] { window().close(); }, &text));
    QVERIFY2(text.contains("Parameters") && !text.contains("Outlines"), qPrintable(text));
    QVERIFY(window().isVisible());
    session().undo();
    QVERIFY(answering(
        "unsavedBox", "Cancel", [&] { window().close(); }, &text));
    QVERIFY2(text.contains("parameters") && text.contains("Outlines"), qPrintable(text));
    QVERIFY(answering("unsavedBox", "Save", [&] { window().close(); }));
    QVERIFY(!window().isVisible());
    open(path("journals"));
    QVERIFY(opened(folder() / "kept"));
    QCOMPARE(session().parameters().poisson, 0.4);
  }

  void aPatientStartsFromTheDefaultsAndACaseFromItsOwn() {
    QVERIFY(opened(first_));
    Parameters p = session().parameters();
    p.retractorDiameter_mm = 17.0;
    session().setParameters(p);
    session().saveCase(path("own"));
    QVERIFY(opened(second_));
    QVERIFY(session().parameters() == Parameters{});
    window().showStep(Step::Retract);
    QCOMPARE(find<QDoubleSpinBox>("retractorDiameter")->value(), Parameters{}.retractorDiameter_mm);
    QVERIFY(opened(folder() / "own"));
    QCOMPARE(session().parameters().retractorDiameter_mm, 17.0);
  }

  void aSecondReadersOutlinesCanBePutAway() {
    QVERIFY(opened(first_));
    auto* away = find<QAction>("putAwayReaderAction");
    QVERIFY(!away->isEnabled());
    session().loadSecondReader(QString::fromStdString((first_ / "rtstruct.dcm").string()));
    QVERIFY(!session().secondReader().polygons.empty() && away->isEnabled());
    away->trigger();
    QVERIFY(session().secondReader().polygons.empty() && !away->isEnabled());
  }

  void twoWindowsRunInTwoFolders() {
    const auto cache = std::filesystem::path(Session::cacheFolder().toStdString());
    QVERIFY2(cache.string().starts_with(folder().string()), "the cache of who runs the tests is not touched");
    {
      const Session one, other;
      QVERIFY(one.runFolder() != other.runFolder());
      QVERIFY(one.runFolder().startsWith(Session::cacheFolder()));
      QVERIFY(!std::filesystem::is_empty(cache));
    }
    QVERIFY(std::filesystem::is_empty(cache));
  }

  void theProgramKeepsItsSettingsUnderItsOwnName() {
    QProcess program;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    for (const char* place : {"CONFIG", "DATA", "CACHE"})
      environment.insert(QStringLiteral("XDG_%1_HOME").arg(QLatin1String(place)), path("home/") + QLatin1String(place));
    program.setProcessEnvironment(environment);
    program.start(QStringLiteral(GLISSON_PROGRAM),
                  {"--screenshot", path("picture.png"), "--step", "load", QString::fromStdString(first_.string())});
    QVERIFY(program.waitForFinished(wait_ms));
    QVERIFY2(program.exitCode() == 0, program.readAllStandardError().constData());
    const auto config = folder() / "home" / "CONFIG";
    QVERIFY(std::filesystem::exists(config / "glisson" / "glisson.conf"));  // it opened something, which is recent now
    QVERIFY(!std::filesystem::exists(config / "Unknown Organization"));
    // An orderly end leaves neither a journal nor anything that was worked on.
    for (const char* place : {"DATA/glisson/journals", "CACHE/glisson"}) {
      const auto left = folder() / "home" / place;
      QVERIFY2(!std::filesystem::exists(left) || std::filesystem::is_empty(left), place);
    }
  }

  void themeLanguageAndPlaceOnTheScreenAreRemembered() {
    using glisson::panels::Theme;
    QSettings().clear();
    QPalette dark = QApplication::palette();
    dark.setColor(QPalette::Window, Qt::black);
    dark.setColor(QPalette::WindowText, Qt::white);
    QPalette light = dark;
    light.setColor(QPalette::Window, Qt::white);
    light.setColor(QPalette::WindowText, Qt::black);
    const QPalette own = QApplication::palette();
    QApplication::setPalette(dark);
    QCOMPARE(glisson::panels::preferredTheme(), Theme::Dark);
    QApplication::setPalette(light);
    QCOMPARE(glisson::panels::preferredTheme(), Theme::Light);
    QApplication::setPalette(own);
    find<QAction>("lightTheme")->trigger();
    QCOMPARE(glisson::panels::preferredTheme(), Theme::Light);
    find<QAction>("darkTheme")->trigger();
    QCOMPARE(glisson::panels::preferredTheme(), Theme::Dark);

    QCOMPARE(glisson::panels::preferredLanguage(QLocale(QStringLiteral("de_AT"))).language(), QLocale::German);
    find<QAction>("language-en")->trigger();
    QCOMPARE(glisson::panels::preferredLanguage(QLocale(QStringLiteral("de_AT"))).language(), QLocale::English);
    find<QAction>("language-de")->trigger();
    QCOMPARE(glisson::panels::preferredLanguage(QLocale::c()).language(), QLocale::German);

    window().rememberPlace();  // there is none yet
    window().setGeometry(40, 50, 1530, 930);
    QTRY_COMPARE(window().size(), QSize(1530, 930));
    window().close();
    open(path("journals"));
    QVERIFY(window().size() != QSize(1530, 930));
    window().rememberPlace();
    QTRY_COMPARE(window().size(), QSize(1530, 930));
  }

  void cleanupTestCase() { close(); }
};

QTEST_MAIN(Loading)
#include "loading_test.moc"

// SPDX-License-Identifier: GPL-3.0-or-later

// The program is killed (SIGKILL) at random moments while a reader draws, and while the case is saved: at most the
// gesture in progress is lost, and the case on disk reads as before or as after.
#include <signal.h>

#include <QProcess>
#include <QPushButton>
#include <QThread>
#include <algorithm>

#include "base/atomic_file.h"
#include "base/random.h"
#include "digest.h"
#include "pipeline/case_folder.h"
#include "session/journal.h"
#include "window_bench.h"

class Killed : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  static constexpr int gestures = 4000;  ///< more than any round gets to
  static constexpr int rounds = 24;
  glisson::Random random_{2026};
  std::filesystem::path original_;

  /// A fresh root with the case as it was at first.
  std::filesystem::path freshRoot(int round) {
    const std::filesystem::path root = folder() / ("round-" + std::to_string(round));
    std::filesystem::create_directories(root);
    std::filesystem::copy(original_, root / "case", std::filesystem::copy_options::recursive);
    return root;
  }
  /// What the hand told: digests of the states after 0, 1, 2 ... gestures.
  static std::vector<std::string> told(const QByteArray& output) {
    std::vector<std::string> states;
    for (const QByteArray& line : output.split('\n')) {
      const QList<QByteArray> words = line.split(' ');
      // The last line may be torn.
      if (words.size() != 2 || words[1].size() != 64 || words[0].toInt() != static_cast<int>(states.size())) break;
      states.push_back(words[1].toStdString());
    }
    return states;
  }

 private slots:
  void initTestCase() {
    QVERIFY(openSynthetic());
    showLiver();
    square(160, 160, 120);
    QTest::keyClick(mri(), Qt::Key_Return);
    QTest::keyClick(mri(), Qt::Key_C, Qt::ControlModifier);
    session().saveCase(path("case"));
    original_ = folder() / "case";
    close();
    std::filesystem::remove(original_ / "case.lock");
  }

  void atRandomMoments() {
    // What the same hand does when nobody kills it; only as much as the longest round can get to.
    int lost = 0, killedWhileSaving = 0, recovered = 0;
    std::size_t most = 0;
    std::vector<std::vector<std::string>> all;
    for (int round = 0; round < rounds; ++round) {
      const bool saves = round % 2 == 1;
      const std::filesystem::path root = freshRoot(round);
      QProcess hand;
      hand.setProcessChannelMode(QProcess::ForwardedErrorChannel);
      QStringList arguments = {QString::fromStdString(root.string()), QString::number(gestures)};
      if (saves) arguments << QStringLiteral("--save");
      hand.start(QStringLiteral(GLISSON_HAND), arguments);
      QVERIFY(hand.waitForStarted());
      QByteArray output;
      // It draws from the first line on.
      while (!output.contains('\n')) {
        QVERIFY2(hand.waitForReadyRead(glisson::test::wait_ms), "the hand does not begin");
        output += hand.readAllStandardOutput();
      }
      QThread::usleep(static_cast<unsigned long>(random_.below(700000)));
      QVERIFY2(::kill(static_cast<pid_t>(hand.processId()), SIGKILL) == 0, "the hand was gone before it was killed");
      hand.waitForFinished();
      QCOMPARE(hand.exitStatus(), QProcess::CrashExit);
      output += hand.readAllStandardOutput();
      const std::vector<std::string> states = told(output);
      QVERIFY(!states.empty());
      most = std::max(most, states.size());
      all.push_back(states);

      // The case itself: as before or as after the saving, never neither.
      const auto onDisk = glisson::pipeline::readCase(root / "case");
      QVERIFY(onDisk.version >= 1);
      if (std::filesystem::exists(root / "case" / "versions" / ".making") ||
          glisson::readWhole(root / "case" / "contours.json") != onDisk.contours)
        ++killedWhileSaving;

      // What a reader sees who starts the program again.
      WindowBench after(root);
      QPushButton* button = nullptr;
      const bool offered = QTest::qWaitFor(
          [&] { return (button = after.window().findChild<QPushButton*>("recoverButton")) != nullptr; }, 300);
      if (offered) {
        QSignalSpy loaded(&after.session(), &glisson::session::Session::loaded);
        QTest::mouseClick(button, Qt::LeftButton);
        QVERIFY(loaded.wait(glisson::test::wait_ms));
        ++recovered;
      } else {
        QVERIFY(after.openPath(after.path("case")));
      }
      const std::string found = glisson::test::digestOf(after.session(), {});
      if (found != states.back()) {
        // The gesture in progress had reached the disk, or had taken a part of its way there: the hand tells by drawing
        // the same again.
        QProcess again;
        const std::filesystem::path other = freshRoot(round + rounds);
        again.start(QStringLiteral(GLISSON_HAND),
                    {QString::fromStdString(other.string()), QString::number(states.size())});
        QVERIFY(again.waitForFinished(glisson::test::wait_ms));
        const std::vector<std::string> whole = told(again.readAllStandardOutput());
        QCOMPARE(whole.size(), states.size() + 1);
        QVERIFY(std::equal(states.begin(), states.end(), whole.begin()));
        QVERIFY2(found == whole.back(),
                 qPrintable(QStringLiteral("round %1: after %2 gestures, neither these nor one more came back")
                                .arg(round)
                                .arg(states.size() - 1)));
        ++lost;
      }
    }
    // The same hand: every round is the beginning of the longest.
    const auto& longest =
        *std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
    for (const auto& states : all) QVERIFY(std::equal(states.begin(), states.end(), longest.begin()));
    QVERIFY2(most > 10, "the rounds are too short to mean anything");
    qInfo(
        "%d kills after up to %zu gestures: %d recovered from the journal, %d in the middle of a saving, %d with the "
        "gesture in progress already on disk, none with less than what was done",
        rounds, most - 1, recovered, killedWhileSaving, lost);
  }
};

QTEST_MAIN(Killed)
#include "killed_test.moc"

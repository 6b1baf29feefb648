// SPDX-License-Identifier: GPL-3.0-or-later

// A long day of a reader who presses everything: random events on the images, the panels, all pages and menus. Nothing
// may crash, hang, grow or lose the way back. GLISSON_RANDOM_EVENTS=100000 makes it the long run, GLISSON_RANDOM_SEED
// another day.
#include <QAbstractButton>
#include <QAbstractScrollArea>
#include <QDialog>
#include <QElapsedTimer>
#include <QMenu>
#include <QMenuBar>
#include <QTimer>
#include <fstream>

#include <unistd.h>

#include "base/random.h"
#include "session/stall_monitor.h"
#include "window_bench.h"

using glisson::session::Step;
using glisson::test::drag;
using glisson::test::mouse;
using glisson::test::wheel;

namespace {

constexpr int eventsByDefault = 4000;
constexpr int eventsAtOnce = 5;  ///< come between two looks at the queue: a hand is quicker than a picture
constexpr std::size_t outlinesOfADay = 60;

double resident_MB() {
  std::ifstream in("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  in >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

/// Answers every dialog with Escape and closes every menu, also those that wait in a loop of their own.
class Escape : public QObject {
 public:
  Escape() {
    connect(&timer_, &QTimer::timeout, this, [this] {
      if (QWidget* popup = QApplication::activePopupWidget()) popup->close(), ++closed_;
      if (QWidget* modal = QApplication::activeModalWidget()) {
        auto* dialog = qobject_cast<QDialog*>(modal);
        dialog ? dialog->reject() : static_cast<void>(modal->close());
        ++closed_;
      }
    });
    timer_.start(5);
  }
  int closed() const { return closed_; }

 private:
  QTimer timer_;
  int closed_ = 0;
};

}  // namespace

class RandomEvents : public QObject, private glisson::test::WindowBench {
  Q_OBJECT

 private:
  glisson::Random random_{static_cast<std::uint64_t>(std::max(qEnvironmentVariableIntValue("GLISSON_RANDOM_SEED"), 7))};

  int below(int n) { return static_cast<int>(random_.below(static_cast<std::uint64_t>(std::max(n, 1)))); }
  bool chance(double p) { return random_.uniform() < p; }
  QPoint within(const QWidget* w) { return {below(w->width()), below(w->height())}; }
  Qt::Key anyKey() {
    static constexpr Qt::Key keys[] = {Qt::Key_P,      Qt::Key_F,      Qt::Key_R,           Qt::Key_M,
                                       Qt::Key_W,      Qt::Key_Return, Qt::Key_Backspace,   Qt::Key_Plus,
                                       Qt::Key_Minus,  Qt::Key_Escape, Qt::Key_Left,        Qt::Key_Up,
                                       Qt::Key_N,      Qt::Key_A,      Qt::Key_S,           Qt::Key_I,
                                       Qt::Key_X,      Qt::Key_E,      Qt::Key_K,           Qt::Key_L,
                                       Qt::Key_Home,   Qt::Key_End,    Qt::Key_PageUp,      Qt::Key_2,
                                       Qt::Key_Delete, Qt::Key_H,      Qt::Key_BracketLeft, Qt::Key_BracketRight,
                                       Qt::Key_G,      Qt::Key_Tab,    Qt::Key_Space,       Qt::Key_Down,
                                       Qt::Key_0,      Qt::Key_5,      Qt::Key_F1};
    return keys[below(static_cast<int>(std::size(keys)))];
  }

  void onImage() {
    glisson::views::SliceView* view = chance(0.9) ? mri() : mre();
    static constexpr Qt::Key withCtrl[] = {Qt::Key_A, Qt::Key_D, Qt::Key_C, Qt::Key_V, Qt::Key_Z, Qt::Key_Return};
    const QPoint at = within(view), to = within(view);
    Qt::KeyboardModifiers modifiers;
    if (chance(0.15)) modifiers |= Qt::ShiftModifier;
    if (chance(0.1)) modifiers |= Qt::ControlModifier;
    switch (below(9)) {
      case 0:
      case 1:
      case 2: return QTest::mouseClick(view, chance(0.95) ? Qt::LeftButton : Qt::RightButton, modifiers, at);
      case 3: return drag(view, at, to, Qt::LeftButton, modifiers);
      case 4: return drag(view, at, to, chance(0.5) ? Qt::RightButton : Qt::MiddleButton);
      case 5: return wheel(view, at, chance(0.5) ? 120 : -120, modifiers);
      case 6: return QTest::keyClick(view, anyKey());
      case 7: return QTest::keyClick(view, withCtrl[below(static_cast<int>(std::size(withCtrl)))], Qt::ControlModifier);
      default:
        mouse(view, QEvent::MouseButtonDblClick, at, Qt::LeftButton, Qt::LeftButton);
        mouse(view, QEvent::MouseButtonRelease, at, Qt::LeftButton, Qt::NoButton);
    }
  }

  /// Something that is seen and can be used, anywhere in the window.
  void onAnything() {
    QList<QWidget*> all = window().findChildren<QWidget*>();
    all.removeIf([](const QWidget* w) {
      return !w->isVisible() || !w->isEnabled() || w->isWindow() || w->width() < 4 || w->height() < 4;
    });
    if (all.isEmpty()) return;
    QWidget* w = all[below(static_cast<int>(all.size()))];
    const QPoint at = within(w), to = within(w);
    switch (below(6)) {
      case 0:
      case 1:
      case 2: return QTest::mouseClick(w, chance(0.9) ? Qt::LeftButton : Qt::RightButton, {}, at);
      case 3: return drag(w, at, to);
      case 4: return wheel(w, at, chance(0.5) ? 120 : -120);
      default: return QTest::keyClick(w, anyKey());
    }
  }

  void oneEvent() {
    if (!window().isVisible()) window().show();
    if (!mri()->isVisible() && chance(0.05)) window().showStep(Step::Segment);
    mri()->isVisible() && session().images().mri&& chance(0.9) ? onImage() : onAnything();
  }

  /// The outlines of a day are taken back, and what undo has forgotten is deleted by hand.
  void endOfDay() {
    while (session().canUndo()) {
      session().undo();
      QCoreApplication::processEvents();
    }
    session().tool().deselect();
    while (!polygons().empty()) {
      session().tool().selectPolygon(polygons().size() - 1);
      const std::size_t before = polygons().size();
      window().showStep(Step::Segment);
      QTest::keyClick(mri(), Qt::Key_P);
      session().apply(session().tool().key(glisson::tools::ToolKey::Delete, mri()->plane()));
      QVERIFY(polygons().size() < before);
      QCoreApplication::processEvents();
    }
  }

 private slots:
  void initTestCase() {
    qputenv("XDG_CACHE_HOME", path("cache").toUtf8());
    QVERIFY(openSynthetic());
  }

  void breakNothingAndUndoGoesAllTheWay() {
    const int wanted = qEnvironmentVariableIntValue("GLISSON_RANDOM_EVENTS");
    const int events = wanted > 0 ? wanted : eventsByDefault;
    Escape escape;
    glisson::session::StallMonitor stalls;
    QElapsedTimer clock;
    clock.start();
    double early_MB = 0.0, most_MB = 0.0;
    int days = 0, background = 0;
    for (int n = 0; n < events; ++n) {
      oneEvent();
      if (n % eventsAtOnce == 0) QCoreApplication::processEvents();
      if (session().busy()) {
        // Work in the background may go on for a while, then the reader cancels or waits.
        if (++background > 40) session().cancel();
      } else {
        background = 0;
      }
      if (session().images().mri && (mri()->zoom_px_mm() > 20.0 || mri()->zoom_px_mm() < 0.5)) mri()->fit();
      for (const auto& p : polygons()) QVERIFY2(p.points_lps_mm.allFinite(), qPrintable(QString::number(n)));
      if (session().tool().selected()) QVERIFY(*session().tool().selected() < polygons().size());
      if (polygons().size() > outlinesOfADay) endOfDay(), ++days;
      if (n == events / 4) early_MB = resident_MB();
      most_MB = std::max(most_MB, n % 100 == 0 ? resident_MB() : 0.0);
      if (n > 0 && n % 10000 == 0)
        qInfo("%d events in %lld s, %.0f MB, %zu outlines", n, static_cast<long long>(clock.elapsed() / 1000),
              resident_MB(), polygons().size());
    }
    const double seconds = 1e-3 * static_cast<double>(clock.elapsed());
    const auto answer = stalls.report();
    qInfo(
        "%d events, %.0f a second; %.0f MB after a quarter, %.0f MB at the end, %.0f MB at most; %d days of work, %d "
        "dialogs and menus; no answer: p99 %.1f ms, longest %.1f ms",
        events, events / seconds, early_MB, resident_MB(), most_MB, days, escape.closed(), answer.p99_ms,
        answer.max_ms);
    glisson::test::judge(answer);
    session().cancel();
    QTRY_VERIFY_WITH_TIMEOUT(!session().busy(), glisson::test::wait_ms);
    clean();
    QVERIFY(!session().canUndo());
  }

  void cleanupTestCase() { close(); }
};

int main(int argc, char** argv) {
  qputenv("QTEST_FUNCTION_TIMEOUT", "7200000");  // the long run
  QApplication app(argc, argv);
  RandomEvents tests;
  return QTest::qExec(&tests, argc, argv);
}
#include "random_events_test.moc"

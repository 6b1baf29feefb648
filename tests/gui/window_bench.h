// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QApplication>
#include <QImage>
#include <QMouseEvent>
#include <QSettings>
#include <QSignalSpy>
#include <QTest>
#include <QWheelEvent>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>

#include "panels/main_window.h"
#include "panels/segment_page.h"
#include "panels/theme.h"
#include "session/stall_monitor.h"
#include "support/support.h"
#include "views/slice_view.h"

namespace glisson::test {

/// What a slow machine may take for work in the background.
inline constexpr int wait_ms = 300000;

inline void wheel(QWidget* on, const QPoint& at, int delta, Qt::KeyboardModifiers modifiers = {}) {
  QWheelEvent event(at, on->mapToGlobal(at), {}, {0, delta}, Qt::NoButton, modifiers, Qt::NoScrollPhase, false);
  QApplication::sendEvent(on, &event);
}

inline void mouse(QWidget* on, QEvent::Type type, const QPoint& at, Qt::MouseButton button, Qt::MouseButtons buttons,
                  Qt::KeyboardModifiers modifiers = {}) {
  QMouseEvent event(type, at, on->mapToGlobal(at), button, buttons, modifiers);
  QApplication::sendEvent(on, &event);
}

inline void drag(QWidget* on, const QPoint& from, const QPoint& to, Qt::MouseButton button = Qt::LeftButton,
                 Qt::KeyboardModifiers modifiers = {}) {
  mouse(on, QEvent::MouseButtonPress, from, button, button, modifiers);
  for (int s = 1; s <= 8; ++s)
    mouse(on, QEvent::MouseMove, from + (to - from) * s / 8, Qt::NoButton, button, modifiers);
  mouse(on, QEvent::MouseButtonRelease, to, button, Qt::NoButton, modifiers);
}

/// The window may not freeze: no look at the events waits longer than two seconds, on any machine. Its promise of 50 ms
/// for 99 % and 100 ms for all is a measurement: it is judged where GLISSON_JUDGE_ANSWERS asks for it, on an idle
/// machine.
inline void judge(const session::StallMonitor::Report& answer) {
  QVERIFY2(answer.max_ms <= 2000.0, qPrintable(QString::number(answer.max_ms)));
  if (!qEnvironmentVariableIsSet("GLISSON_JUDGE_ANSWERS")) return;
  QVERIFY2(answer.p99_ms <= 50.0, qPrintable(QString::number(answer.p99_ms)));
  QVERIFY2(answer.max_ms <= 100.0, qPrintable(QString::number(answer.max_ms)));
}

/// How many pixels differ clearly.
inline int changed(const QImage& a, const QImage& b) {
  if (a.size() != b.size()) return a.width() * a.height();
  int n = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
      if (std::abs(qRed(p) - qRed(q)) + std::abs(qGreen(p) - qGreen(q)) + std::abs(qBlue(p) - qBlue(q)) > 24) ++n;
    }
  return n;
}

/// Where the elastogram is trusted most on its middle slice, LPS mm: well inside the liver.
inline Eigen::Vector3d trustedPlace(session::Session& session) {
  const auto& map = *session.images().stiffness;
  const image::Grid& grid = map.values_kPa.grid;
  const int k = grid.size.z() / 2;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double n = 0.0;
  for (int j = 0; j < grid.size.y(); ++j)
    for (int i = 0; i < grid.size.x(); ++i)
      if (map.confidence->at(i, j, k) >= 0.95F) sum += grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k}), n += 1.0;
  if (n < 100.0) qFatal("the elastogram of the synthetic patient is trusted nowhere");
  return sum / n;
}

/// The workstation's window with settings, journals and work of its own, and the hands of a reader.
class WindowBench {
 public:
  /// root: where settings, journals, work and patients lie; empty: a folder that goes with the bench.
  explicit WindowBench(std::filesystem::path root = {}) : root_(std::move(root)) {
    if (root_.empty()) root_ = own_.emplace().path();
    // Not the settings of who runs the tests; no effect of the desktop's style or theme.
    QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, path("settings"));
    panels::applyTheme(panels::Theme::Dark);
    open(path("journals"));
  }
  /// A new window in place of the one before, which is closed first as a crash would: without being asked.
  void open(const QString& journals) {
    window_.reset();
    window_ = make(journals);
  }
  /// One more window, with the same settings.
  std::unique_ptr<panels::MainWindow> make(const QString& journals) {
    auto window = std::make_unique<panels::MainWindow>();
    window->session().setWorkFolder(path("work"));
    window->session().setJournalFolder(journals);
    window->show();
    if (!QTest::qWaitForWindowExposed(window.get())) qFatal("the window does not appear");
    return window;
  }
  void close() { window_.reset(); }
  panels::MainWindow& window() { return *window_; }
  session::Session& session() { return window_->session(); }
  const auto& polygons() { return session().contours().polygons; }
  views::SliceView* mri() { return window_->findChild<views::SliceView*>(QStringLiteral("mriView")); }
  views::SliceView* mre() { return window_->findChild<views::SliceView*>(QStringLiteral("mreView")); }
  panels::SegmentPage* page() { return window_->findChild<panels::SegmentPage*>(); }
  const std::filesystem::path& folder() const { return root_; }
  QString path(const char* name) const { return QString::fromStdString((root_ / name).string()); }
  template <typename W>
  W* find(const char* name) {
    W* found = window_->findChild<W*>(QString::fromLatin1(name));
    if (!found) qFatal("no widget is called %s", name);
    return found;
  }
  void click(const char* name) { QTest::mouseClick(find<QWidget>(name), Qt::LeftButton); }

  /// Does what makes the session read, and waits until it has, whether or not there is anything to be shown then.
  bool afterLoading(const std::function<void()>& act) {
    QSignalSpy loaded(&session(), &session::Session::loaded);
    act();
    return loaded.count() > 0 || loaded.wait(wait_ms);
  }
  /// Opens anything that can be opened, several at once too, without being asked about what was open before.
  bool opened(const QStringList& paths) {
    return afterLoading([&] { session().openPaths(paths); });
  }
  bool opened(const std::filesystem::path& what) { return opened(QStringList{QString::fromStdString(what.string())}); }
  /// The same where there is an image to be shown.
  bool openPath(const QString& what) { return opened(QStringList{what}) && session().images().mri; }
  /// Whether the synthetic patient was opened with all its maps.
  bool openSynthetic() {
    return afterLoading([this] { session().openSynthetic(3, path("patients")); }) && session().images().mri &&
           session().images().stiffness;
  }
  QPoint pixelOf(const Eigen::Vector3d& p_lps) {
    const Eigen::Vector2d px = mri()->plane().toPixel(p_lps);
    return {qRound(px.x()), qRound(px.y())};
  }
  /// Shows the slice of the trusted place and returns its pixel.
  QPoint showLiver() {
    const Eigen::Vector3d place = trustedPlace(session());
    mri()->showPoint(place);
    return pixelOf(place);
  }
  /// Clicks a square and closes it: left in Editing.
  void square(int x, int y, int side) {
    for (const QPoint at : {QPoint(x, y), QPoint(x + side, y), QPoint(x + side, y + side), QPoint(x, y + side)})
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
    QTest::keyClick(mri(), Qt::Key_Return);
  }
  /// Clicks an ellipse of vertices around a point of the slice shown, and closes it on the first vertex.
  void ellipse(const Eigen::Vector3d& centre, double rx_mm, double ry_mm, int vertices) {
    const Eigen::Matrix3d axes = mri()->plane().grid.direction;
    const auto vertex = [&](int v) {
      const double a = 2.0 * M_PI * v / vertices;
      return pixelOf(centre + axes * Eigen::Vector3d(rx_mm * std::cos(a), ry_mm * std::sin(a), 0.0));
    };
    for (int v = 0; v < vertices; ++v) {
      const QPoint at = vertex(v);
      QTest::mouseMove(mri(), at);
      QTest::mouseClick(mri(), Qt::LeftButton, {}, at);
    }
    // Where the first vertex is seen now. The display tells of the mouse when it comes to it: on a busy machine later
    // than mouseMove() waits.
    const QPoint first = vertex(0) + QPoint(3, 3);
    QTest::mouseMove(mri(), first);
    QTRY_VERIFY2(session().tool().closes(),
                 qPrintable(QStringLiteral("view of %1 × %2, first vertex at %3, %4, %5 vertices")
                                .arg(mri()->width())
                                .arg(mri()->height())
                                .arg(first.x())
                                .arg(first.y())
                                .arg(session().tool().drawing().cols())));
    QTest::mouseClick(mri(), Qt::LeftButton, {}, vertex(0) + QPoint(3, 3));
  }
  /// Takes everything back.
  void clean() {
    while (session().canUndo()) session().undo();
    session().tool().deselect();
  }

 private:
  std::optional<TemporaryFolder> own_;
  std::filesystem::path root_;
  std::unique_ptr<panels::MainWindow> window_;
};

}  // namespace glisson::test

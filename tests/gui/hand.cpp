// SPDX-License-Identifier: GPL-3.0-or-later

// A reader's hand on the real window: opens the case below ROOT and makes gestures with real events until it has made
// COUNT of them, telling on stdout when each is done, with a digest of all outlines. Started, and killed, by
// killed_test. Not installed.
// usage: test_gui_hand ROOT COUNT [--save]
#include <unistd.h>

#include <QApplication>
#include <cstdlib>

#include "base/random.h"
#include "digest.h"
#include "window_bench.h"

namespace {

/// Written at once, whole: what was told is done, whatever happens next.
void tell(const std::string& text) {
  const std::string line = text + "\n";
  if (::write(STDOUT_FILENO, line.data(), line.size()) != static_cast<ssize_t>(line.size())) std::_Exit(1);
}

/// One gesture of a reader. The same seed gives the same gestures.
void gesture(glisson::test::WindowBench& bench, glisson::Random& random) {
  auto* view = bench.mri();
  const auto within = [&] {
    return QPoint(40 + static_cast<int>(random.below(static_cast<std::uint64_t>(view->width() - 80))),
                  40 + static_cast<int>(random.below(static_cast<std::uint64_t>(view->height() - 80))));
  };
  const QPoint at = within(), to = within();
  static constexpr Qt::Key keys[] = {Qt::Key_Return, Qt::Key_Escape, Qt::Key_Backspace, Qt::Key_Delete, Qt::Key_S,
                                     Qt::Key_Right,  Qt::Key_X,      Qt::Key_PageUp,    Qt::Key_Return, Qt::Key_Home};
  switch (random.below(8)) {
    case 0:
    case 1:
    case 2:
    case 3: return QTest::mouseClick(view, Qt::LeftButton, {}, at);
    case 4: return glisson::test::drag(view, at, to);
    case 5: return glisson::test::wheel(view, at, random.below(2) == 0 ? 120 : -120);
    case 6: return QTest::keyClick(view, keys[random.below(std::size(keys))]);
    default:
      return QTest::keyClick(view, Qt::Key_Z,
                             random.below(3) == 0 ? Qt::ControlModifier | Qt::ShiftModifier : Qt::ControlModifier);
  }
}

}  // namespace

int main(int argc, char** argv) {
  QApplication app(argc, argv);
  if (argc < 3) return 2;
  const int count = std::atoi(argv[2]);
  const bool saves = argc > 3 && std::string(argv[3]) == "--save";
  glisson::test::WindowBench bench(argv[1]);
  if (!bench.openPath(bench.path("case"))) return 1;
  glisson::Random random(11);
  const auto digest = [&bench] {
    return glisson::test::digestOf(bench.session(), bench.mri()->plane().sopInstanceUid);
  };
  tell("0 " + digest());
  for (int n = 1; n <= count; ++n) {
    gesture(bench, random);
    QCoreApplication::processEvents();
    tell(std::to_string(n) + " " + digest());
    if (saves) bench.session().saveInBackground();
  }
  // The end of a program that is not killed is orderly, but nobody is there to be asked: as the window is closed.
  return 0;
}

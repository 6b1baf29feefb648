#include "screenshot.h"

#include <QApplication>
#include <QPixmap>
#include <QScreen>
#include <QTimer>
#include <iostream>

#include "panels/compare_page.h"
#include "panels/live_bar.h"
#include "panels/main_window.h"
#include "panels/segment_page.h"
#include "views/slice_view.h"

namespace glisson {

using session::Session;

namespace {
constexpr int settle_ms = 1500;  // for the last frame to reach the screen
}

Screenshot::Screenshot(panels::MainWindow& window, Wish wish)
    : QObject(&window), window_(window), wish_(std::move(wish)) {
  connect(&window_.session(), &Session::workEnded, this, [](bool well, const QString& reason) {
    if (well) return;
    std::cerr << "glisson: " << reason.toStdString() << '\n';
    QApplication::exit(1);
  });
}

void Screenshot::start(bool opening) {
  if (opening)
    connect(&window_.session(), &Session::loaded, this, &Screenshot::afterLoad, Qt::QueuedConnection);
  else
    settle();
}

void Screenshot::afterLoad() {
  try {
    if (!wish_.outlines.isEmpty()) window_.session().importContours(wish_.outlines);
  } catch (const std::exception& e) {
    std::cerr << "glisson: " << e.what() << '\n';
    QApplication::exit(3);
    return;
  }
  if (!wish_.run) {
    settle();
    return;
  }
  if (wish_.step == session::Step::Retract) {
    auto* live = window_.findChild<panels::LiveBar*>();
    connect(live, &panels::LiveBar::ready, this, [this, live] {
      window_.showStep(wish_.step);
      live->setLive(true);
      settle();
    });
    window_.run();
    return;
  }
  connect(window_.findChild<panels::ComparePage*>(), &panels::ComparePage::overlayShown, this, &Screenshot::settle,
          static_cast<Qt::ConnectionType>(Qt::QueuedConnection | Qt::SingleShotConnection));
  window_.run();
}

void Screenshot::settle() {
  window_.showStep(wish_.step);
  if (wish_.slice >= 0) window_.findChild<views::SliceView*>(QStringLiteral("mriView"))->setSlice(wish_.slice);
  QTimer::singleShot(settle_ms, this, &Screenshot::take);
}

void Screenshot::take() {
  // The screen, not the widget: only there are the OpenGL views drawn into the rest.
  const QPixmap shot = window_.screen()->grabWindow(window_.winId());
  const bool saved = shot.save(wish_.file, "PNG");
  if (!saved) std::cerr << "glisson: cannot write the screenshot\n";
  QApplication::exit(saved ? 0 : 1);
}

}  // namespace glisson

// SPDX-License-Identifier: GPL-3.0-or-later
#include "screenshot.h"

#include <QApplication>
#include <QDir>
#include <QPixmap>
#include <QScreen>
#include <QTimer>
#include <algorithm>
#include <array>
#include <iostream>

#include "panels/compare_page.h"
#include "panels/live_bar.h"
#include "panels/main_window.h"
#include "panels/plane_views.h"
#include "panels/segment_page.h"
#include "session/model_preview.h"
#include "views/scene_view.h"
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
  const auto wanted = [this](session::Step step) { return std::ranges::count(wish_.steps, step) > 0; };
  wantsLive_ = wanted(session::Step::Retract);
  wantsOverlay_ = wanted(session::Step::Compare);
  connect(window_.findChild<panels::LiveBar*>(), &panels::LiveBar::ready, this, [this] {
    wantsLive_ = false;
    whenReady();
  });
  connect(
      window_.findChild<panels::ComparePage*>(), &panels::ComparePage::overlayShown, this,
      [this] {
        wantsOverlay_ = false;
        whenReady();
      },
      static_cast<Qt::ConnectionType>(Qt::QueuedConnection | Qt::SingleShotConnection));
  connect(&window_.session(), &Session::runFinished, this, &Screenshot::whenReady, Qt::QueuedConnection);
  window_.run();
}

void Screenshot::whenReady() {
  if (!wantsLive_ && !wantsOverlay_ && next_ == 0) settle();
}

void Screenshot::settle() {
  const session::Step step = wish_.steps[next_];
  window_.showStep(step);
  if (step == session::Step::Retract && wish_.run) window_.findChild<panels::LiveBar*>()->setLive(true);
  if (wish_.slice >= 0) window_.findChild<views::SliceView*>(QStringLiteral("mriView"))->setSlice(wish_.slice);
  if (step == session::Step::Segment && wish_.planes) showPlanes();
  QTimer::singleShot(settle_ms, this, &Screenshot::take);
}

void Screenshot::showPlanes() {
  auto* page = window_.findChild<panels::SegmentPage*>();
  if (page->planes()->isHidden()) page->run(tools::Command::Planes);
  page->setFusion(0.5);
}

void Screenshot::take() {
  const auto scenes = window_.findChildren<views::SceneView*>();
  const auto* live = window_.findChild<panels::LiveBar*>();
  const auto* page = window_.findChild<panels::SegmentPage*>();
  const bool planesWait = wish_.planes && !(page->planes()->both()[0]->hasVolume() &&
                                            (wish_.outlines.isEmpty() || window_.session().statistics().region));
  // The model is still being made, or a picture of it, or the livers or other planes are still on their way.
  if (planesWait || window_.session().preview().busy() || !std::ranges::all_of(scenes, &views::SceneView::isSettled) ||
      (live->isLive() && !live->isAtRest())) {
    QTimer::singleShot(settle_ms, this, &Screenshot::take);
    return;
  }
  static constexpr std::array names = {"load", "segment", "model", "retract", "compare"};
  QString file = wish_.file;
  if (wish_.steps.size() > 1) {
    QDir().mkpath(file);
    file +=
        QLatin1Char('/') + QLatin1String(names[static_cast<std::size_t>(wish_.steps[next_])]) + QStringLiteral(".png");
  }
  // The screen, not the widget: only there are the OpenGL views drawn into the rest.
  const QPixmap shot = window_.screen()->grabWindow(window_.winId());
  const bool saved = shot.save(file, "PNG");
  if (!saved) std::cerr << "glisson: cannot write the screenshot\n";
  if (saved && ++next_ < wish_.steps.size())
    settle();
  else
    QApplication::exit(saved ? 0 : 1);
}

}  // namespace glisson

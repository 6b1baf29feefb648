// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/scene_painter.h"

#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <QElapsedTimer>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "render/offscreen_window.h"
#include "render/overlay.h"

namespace glisson::views {

namespace {

constexpr double hurriedFrame_s = 0.04;  // a frame of what moves is made coarser until it takes no longer
constexpr double coarsest = 0.4;         // of the full width

tools::SceneCamera cameraOf(vtkRenderer& renderer) {
  vtkCamera& c = *renderer.GetActiveCamera();
  tools::SceneCamera camera;
  camera.focus_lps = Eigen::Vector3d(c.GetFocalPoint());
  camera.fromEye = Eigen::Vector3d(c.GetDirectionOfProjection());
  camera.up = Eigen::Vector3d(c.GetViewUp());
  camera.up = (camera.up - camera.up.dot(camera.fromEye) * camera.fromEye).normalized();
  camera.halfHeight_mm = c.GetParallelScale();
  camera.distance_mm = c.GetDistance();
  return camera;
}

void setCamera(vtkRenderer& renderer, const tools::SceneCamera& camera) {
  vtkCamera& c = *renderer.GetActiveCamera();
  const Eigen::Vector3d eye = camera.focus_lps - camera.distance_mm * camera.fromEye;
  c.ParallelProjectionOn();
  c.SetFocalPoint(camera.focus_lps.data());
  c.SetPosition(eye.data());
  c.SetViewUp(camera.up.data());
  c.SetParallelScale(camera.halfHeight_mm);
}

QImage imageOf(const render::Picture& picture) {
  QImage image(picture.rgb.data(), picture.width, picture.height, 3 * picture.width, QImage::Format_RGB888);
  return image.convertToFormat(QImage::Format_RGB32);  // a copy of its own, in the format that windows are made of
}

/// The context and the renderer; both live on the painter's thread.
class Canvas {
 public:
  Canvas() : window_(64, 64, render::renderBackend()) {
    // The window shows what is drawn without another copy of it.
    window_.window()->SetMultiSamples(0);
  }
  ~Canvas() { window_.window()->RemoveRenderer(renderer_); }

  vtkRenderer& renderer() { return *renderer_; }

  ScenePainter::Frame draw(const ScenePainter::Wish& wish) {
    QElapsedTimer clock;
    clock.start();
    if (!attached_) window_.window()->AddRenderer(renderer_);
    attached_ = true;
    const double scale = wish.hurried ? std::clamp(std::sqrt(hurriedFrame_s / fullFrame_s_), coarsest, 1.0) : 1.0;
    window_.setSize(std::max(static_cast<int>(std::lround(scale * wish.width)), 16),
                    std::max(static_cast<int>(std::lround(scale * wish.height)), 16), wish.hurried ? 0 : 4);
    window_.window()->SetDPI(std::max(static_cast<int>(std::lround(72.0 * scale)), 1));  // text keeps its size
    if (wish.camera) setCamera(*renderer_, *wish.camera);
    renderer_->ResetCameraClippingRange();
    ScenePainter::Frame frame;
    {
      const std::scoped_lock text(render::textDrawing());
      clock.restart();  // waiting for another picture's text is no cost of this one
      frame.image = imageOf(window_.capture());
    }
    frame.camera = cameraOf(*renderer_);
    frame.hurried = wish.hurried;
    frame.number = wish.number;
    frame.seconds = 1e-9 * static_cast<double>(clock.nsecsElapsed());
    // The first frame compiles shaders: what the following ones take is learnt from them.
    const double full_s = frame.seconds / (scale * scale);
    fullFrame_s_ = wish.hurried ? 0.7 * fullFrame_s_ + 0.3 * full_s : fullFrame_s_;
    return frame;
  }

 private:
  render::OffscreenWindow window_;
  vtkNew<vtkRenderer> renderer_;
  bool attached_ = false;
  double fullFrame_s_ = 4.0 * hurriedFrame_s;
};

}  // namespace

ScenePainter::ScenePainter(QObject* parent)
    : QObject(parent), thread_([this](const std::stop_token& stop) { work(stop); }) {}

ScenePainter::~ScenePainter() = default;

void ScenePainter::change(int key, Change change) {
  const std::scoped_lock lock(mutex_);
  Change& waiting = changes_[key];
  if (waiting) replaced_.push_back(std::move(waiting));
  waiting = std::move(change);
}

void ScenePainter::retire(std::shared_ptr<void> made) {
  if (!made) return;
  const std::scoped_lock lock(mutex_);
  retired_.push_back(std::move(made));
}

void ScenePainter::paint(const Wish& wish) {
  {
    const std::scoped_lock lock(mutex_);
    wish_ = wish;
  }
  wake_.notify_one();
}

void ScenePainter::forget() {
  const std::scoped_lock lock(mutex_);
  wish_.reset();
}

void ScenePainter::work(const std::stop_token& stop) {
  std::unique_ptr<Canvas> canvas;
  for (;;) {
    std::map<int, Change> changes;
    std::optional<Wish> wish;
    std::vector<Change> replaced;
    std::vector<std::shared_ptr<void>> retired;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [this] { return wish_.has_value(); });
      if (stop.stop_requested()) return;
      replaced.swap(replaced_);
      retired.swap(retired_);
      changes = std::exchange(changes_, {});
      wish = std::exchange(wish_, std::nullopt);
    }
    try {
      if (!canvas) canvas = std::make_unique<Canvas>();
      for (const auto& [key, change] : changes) change(canvas->renderer());
      const Frame frame = canvas->draw(*wish);
      QMetaObject::invokeMethod(
          this, [this, frame] { emit painted(frame); }, Qt::QueuedConnection);
    } catch (const std::exception& e) {
      const QString reason = QString::fromUtf8(e.what());
      QMetaObject::invokeMethod(
          this, [this, reason] { emit failed(reason); }, Qt::QueuedConnection);
    }
  }
}

}  // namespace glisson::views

#include "views/scene_view.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkPropCollection.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <QLabel>
#include <QMouseEvent>
#include <QStackedLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include "views/live_layer.h"
#include "views/vtk_widget.h"

namespace glisson::views {

SceneView::SceneView(QWidget* parent) : QWidget(parent), hint_(new QLabel(this)), layout_(new QStackedLayout(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  hint_->setAlignment(Qt::AlignCenter);
  hint_->setWordWrap(true);
  hint_->setObjectName(QStringLiteral("viewHint"));
  layout_->addWidget(hint_);
}

void SceneView::setHint(const QString& hint) {
  hint_->setText(hint);
}

// An OpenGL widget makes the whole window be put together by OpenGL, which costs every repaint of the images tens of
// milliseconds where a program draws for the graphics card: it comes only with the first scene.
void SceneView::makeWidget() {
  if (widget_) return;
  widget_ = new VtkWidget(this);
  widget_->setObjectName(QStringLiteral("vtkWidget"));
  widget_->renderer()->SetBackground(0.063, 0.071, 0.086);
  connect(widget_, &VtkWidget::rendered, this, &SceneView::rendered);
  widget_->installEventFilter(this);
  layout_->addWidget(widget_);
}

void SceneView::setScene(std::shared_ptr<const render::RetractionScene> scene) {
  if (scene) makeWidget();
  scene_ = std::move(scene);
  layer_.reset();
  grip_.reset();
  layout_->setCurrentWidget(scene_ ? static_cast<QWidget*>(widget_) : hint_);
  populate(false);
}

void SceneView::clear() {
  setScene(nullptr);
}

void SceneView::setFraction(double t) {
  if (options_.t == t) return;
  options_.t = t;
  populate(true);
}

void SceneView::setPalette3D(render::Palette palette) {
  options_.palette = palette;
  if (layer_) layer_->setPalette(palette);
  populate(true);
}

void SceneView::setView(render::View3D view) {
  options_.view = view;
  populate(false);
}

void SceneView::showEvent(QShowEvent*) {
  if (stale_) populate(true);
}

// Legend, scale and texts are laid out for the size of the view.
void SceneView::resizeEvent(QResizeEvent*) {
  populate(true);
}

void SceneView::populate(bool keepCamera) {
  if (!keepCamera) newCamera_ = true;
  stale_ = scene_ != nullptr;
  if (!scene_ || !isVisible() || making_) return;
  stale_ = false;
  making_ = true;
  options_.width = std::max(qRound(width() * devicePixelRatioF()), 64);
  options_.height = std::max(qRound(height() * devicePixelRatioF()), 64);
  // Into a renderer of its own, without a window: no OpenGL and no text is touched until it is shown.
  auto drawn = layer_ ? atRest_ : scene_;
  auto options = options_;
  if (layer_) options.t = 0.0;
  thread_ = std::jthread([this, scene = drawn, options] {
    auto made = vtkSmartPointer<vtkRenderer>::New();
    QString failure;
    try {
      render::populate3D(made, *scene, options);
    } catch (const std::exception& e) {
      failure = QString::fromUtf8(e.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, made, failure, scene] {
          making_ = false;
          if (!failure.isEmpty()) {
            hint_->setText(failure);
            layout_->setCurrentWidget(hint_);
          } else if (scene == (layer_ ? atRest_ : scene_)) {
            take(made);
          }
          if (stale_) populate(true);
        },
        Qt::QueuedConnection);
  });
}

void SceneView::take(vtkRenderer* made) {
  vtkRenderer* shown = widget_->renderer();
  shown->RemoveAllViewProps();
  shown->RemoveAllLights();
  vtkCollectionSimpleIterator at;
  made->GetViewProps()->InitTraversal(at);
  while (vtkProp* prop = made->GetViewProps()->GetNextProp(at)) {
    // What moves live is no fraction of the run.
    const auto* text = vtkTextActor::SafeDownCast(prop);
    if (layer_ && text && QString::fromUtf8(const_cast<vtkTextActor*>(text)->GetInput()).startsWith(u"0 % of"))
      continue;
    shown->AddViewProp(prop);
  }
  if (layer_) layer_->addTo(shown);
  made->GetLights()->InitTraversal(at);
  while (vtkLight* light = made->GetLights()->GetNextLight(at)) shown->AddLight(light);
  shown->SetBackground(made->GetBackground());
  shown->SetBackground2(made->GetBackground2());
  shown->SetGradientBackground(made->GetGradientBackground());
  if (std::exchange(newCamera_, false)) shown->GetActiveCamera()->DeepCopy(made->GetActiveCamera());
  shown->ResetCameraClippingRange();
  widget_->update();
}

void SceneView::setLive(bool live) {
  if (live == isLive() || !scene_) return;
  grip_.reset();
  if (live) {
    auto rest = std::make_shared<render::RetractionScene>(*scene_);
    rest->vesselSurface = {};
    rest->retractorPoint_lps_mm.reset();
    atRest_ = std::move(rest);
    layer_ = std::make_unique<LiveLayer>(*scene_, options_.palette);
  } else {
    layer_.reset();
    atRest_.reset();
  }
  populate(true);
}

void SceneView::moveLive(const Eigen::Matrix3Xd& mre_mm, const Eigen::Matrix3Xd& atlas_mm,
                         const Eigen::Vector3d& tool_mm) {
  if (!layer_) return;
  layer_->move(mre_mm, atlas_mm, tool_mm);
  toolMoved_mm_ = tool_mm;
  widget_->renderer()->ResetCameraClippingRange();
  widget_->update();
}

Eigen::Vector3d SceneView::seenAt(const Eigen::Vector3d& p_lps) const {
  vtkRenderer* renderer = widget_->renderer();
  renderer->SetWorldPoint(p_lps.x(), p_lps.y(), p_lps.z(), 1.0);
  renderer->WorldToDisplay();
  return Eigen::Map<const Eigen::Vector3d>(renderer->GetDisplayPoint());
}

std::optional<QPointF> SceneView::toolPixel() const {
  if (!layer_ || !scene_->retractorPoint_lps_mm) return {};
  const Eigen::Vector3d seen = seenAt(layer_->tool_lps()) / devicePixelRatioF();
  return QPointF(seen.x(), widget_->height() - 1.0 - seen.y());
}

// The tool is taken by the mouse where the bar's contact is; anywhere else the mouse turns the camera.
bool SceneView::eventFilter(QObject* watched, QEvent* event) {
  constexpr double reach_px = 30.0;
  if (!layer_ || watched != widget_) return QWidget::eventFilter(watched, event);
  if (event->type() == QEvent::MouseButtonPress) {
    const auto* mouse = static_cast<QMouseEvent*>(event);
    const auto tool = toolPixel();
    if (mouse->button() != Qt::LeftButton || !tool) return false;
    const QPointF off = mouse->position() - *tool;
    if (std::hypot(off.x(), off.y()) > reach_px) return false;
    grip_ = Grip{mouse->position(), seenAt(layer_->tool_lps()), layer_->tool_lps(), toolMoved_mm_};
    widget_->setCursor(Qt::ClosedHandCursor);
    return true;
  }
  if (event->type() == QEvent::MouseMove && grip_) {
    const QPointF d = (static_cast<QMouseEvent*>(event)->position() - grip_->mouse) * devicePixelRatioF();
    vtkRenderer* renderer = widget_->renderer();
    renderer->SetDisplayPoint(grip_->tool_px.x() + d.x(), grip_->tool_px.y() - d.y(), grip_->tool_px.z());
    renderer->DisplayToWorld();
    const Eigen::Vector4d at = Eigen::Map<const Eigen::Vector4d>(renderer->GetWorldPoint());
    if (at.w() != 0.0) emit toolDragged(grip_->moved_mm + at.head<3>() / at.w() - grip_->tool_lps);
    return true;
  }
  if (event->type() == QEvent::MouseButtonRelease && grip_) {
    grip_.reset();
    widget_->unsetCursor();
    return true;
  }
  return false;
}

SceneView::~SceneView() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace glisson::views

#include "views/scene_view.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkPropCollection.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <QLabel>
#include <QStackedLayout>
#include <algorithm>
#include <utility>

#include "views/vtk_widget.h"

namespace glisson::views {

SceneView::SceneView(QWidget* parent)
    : QWidget(parent), hint_(new QLabel(this)), layout_(new QStackedLayout(this)) {
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
  layout_->addWidget(widget_);
}

void SceneView::setScene(std::shared_ptr<const render::RetractionScene> scene) {
  if (scene) makeWidget();
  scene_ = std::move(scene);
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
  thread_ = std::jthread([this, scene = scene_, options = options_] {
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
          } else if (scene == scene_) {
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
  while (vtkProp* prop = made->GetViewProps()->GetNextProp(at)) shown->AddViewProp(prop);
  made->GetLights()->InitTraversal(at);
  while (vtkLight* light = made->GetLights()->GetNextLight(at)) shown->AddLight(light);
  shown->SetBackground(made->GetBackground());
  shown->SetBackground2(made->GetBackground2());
  shown->SetGradientBackground(made->GetGradientBackground());
  if (std::exchange(newCamera_, false)) shown->GetActiveCamera()->DeepCopy(made->GetActiveCamera());
  shown->ResetCameraClippingRange();
  widget_->update();
}

SceneView::~SceneView() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace glisson::views

#include "views/scene_view.h"

#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <QLabel>
#include <QStackedLayout>
#include <algorithm>
#include <utility>

#include "views/vtk_widget.h"

namespace glisson::views {

SceneView::SceneView(QWidget* parent)
    : QWidget(parent), widget_(new VtkWidget(this)), hint_(new QLabel(this)), layout_(new QStackedLayout(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  hint_->setAlignment(Qt::AlignCenter);
  hint_->setWordWrap(true);
  hint_->setObjectName(QStringLiteral("viewHint"));
  layout_->addWidget(hint_);
  layout_->addWidget(widget_);
  widget_->setObjectName(QStringLiteral("vtkWidget"));
  widget_->renderer()->SetBackground(0.063, 0.071, 0.086);
  connect(widget_, &VtkWidget::rendered, this, &SceneView::rendered);
}

void SceneView::setHint(const QString& hint) {
  hint_->setText(hint);
}

void SceneView::setScene(std::shared_ptr<const render::RetractionScene> scene) {
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
  if (!scene_ || !isVisible()) return;
  stale_ = false;
  vtkNew<vtkCamera> before;
  before->DeepCopy(widget_->renderer()->GetActiveCamera());
  options_.width = std::max(qRound(width() * devicePixelRatioF()), 64);
  options_.height = std::max(qRound(height() * devicePixelRatioF()), 64);
  render::populate3D(widget_->renderer(), *scene_, options_);
  if (!std::exchange(newCamera_, false)) widget_->renderer()->GetActiveCamera()->DeepCopy(before);
  widget_->renderer()->ResetCameraClippingRange();
  widget_->update();
}

}  // namespace glisson::views

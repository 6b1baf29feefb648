// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/scene_view.h"

#include <vtkCamera.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkPropCollection.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "views/live_layer.h"
#include "views/model_layer.h"

namespace glisson::views {

namespace {

enum Key { composed, movedLive, shownParts };
constexpr int settle_ms = 140;

/// The fraction stands beside the slider, which is ahead of the picture. The caption, where it is given, holds the
/// numbers of the run: what moves live has others.
void dropWords(vtkRenderer& renderer, std::string_view caption) {
  std::vector<vtkProp*> gone;
  vtkCollectionSimpleIterator at;
  renderer.GetViewProps()->InitTraversal(at);
  while (vtkProp* prop = renderer.GetViewProps()->GetNextProp(at))
    if (auto* text = vtkTextActor::SafeDownCast(prop); text && text->GetInput())
      if (const std::string_view words = text->GetInput();
          words.ends_with(" % of the retraction") ||
          (text->GetPosition()[1] < 0.5 && !words.empty() && caption.find(words) != std::string_view::npos))
        gone.push_back(prop);
  for (vtkProp* prop : gone) renderer.RemoveViewProp(prop);
}

Eigen::Vector2d asVector(const QPointF& p) {
  return {p.x(), p.y()};
}

}  // namespace

SceneView::SceneView(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setAttribute(Qt::WA_OpaquePaintEvent);
  settle_.setSingleShot(true);
  settle_.setInterval(settle_ms);
  connect(&settle_, &QTimer::timeout, this, [this] { draw(false); });
  connect(&painter_, &ScenePainter::painted, this, &SceneView::take);
  connect(&painter_, &ScenePainter::failed, this, [this](const QString& reason) {
    hint_ = reason;
    image_ = {};
    drawn_ = wished_;
    update();
  });
}

SceneView::~SceneView() = default;

void SceneView::setHint(const QString& hint) {
  hint_ = hint;
  update();
}

void SceneView::setCaption(const QString& caption) {
  caption_ = caption;
  update();
}

void SceneView::setOutdated(const QString& words) {
  if (words == outdated_) return;
  outdated_ = words;
  update();
}

void SceneView::setScene(std::shared_ptr<const render::RetractionScene> scene) {
  startAnew();
  scene_ = std::move(scene);
  model_.reset();
  painter_.retire(std::exchange(layer_, nullptr));
  painter_.retire(std::exchange(modelLayer_, nullptr));
  drag_ = Drag::None;
  image_ = {};
  update();
  compose(false);
}

void SceneView::setModel(std::shared_ptr<const tools::ModelPicture> model) {
  const bool again = model_ && model;
  if (!again) startAnew();
  scene_.reset();
  painter_.retire(std::exchange(layer_, nullptr));
  model_ = std::move(model);
  if (!model_) {
    painter_.retire(std::exchange(modelLayer_, nullptr));
    image_ = {};
    update();
    return;
  }
  if (!again) {
    image_ = {};
    // From the front, a little from the right and below: where the bar lies.
    camera_ = {};
    camera_.fromEye = Eigen::Vector3d(0.42, 0.80, 0.42).normalized();
    camera_.up = (Eigen::Vector3d::UnitZ() - camera_.fromEye.z() * camera_.fromEye).normalized();
    fitModel();
  }
  composeModel();
}

void SceneView::fitModel() {
  Eigen::AlignedBox3d box;
  for (Eigen::Index n = 0; n < model_->liver.vertices_lps_mm.cols(); ++n)
    box.extend(Eigen::Vector3d(model_->liver.vertices_lps_mm.col(n)));
  // The legend has the right side to itself.
  camera_.fit(box, size_px() - Eigen::Vector2d(std::min(150.0, 0.3 * width()), 0.0));
  cameraKnown_ = true;
}

void SceneView::clear() {
  setScene(nullptr);
}

void SceneView::setFraction(double t) {
  if (options_.t == t) return;
  options_.t = t;
  compose(true);
}

void SceneView::setPalette3D(render::Palette palette) {
  if (options_.palette == palette) return;
  options_.palette = palette;
  compose(true);
}

void SceneView::setShown(render::Shown3D shown) {
  if (options_.shown == shown) return;
  options_.shown = shown;
  options_.camera.reset();
  const bool pressure = shown == render::Shown3D::PressureMre || shown == render::Shown3D::PressureAtlas;
  if (pressure) options_.camera = render::barCamera;
  compose(false);
}

void SceneView::setArrows(bool on) {
  if (options_.arrows == on) return;
  options_.arrows = on;
  compose(true);
}

void SceneView::setView(render::View3D view) {
  options_.view = view;
  options_.camera.reset();
  compose(false);
}

void SceneView::setParts(const ModelParts& parts) {
  if (parts_ == parts) return;
  parts_ = parts;
  if (!modelLayer_) return;
  painter_.change(shownParts, [layer = modelLayer_, parts](vtkRenderer&) {
    if (*layer) (*layer)->show(parts);
  });
  draw(false);
  update();
}

void SceneView::setMarks(std::vector<Mark> marks) {
  marks_ = std::move(marks);
  update();
}

void SceneView::setPlacing(bool on) {
  placing_ = on;
  on ? setCursor(Qt::CrossCursor) : unsetCursor();
}

void SceneView::showEvent(QShowEvent*) {
  draw(false);
}

// Legend, scale and texts are laid out for the size of the view.
void SceneView::resizeEvent(QResizeEvent*) {
  if (!model_) {
    compose(true);
    return;
  }
  if (image_.isNull()) fitModel();  // it was not seen before
  draw(false);
}

// Pictures that are still in the making show what was there before, from where it was seen.
void SceneView::startAnew() {
  painter_.forget();
  since_ = wished_;
  cameraKnown_ = false;
}

bool SceneView::isSettled() const {
  return !hasPicture() || !isVisible() || (drawn_ == wished_ && !settle_.isActive());
}

void SceneView::compose(bool keepCamera) {
  if (!scene_) return;
  if (!keepCamera) startAnew();
  auto options = options_;
  options.width = std::max(qRound(width() * devicePixelRatioF()), 64);
  options.height = std::max(qRound(height() * devicePixelRatioF()), 64);
  const bool pressure = scene_->bar && (options.shown == render::Shown3D::PressureMre || scene_->bar->atlas);
  if (layer_ || !pressure) options.shown = render::Shown3D::Answers;
  if (layer_) options.t = 0.0, options.retractor = false;  // the live layer has the bar in hand
  painter_.change(composed, [scene = scene_, layer = layer_, options](vtkRenderer& renderer) {
    render::populate3D(&renderer, *scene, options);
    dropWords(renderer, layer ? std::string_view(scene->caption) : std::string_view());
    if (!layer) return;
    if (!*layer) *layer = std::make_unique<LiveLayer>(*scene, options.palette);
    (*layer)->setPalette(options.palette);
    (*layer)->addTo(&renderer);
  });
  draw(false);
}

void SceneView::composeModel() {
  painter_.retire(std::exchange(modelLayer_, std::make_shared<std::unique_ptr<ModelLayer>>()));
  painter_.change(composed, [model = model_, layer = modelLayer_, parts = parts_,
                             ratio = devicePixelRatioF()](vtkRenderer& renderer) {
    renderer.RemoveAllViewProps();
    renderer.RemoveAllLights();
    renderer.SetBackground(0.055, 0.062, 0.075);
    renderer.SetBackground2(0.13, 0.145, 0.17);
    renderer.GradientBackgroundOn();
    vtkNew<vtkLightKit> lights;
    lights->SetKeyLightIntensity(0.85);
    lights->AddLightsToRenderer(&renderer);
    *layer = std::make_unique<ModelLayer>(*model, ratio);
    (*layer)->show(parts);
    (*layer)->addTo(renderer);
  });
  draw(false);
}

Eigen::Vector2d SceneView::size_px() const {
  return {std::max(width(), 1), std::max(height(), 1)};
}

void SceneView::draw(bool hurried) {
  if (!hasPicture() || !isVisible()) return;
  ScenePainter::Wish wish;
  if (cameraKnown_) wish.camera = camera_;
  wish.width = std::max(qRound(width() * devicePixelRatioF()), 64);
  wish.height = std::max(qRound(height() * devicePixelRatioF()), 64);
  wish.hurried = hurried;
  wish.number = ++wished_;
  painter_.paint(wish);
  hurried ? settle_.start() : settle_.stop();
}

void SceneView::moved() {
  draw(true);
}

void SceneView::take(const ScenePainter::Frame& frame) {
  drawn_ = frame.number;
  if (!hasPicture() || frame.number <= since_) return;
  image_ = frame.image;
  shownCamera_ = frame.camera;
  if (!std::exchange(cameraKnown_, true)) camera_ = frame.camera;
  update();
  emit rendered();
}

void SceneView::setLive(bool live) {
  if (live == isLive() || !scene_) return;
  drag_ = Drag::None;
  if (live) {
    layer_ = std::make_shared<std::unique_ptr<LiveLayer>>();
    toolMoved_mm_.setZero();
  } else {
    painter_.retire(std::exchange(layer_, nullptr));
  }
  compose(true);
}

void SceneView::moveLive(const Eigen::Matrix3Xd& mre_mm, const Eigen::Matrix3Xd& atlas_mm,
                         const Eigen::Vector3d& tool_mm, const Eigen::Vector3d& atlasTool_mm) {
  if (!layer_) return;
  toolMoved_mm_ = tool_mm;
  painter_.change(movedLive, [layer = layer_, mre_mm, atlas_mm, tool_mm, atlasTool_mm](vtkRenderer&) {
    if (*layer) (*layer)->move(mre_mm, atlas_mm, tool_mm, atlasTool_mm);
  });
  draw(true);
}

QPointF SceneView::pixelOf(const Eigen::Vector3d& p_lps) const {
  const Eigen::Vector2d px = camera_.toPixel(p_lps, size_px());
  return {px.x(), px.y()};
}

std::optional<QPointF> SceneView::toolPixel() const {
  if (!layer_ || !scene_->retractorPoint_lps_mm || !cameraKnown_) return {};
  return pixelOf(*scene_->retractorPoint_lps_mm + toolMoved_mm_);
}

const anatomy::TriangleMesh* SceneView::surface() const {
  return scene_ ? &scene_->liverSurface : model_ ? &model_->liver : nullptr;
}

std::optional<Eigen::Vector3d> SceneView::surfaceUnder(const QPointF& at,
                                                       const std::optional<Eigen::Vector3d>& against) const {
  const anatomy::TriangleMesh* mesh = surface();
  if (!mesh || !cameraKnown_) return {};
  const Eigen::Vector3d eye = camera_.focus_lps - camera_.distance_mm * camera_.fromEye;
  return tools::firstHit(*mesh, camera_.toLps(asVector(at), size_px(), eye), camera_.fromEye, against);
}

}  // namespace glisson::views

#pragma once

#include <Eigen/Core>
#include <QWidget>
#include <memory>
#include <optional>
#include <thread>

#include "render/overlay.h"

class QLabel;
class QStackedLayout;
class vtkRenderer;

namespace glisson::views {

class LiveLayer;
class VtkWidget;

/// The 3-D overlay of one retraction: the same drawing as the exported picture, with a camera that the mouse moves.
class SceneView : public QWidget {
  Q_OBJECT
 public:
  explicit SceneView(QWidget* parent = nullptr);
  ~SceneView() override;  ///< waits for the scene in the making

  void setScene(std::shared_ptr<const render::RetractionScene> scene);
  void clear();
  bool hasScene() const { return scene_ != nullptr; }
  /// Fraction of the displacement that is shown: 0 at rest, 1 retracted. Keeps the camera.
  void setFraction(double t);
  void setPalette3D(render::Palette palette);
  void setView(render::View3D view);
  void setHint(const QString& hint);

  /// Live: the liver at rest and what moveLive says, instead of the run's own answer. Needs a scene; a new scene ends
  /// it.
  void setLive(bool live);
  bool isLive() const { return layer_ != nullptr; }
  /// As LiveLayer::move; drawn with the next frame of the window.
  void moveLive(const Eigen::Matrix3Xd& mre_mm, const Eigen::Matrix3Xd& atlas_mm, const Eigen::Vector3d& tool_mm);
  /// Where the tool's contact is seen, in logical pixels of this view; nothing while not live.
  std::optional<QPointF> toolPixel() const;

 signals:
  void rendered();
  void toolDragged(
      const Eigen::Vector3d& displacement_mm);  ///< of the contact from rest, LPS, in the plane of the view

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void makeWidget();
  void populate(bool keepCamera);
  void take(vtkRenderer* made);
  Eigen::Vector3d seenAt(const Eigen::Vector3d& p_lps) const;  ///< device pixels from below, and depth
  std::shared_ptr<const render::RetractionScene> scene_;
  render::SceneOptions3D options_;
  bool stale_ = false;                ///< to be drawn anew when it is next seen
  bool newCamera_ = false;            ///< and from the preset direction
  bool making_ = false;               ///< the thread is at work; stale_ says that its scene is out of date already
  std::jthread thread_;               ///< warps the surfaces; what it makes is only shown here
  VtkWidget* widget_ = nullptr;       ///< null before the first scene
  std::unique_ptr<LiveLayer> layer_;  ///< null while not live
  std::shared_ptr<const render::RetractionScene> atRest_;  ///< what is drawn round it
  Eigen::Vector3d toolMoved_mm_ = Eigen::Vector3d::Zero();
  struct Grip {
    QPointF mouse;            ///< where it was taken
    Eigen::Vector3d tool_px;  ///< and where the tool was seen then
    Eigen::Vector3d tool_lps;
    Eigen::Vector3d moved_mm;  ///< from rest
  };
  std::optional<Grip> grip_;
  QLabel* hint_;
  QStackedLayout* layout_;
};

}  // namespace glisson::views

#pragma once

#include <QWidget>
#include <memory>
#include <thread>

#include "render/overlay.h"

class QLabel;
class QStackedLayout;
class vtkRenderer;

namespace glisson::views {

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

 signals:
  void rendered();

 protected:
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void makeWidget();
  void populate(bool keepCamera);
  void take(vtkRenderer* made);
  std::shared_ptr<const render::RetractionScene> scene_;
  render::SceneOptions3D options_;
  bool stale_ = false;      ///< to be drawn anew when it is next seen
  bool newCamera_ = false;  ///< and from the preset direction
  bool making_ = false;     ///< the thread is at work; stale_ says that its scene is out of date already
  std::jthread thread_;     ///< warps the surfaces; what it makes is only shown here
  VtkWidget* widget_ = nullptr;  ///< null before the first scene
  QLabel* hint_;
  QStackedLayout* layout_;
};

}  // namespace glisson::views

#pragma once

#include <QWidget>

#include "render/overlay.h"
#include "session/worker.h"

class QComboBox;
class QLabel;
class QSlider;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class PictureView;
class SceneView;
}  // namespace glisson::views

namespace glisson::panels {

/// Compare: where MRE and atlas place the same tissue, slice by slice and in 3-D, with the numbers and how far to trust
/// them.
class ComparePage : public QWidget {
  Q_OBJECT
 public:
  explicit ComparePage(session::Session& session, QWidget* parent = nullptr);
  views::PictureView* overlayView() const { return overlay_; }
  views::SceneView* sceneView() const { return scene_; }

 signals:
  void overlayShown(int slice);  ///< a slice overlay was drawn and is on screen

 private:
  QWidget* makeSide();
  void showResult();
  void showNumbers();
  void drawSlice();
  render::Palette palette_() const;
  session::Session& session_;
  session::Worker painter_;  ///< draws slice overlays; only the latest wish counts
  bool wanted_ = false;
  bool chosen_ = false;  ///< else the slice of the largest difference is to be found and shown
  views::PictureView* overlay_;
  views::SceneView* scene_;
  QSlider* slice_;
  QLabel *sliceText_, *retractor_, *numbers_, *vessels_, *validity_;
  QComboBox *colours_, *view_;
};

}  // namespace glisson::panels

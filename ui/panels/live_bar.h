#pragma once

#include <Eigen/Core>
#include <QElapsedTimer>
#include <QWidget>
#include <array>
#include <memory>

#include "session/live_pair.h"
#include "session/worker.h"

class QLabel;
class QPushButton;
class QSlider;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class SceneView;
}

namespace glisson::panels {

/// The retractor in the hand: after a run both livers are condensed by a worker; then mouse or sliders move the tool,
/// and surface, vessels and differences follow at once.
class LiveBar : public QWidget {
  Q_OBJECT
 public:
  LiveBar(session::Session& session, views::SceneView& scene, QWidget* parent = nullptr);
  bool isReady() const { return pair_ != nullptr; }
  const session::LiveFrame& frame() const { return frame_; }
  /// Seconds that the last frame took: both answers, differences and what is drawn, without the drawing itself.
  double frameSeconds() const { return frame_s_; }
  void setLive(bool live);
  bool isLive() const;
  /// The contact under the measured stiffness goes there, mm from rest in LPS; kept within the sliders' range.
  void moveTool(const Eigen::Vector3d& displacement_mm);

 signals:
  void ready();  ///< the livers are condensed
  void liveChanged(bool live);

 private:
  void build();
  void reset();
  void take();
  void show(const Eigen::Vector3d& displacement_mm);
  void setSliders(const Eigen::Vector3d& displacement_mm);
  void pictureDrawn();
  session::Session& session_;
  views::SceneView& scene_;
  session::Worker worker_;
  bool again_ = false;  ///< a newer run is waiting to be condensed
  std::shared_ptr<const session::LivePair> pair_;
  session::LiveFrame frame_;
  double frame_s_ = 0.0;
  QElapsedTimer picture_;  ///< since the last picture
  QPushButton *live_, *reset_;
  std::array<QSlider*, 3> slider_{};
  std::array<QLabel*, 3> value_{};
  QLabel *numbers_, *speed_;
};

}  // namespace glisson::panels

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <QElapsedTimer>
#include <QWidget>
#include <array>
#include <memory>

#include "session/live_hand.h"
#include "session/worker.h"

class QComboBox;
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

/// The retractor in the hand: after a run both livers are made ready by a worker; then mouse or sliders move the tool,
/// and surface, vessels and differences follow.
class LiveBar : public QWidget {
  Q_OBJECT
 public:
  LiveBar(session::Session& session, views::SceneView& scene, QWidget* parent = nullptr);
  bool isReady() const { return hand_ != nullptr; }
  /// The frame on screen: empty before the first.
  const session::LiveFrame& frame() const { return frame_ ? *frame_ : none_; }
  /// The tool is where it was asked to be, and both livers are at rest.
  bool isAtRest() const { return hand_ && hand_->atRest(); }
  void setLive(bool live);
  bool isLive() const;
  /// The tool goes there, mm from rest in LPS; kept within the sliders' range.
  void moveTool(const Eigen::Vector3d& displacement_mm);

 signals:
  void ready();  ///< the livers can follow
  void liveChanged(bool live);

 private:
  void build();
  void reset();
  void take();
  void ask(const retraction::LiveTarget& target);
  void show();
  QString numbers() const;
  void tellSpeed();
  void setSliders(const Eigen::Vector3d& displacement_mm);
  void pictureDrawn();
  session::Session& session_;
  views::SceneView& scene_;
  session::Worker worker_;
  bool again_ = false;  ///< a newer run is waiting to be made ready
  std::unique_ptr<session::LiveHand> hand_;
  std::shared_ptr<const session::LiveFrame> frame_;
  session::LiveFrame none_;
  retraction::LiveTarget target_;
  qint64 between_ms_ = 0;  ///< the last two pictures
  QElapsedTimer picture_;  ///< since the last picture
  QPushButton *live_, *reset_;
  QComboBox* comparison_;
  std::array<QSlider*, 3> slider_{};
  std::array<QLabel*, 3> value_{};
  QLabel *numbers_, *speed_;
};

}  // namespace glisson::panels

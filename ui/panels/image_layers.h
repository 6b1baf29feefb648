// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTimer>
#include <QWidget>
#include <array>
#include <memory>

class QLabel;
class QPushButton;

namespace glisson::session {
struct OpenImages;
}
namespace glisson::views {
class SliceView;
}

namespace glisson::panels {

/// What the elastography view shows: stiffness, magnitude, wave or confidence; the wave can be played.
class ImageLayers : public QWidget {
  Q_OBJECT
 public:
  enum class Layer { Stiffness, Magnitude, Wave, Confidence };
  explicit ImageLayers(views::SliceView* view, QWidget* parent = nullptr);
  ~ImageLayers() override;

  void setImages(const session::OpenImages& images);
  void show(Layer layer);
  Layer layer() const { return layer_; }
  void setStiffnessScale(double high_kPa);
  double stiffnessScale() const { return high_kPa_; }
  bool playing() const { return clock_.isActive(); }
  void togglePlay();
  int phase() const { return phase_; }

 private:
  void showWave();
  void setPlaying(bool on);
  views::SliceView* view_;
  std::array<QPushButton*, 4> buttons_{};
  QPushButton* play_;
  QLabel* phaseText_;
  std::unique_ptr<session::OpenImages> images_;
  Layer layer_ = Layer::Stiffness;
  double high_kPa_ = 8.0, waveRange_ = 1.0;
  int phase_ = 0;
  QTimer clock_;
};

}  // namespace glisson::panels

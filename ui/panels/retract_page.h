#pragma once

#include <QTimer>
#include <QWidget>

class QComboBox;
class QDoubleSpinBox;
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

class LiveBar;

/// Retract: the retractor and the abdomen; after a run the moving liver with a play bar, and the retractor in the hand.
class RetractPage : public QWidget {
  Q_OBJECT
 public:
  explicit RetractPage(session::Session& session, QWidget* parent = nullptr);
  views::SceneView* sceneView() const { return scene_; }

 signals:
  void runWanted();

 private:
  QWidget* makeSide();
  QWidget* makePlayBar();
  void take();
  void showParameters();
  void showResult();
  void setPlaying(bool playing);
  session::Session& session_;
  views::SceneView* scene_;
  LiveBar* live_;
  QSlider* time_;
  QPushButton *play_, *run_;
  QLabel *fraction_, *numbers_, *validity_;
  QDoubleSpinBox *diameter_, *length_, *spread_, *force_, *abdomen_;
  QComboBox* forceKind_;
  QTimer clock_;
  bool filling_ = false;
};

}  // namespace glisson::panels

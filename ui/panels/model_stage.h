// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

class QComboBox;
class QLabel;
class QPushButton;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class SceneView;
}

namespace glisson::panels {

/// The model in 3-D as it would be run now: surface with its stiffness, vessels, sites, what holds it, bar and hoist;
/// each can be switched off.
class ModelStage : public QWidget {
  Q_OBJECT
 public:
  explicit ModelStage(session::Session& session, QWidget* parent = nullptr);
  views::SceneView* sceneView() const { return scene_; }

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void show_();
  void takeParts();
  session::Session& session_;
  views::SceneView* scene_;
  QPushButton *surface_, *stiffness_, *vessels_, *sites_, *supports_, *bar_;
  QComboBox* scale_;
  QLabel* words_;
};

}  // namespace glisson::panels

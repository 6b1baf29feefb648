// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTimer>
#include <QWidget>

class QLabel;
class QPushButton;
class QSlider;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class SceneView;
class SliceView;
}  // namespace glisson::views

namespace glisson::panels {

class ContactTable;
class LiveBar;
class PlacementEditor;
class TrustPanel;

/// Retract: bar, hoist and holds laid by hand; after a run the moving liver with a play bar, and the retractor in the
/// hand.
class RetractPage : public QWidget {
  Q_OBJECT
 public:
  explicit RetractPage(session::Session& session, QWidget* parent = nullptr);
  views::SceneView* sceneView() const { return scene_; }

  PlacementEditor* placement() const { return placement_; }

 signals:
  void runWanted();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  QWidget* makeSide();
  QWidget* makePlayBar();
  QWidget* makeModes();
  void showModes();
  void showResult();
  void showOutdated();
  void showDrafts();
  void setPlaying(bool playing);
  void setPlacing(bool placing);
  session::Session& session_;
  views::SceneView* scene_;
  views::SliceView* slice_;
  LiveBar* live_;
  PlacementEditor* placement_;
  QWidget* playBar_;
  QSlider* time_;
  QPushButton *play_, *run_, *place_, *moved_;
  QLabel *fraction_, *notCourse_, *numbers_, *modeWords_, *drafts_;
  ContactTable* contact_;
  TrustPanel* trust_;
  QTimer clock_;
};

}  // namespace glisson::panels

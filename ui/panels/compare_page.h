// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "pipeline/run.h"
#include "render/overlay.h"
#include "session/export_results.h"
#include "session/worker.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;
class QSlider;
class QStackedWidget;
class QTreeWidget;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class PictureView;
class SceneView;
}  // namespace glisson::views

namespace glisson::panels {

class ContactTable;
class TrustPanel;

/// Compare: where MRE and atlas place the same tissue, slice by slice and in 3-D, with the numbers and how far to trust
/// them.
class ComparePage : public QWidget {
  Q_OBJECT
 public:
  explicit ComparePage(session::Session& session, QWidget* parent = nullptr);
  views::PictureView* overlayView() const { return overlay_; }
  views::SceneView* sceneView() const { return scene_; }
  /// Pictures in the palette shown, the report and the record of the run, into a folder, by a worker.
  void exportTo(const QString& folder);
  /// A film of the retraction as the 3-D view shows it, .webm or .mp4, by a worker; ends with exported.
  void filmTo(const QString& file);

 signals:
  void overlayShown(int slice);                     ///< a slice overlay was drawn and is on screen
  void placeChosen(const Eigen::Vector3d& p_lps);   ///< in the list or in 3-D: at rest
  void exported(int files, const QString& reason);  ///< reason: empty where it went well
  void runWanted();

 private:
  QWidget* makeSide();
  void showResult();
  void showNumbers();
  void showVessels();
  void showVessel(int row);
  void markVessels(int chosen);
  void drawSlice();
  bool insetBelow() const;
  void drawCharts();
  void showWhatThereIs();
  QWidget* makeDisplay();
  void linkDisplay();
  QWidget* makeOutdated();
  void askWhereTo();
  void askForVideo();
  QWidget* makeVesselList();
  QString interval() const;
  QString ofVessels() const;
  void showOutdated();
  static QString verdictOf(pipeline::Significance significance);
  render::Palette palette_() const;
  session::Session& session_;
  session::Worker painter_;  ///< draws slice overlays; only the latest wish counts
  session::Worker charter_;
  std::vector<session::VesselPlace> places_;    ///< beyond 5 mm, as listed
  std::optional<session::VesselPlace> vessel_;  ///< chosen: where the inset of the overlay looks
  bool zoomIsBelow_ = false;                    ///< in the picture on screen
  bool wanted_ = false;
  bool chosen_ = false;  ///< else the slice of the largest difference is to be found and shown
  views::PictureView* overlay_;
  views::SceneView* scene_;
  views::PictureView *boxes_, *forces_, *sources_;
  QStackedWidget* beside_;
  QTreeWidget* list_;
  ContactTable* contact_;
  QCheckBox *arrows_, *magnify_;
  QPushButton *export_, *video_ = nullptr;
  QSlider* slice_;
  QLabel *sliceText_, *retractor_, *retractorError_, *verdict_, *numbers_, *vessels_;
  TrustPanel* trust_;
  QWidget* outdated_;  ///< says that the results are not of what is set now, and offers to run again
  QLabel* outdatedText_;
  QPushButton* again_;
  QComboBox *colours_, *view_, *what_, *chart_, *shown_;
};

}  // namespace glisson::panels

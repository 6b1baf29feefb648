// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>

#include "session/placement.h"
#include "tools/model_picture.h"

class QDoubleSpinBox;
class QLabel;
class QPushButton;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class SceneView;
class SliceView;
struct Mark;
}  // namespace glisson::views

namespace glisson::panels {

/// Laying the bar, its hoist and what holds the liver, before a run: handles in the 3-D view and on the slices, one
/// undo step for each drag, places in mm of the patient. The widget is the row of controls below the views.
class PlacementEditor : public QWidget {
  Q_OBJECT
 public:
  PlacementEditor(session::Session& session, views::SceneView& scene, views::SliceView& slice,
                  QWidget* parent = nullptr);
  /// Whether the views show the model with its handles.
  void setActive(bool active);
  bool isActive() const { return active_; }
  /// Ids of the handles.
  enum Handle { contact = 1, barEndA = 2, barEndB = 3, hoist = 4, firstHold = 100 };

 private:
  void show();     ///< the model as it is known
  void refresh();  ///< handles and numbers
  void move(int handle, const Eigen::Vector3d& p_lps, bool ended);
  void addHold(const Eigen::Vector3d& p_lps);
  void removeHold();
  void automatic();
  void resizeHold(double edge_mm);
  std::optional<tools::BarPlace> bar() const;
  session::Session& session_;
  views::SceneView& scene_;
  views::SliceView& slice_;
  bool active_ = false, heldMoved_ = false;
  bool slicePlaced_ = false;  ///< the slice was brought to the bar of this patient
  int chosen_ = contact;
  int held_ = 0;  ///< by the mouse on the slice
  /// While a drag goes on; else what the session has.
  std::optional<session::Placement> moving_;
  double length_mm_ = 80.0;
  QPushButton *add_, *remove_, *automatic_;
  QDoubleSpinBox* edge_;
  QLabel* numbers_;
};

}  // namespace glisson::panels

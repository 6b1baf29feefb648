// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>
#include <memory>
#include <optional>

#include "image/volume.h"
#include "session/worker.h"
#include "views/slice_view.h"

namespace glisson::panels {

/// The two planes across the slices that are drawn on, as reformats of the image: with the cut of what counts, the map
/// laid over it, and a crosshair. Reformats are made by a worker when they are first seen.
class PlaneViews : public QWidget {
  Q_OBJECT
 public:
  explicit PlaneViews(QWidget* parent = nullptr);
  std::array<views::SliceView*, 2> both() const { return views_; }

  void setImage(std::shared_ptr<const image::ScalarVolume> image, double low, double high);  ///< null: none
  void setWindow(double low, double high);
  void setFusion(const views::Fusion& fusion);
  void setRegion(const std::shared_ptr<const image::Mask>& region);
  /// Both planes go through the point and mark it.
  void setCrosshair(const Eigen::Vector3d& p_lps);
  /// Marks a point in both without moving them; none: the crosshair.
  void setCursor(const std::optional<Eigen::Vector3d>& p_lps);

 signals:
  void crosshairMoved(const Eigen::Vector3d& p_lps);  ///< by a click, a drag or the wheel in one of them
  void reformatted();                                 ///< both show the image that was set

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void reformat();
  void follow(views::SliceView* view);
  std::array<views::SliceView*, 2> views_;
  std::shared_ptr<const image::ScalarVolume> image_;
  double low_ = 0.0, high_ = 1.0;
  bool stale_ = false, dragging_ = false;
  std::optional<Eigen::Vector3d> crosshair_;
  session::Worker worker_;
};

}  // namespace glisson::panels

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "image/volume.h"
#include "tools/outline.h"
#include "tools/slice_plane.h"

namespace glisson::tools {

/// What a disc paints on a slice while it is dragged. In the image it keeps to the tissue it was pressed on: of each
/// disc that part counts whose intensities are like those under the press (median of 3 × 3 pixels; the mean follows
/// the shading of coils) and that hangs together with the middle or with what was painted before.
class BrushStroke {
 public:
  /// image: on plane.grid; null: the disc counts as it is. at: plane mm, where the stroke begins.
  BrushStroke(const SlicePlane& plane, std::shared_ptr<const image::ScalarVolume> image, const Eigen::Vector2d& at_mm,
              double radius_mm);

  /// The way of the disc from where it was; plain: the disc as it is, whatever lies under it.
  void dragTo(const Eigen::Vector2d& to_mm, bool plain);
  /// Closed rings (plane mm) around what was painted so far, holes smaller than a quarter of the disc filled;
  /// simplified within tolerance_mm.
  std::vector<Outline> rings(double tolerance_mm) const;

 private:
  double value(int i, int j);
  double valueAt(double i, double j);
  void learn(const Eigen::Vector2d& at_mm);
  void dab(const Eigen::Vector2d& at_mm, bool plain);
  std::size_t cell(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
  }

  std::shared_ptr<const image::ScalarVolume> image_;
  int slice_, fine_, nx_, ny_;  ///< cells of the stroke: fine_ per pixel and axis
  Eigen::Vector2d cell_mm_;
  double radius_mm_;
  Eigen::Vector2d last_mm_;
  std::vector<float> median_;  ///< of pixels, where it was asked for; NaN elsewhere
  std::vector<float> inside_;  ///< of cells: above 0 where painted, in cells from the border about
  int low_[2], high_[2];       ///< box of cells that were touched
  double mean_ = 0.0, tolerance_ = 0.0;
  bool started_ = false;
};

}  // namespace glisson::tools

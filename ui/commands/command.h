// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "commands/outlines.h"

namespace glisson::commands {

/// One undoable act on the contours. apply after revert gives the same contours to the last bit, and the other way
/// round.
class Command {
 public:
  virtual ~Command() = default;
  virtual void apply(Outlines& contours) = 0;
  virtual void revert(Outlines& contours) = 0;
  /// What undo would take back, for the menu: "add outline".
  virtual std::string text() const = 0;
  /// A point (LPS mm) on the slice concerned: undo and redo show that slice.
  virtual Eigen::Vector3d where_lps_mm() const = 0;
};

/// Mean of the polygon's vertices, LPS mm; the origin where it has none.
inline Eigen::Vector3d centreOf(const Eigen::Matrix3Xd& points_lps_mm) {
  if (points_lps_mm.cols() == 0) return Eigen::Vector3d::Zero();
  return points_lps_mm.rowwise().mean();
}

}  // namespace glisson::commands

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "mechanics/contact/contact_tracker.h"
#include "retraction/force_seeker.h"
#include "retraction/live.h"

namespace glisson::retraction {

/// A liver under large deformation that follows a rigid bar in the hand: a bounded number of Newton steps a frame. The
/// bar moves by at most 2 mm a frame, and arrives later where the hand is faster.
class ContactRetraction : public LiveRetraction {
 public:
  /// bar: with place and axis.
  ContactRetraction(const Model& model, const Setup& setup, const Retractor& bar,
                    const std::vector<Eigen::Vector3d>& points_mm, const Progress& progress = {});

  LiveAnswer follow(const LiveTarget& target) override;
  void displacements(Eigen::Matrix3Xd& u_mm) const override;

 private:
  std::optional<mechanics::ContactTracker> tracker_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< of the grid, LPS
  Eigen::Vector3d hoist_;                               ///< unit, LPS
  ForceSeeker seeker_;                                  ///< where a force leads the bar
  ForceSeeker::Seen seen_;                              ///< bar and liver after the last frame
};

}  // namespace glisson::retraction

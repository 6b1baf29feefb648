#pragma once

#include <optional>

#include "mechanics/contact/contact_tracker.h"
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
  double alongFor(double force_N);

  std::optional<mechanics::ContactTracker> tracker_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< of the grid, LPS
  Eigen::Vector3d hoist_;          ///< unit, LPS
  double along_mm_ = 0.0;          ///< of the bar, along the hoist
  double forceAlong_N_ = 0.0;      ///< of the bar on the liver
  double remaining_mm_ = 0.0;      ///< estimated distance from equilibrium
  double seenAt_mm_ = 0.0, seen_N_ = 0.0;  ///< travel and force of the last frame near equilibrium
  double stiffness_N_mm_ = 0.0;    ///< rise of the force with travel between the last two of them
  double best_N_ = 0.0, bestAt_mm_ = 0.0;  ///< largest force on the way to the one that is asked for, and where
  bool slips_ = false;
};

}  // namespace glisson::retraction

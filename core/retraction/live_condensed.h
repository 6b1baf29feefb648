// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "retraction/live.h"

namespace glisson::retraction {

/// The full voxel model condensed to the three directions of the tool's contact and to the points that are watched.
/// Made once (one solve per direction, and one for all other loads together); then an answer is one small product, far
/// below a video frame, and at rest at once. Linear: strains as in the scene's own validity. The tool is the scene's
/// retractor as a patch; its contact stays where it is on the liver.
class CondensedRetraction : public LiveRetraction {
 public:
  /// everyNode: the nodes of the mesh are watched as well, behind the points.
  CondensedRetraction(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& points_mm,
                      bool everyNode, const Progress& progress = {});

  /// Rest positions of the nodes, LPS; empty unless everyNode.
  const std::vector<Eigen::Vector3d>& nodes_mm() const { return nodes_mm_; }

  /// What the tool has to pull with, N in LPS, so that its contact moves by this much (mean over the contact), mm.
  Eigen::Vector3d forceFor(const Eigen::Vector3d& toolDisplacement_mm) const;
  /// How the contact moves under a force of the tool, mm.
  Eigen::Vector3d toolDisplacement_mm(const Eigen::Vector3d& force_N) const;
  /// Displacement, mm in LPS, of the points and then of the nodes, under a tool force.
  void evaluate(const Eigen::Vector3d& force_N, Eigen::Matrix3Xd& u_mm) const;

  LiveAnswer follow(const LiveTarget& target) override;
  void displacements(Eigen::Matrix3Xd& u_mm) const override { evaluate(force_N_, u_mm); }

 private:
  std::vector<Eigen::Vector3d> nodes_mm_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> response_mm_N_;  ///< 3 × watched rows, per N along L, P, S
  Eigen::VectorXd constant_mm_;                             ///< of all other loads
  Eigen::Matrix3d compliance_mm_N_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d toolConstant_mm_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_N_ = Eigen::Vector3d::Zero();  ///< of the last frame
};

}  // namespace glisson::retraction

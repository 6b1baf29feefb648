#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/progress.h"
#include "retraction/simulate.h"

namespace glisson::retraction {

/// A retraction that follows the tool: the full voxel model condensed to the three directions of the tool's contact and
/// to the points that are watched. Made once (one solve per direction, and one for all other loads together); then an
/// answer is one small product, far below a video frame. Linear: strains as in the scene's own validity.
class LiveRetraction {
 public:
  /// The tool is the scene's retractor; its contact stays where it is on the liver. points_mm: watched points, LPS; one
  /// outside the body moves with the nearest node. everyNode: the nodes of the mesh are watched as well.
  /// Throws BadInput (no retractor in the scene, prescribed displacements, what toMechanics refuses), SolverFailed,
  /// Cancelled.
  LiveRetraction(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& points_mm, bool everyNode,
                 const Progress& progress = {});

  const Eigen::Vector3d& toolPoint_mm() const { return toolPoint_mm_; }  ///< of the contact at rest, LPS
  /// Rest positions of the nodes, LPS; empty unless everyNode.
  const std::vector<Eigen::Vector3d>& nodes_mm() const { return nodes_mm_; }
  int points() const { return points_; }

  /// What the tool has to pull with, N in LPS, so that its contact moves by this much (mean over the contact), mm.
  Eigen::Vector3d forceFor(const Eigen::Vector3d& toolDisplacement_mm) const;
  /// How the contact moves under a force of the tool, mm.
  Eigen::Vector3d toolDisplacement_mm(const Eigen::Vector3d& force_N) const;
  /// The force of the scene itself: size and direction of the hoist.
  const Eigen::Vector3d& sceneForce_N() const { return sceneForce_N_; }

  /// Displacement, mm in LPS, of the points and then of the nodes, under a tool force; 3 × (points + nodes). Nothing is
  /// allocated where `u_mm` has that size already.
  void evaluate(const Eigen::Vector3d& force_N, Eigen::Matrix3Xd& u_mm) const;

 private:
  Eigen::Vector3d toolPoint_mm_ = Eigen::Vector3d::Zero(), sceneForce_N_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> nodes_mm_;
  int points_ = 0;
  Eigen::Matrix<double, Eigen::Dynamic, 3> response_mm_N_;  ///< 3 × watched rows, per N along L, P, S
  Eigen::VectorXd constant_mm_;                             ///< of all other loads
  Eigen::Matrix3d compliance_mm_N_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d toolConstant_mm_ = Eigen::Vector3d::Zero();
};

}  // namespace glisson::retraction

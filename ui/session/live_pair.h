// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "render/overlay.h"
#include "retraction/live.h"
#include "retraction/rigid_contact.h"

namespace glisson::session {

/// What both livers share while the tool is moved: the force of the tool, as a run compares, or its way, as a surgeon
/// sets it.
enum class LiveComparison { EqualForce, EqualTravel };

/// One moment of a retraction that follows the tool.
struct LiveFrame {
  Eigen::Matrix3Xd mre_mm, atlas_mm;  ///< displacement, LPS: vertices of the liver, of the vessels, then landmarks
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();       ///< of the tool with measured stiffness
  Eigen::Vector3d forceAtlas_N = Eigen::Vector3d::Zero();  ///< and with the atlas
  Eigen::Vector3d toolMre_mm = Eigen::Vector3d::Zero();    ///< how the tool has moved with measured stiffness
  Eigen::Vector3d toolAtlas_mm = Eigen::Vector3d::Zero();  ///< and with the atlas
  double atTool_mm = 0.0;                                  ///< between the two tools
  double vesselMean_mm = 0.0, vesselMax_mm = 0.0;          ///< over the landmarks, 0 where there are none
  int vesselsBeyond = 0;                                   ///< landmarks at or beyond what matters clinically
  double remaining_mm = 0.0;  ///< estimated largest distance of either liver from its equilibrium
  bool atRest = true;         ///< the hand's place is reached, and further frames change nothing
  retraction::LiveOutcome mre = retraction::LiveOutcome::Borne, atlas = retraction::LiveOutcome::Borne;
  double seconds = 0.0;  ///< that the frame took
};

/// The same liver with measured and with atlas stiffness, both following the tool frame by frame: in contact with a
/// rigid bar where the run was, else linear and condensed to the tool.
class LivePair {
 public:
  /// scene: file of the run; bar: where the run placed it, or nothing; picture: its surfaces; landmarks_mm: its vessel
  /// centrelines, LPS. Throws BadInput (no comparison, no retractor), SolverFailed, Cancelled.
  LivePair(const std::filesystem::path& scene, const std::optional<retraction::PlacedBar>& bar,
           const render::RetractionScene& picture, const std::vector<Eigen::Vector3d>& landmarks_mm,
           const Progress& progress = {});

  /// One frame towards what the hand asks of the liver with measured stiffness; the other one is given the same force,
  /// or the same way.
  void follow(const retraction::LiveTarget& hand, LiveComparison comparison, LiveFrame& frame);
  /// What the run itself asked of the tool: its force, or its travel.
  const retraction::LiveTarget& sceneTarget() const { return livers_.mre->sceneTarget(); }
  /// The force of the run; where it was given its travel, of its hoist only the direction counts.
  const Eigen::Vector3d& sceneForce_N() const { return livers_.mre->sceneForce_N(); }
  const Eigen::Vector3d& toolPoint_mm() const { return livers_.mre->toolPoint_mm(); }  ///< at rest, LPS
  retraction::LiveKind kind() const { return livers_.kind; }
  int dofs() const { return livers_.mre->dofs(); }
  Eigen::Index liverVertices() const { return liver_; }
  Eigen::Index vesselVertices() const { return vessels_; }

 private:
  void compare(LiveFrame& frame) const;
  retraction::LiveLivers livers_;
  retraction::LiveAnswer last_;  ///< of the liver with measured stiffness
  Eigen::Index liver_ = 0, vessels_ = 0;
  double significant_mm_ = 5.0;
};

}  // namespace glisson::session

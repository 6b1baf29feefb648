// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "retraction/simulate.h"

namespace glisson::retraction {

/// What the hand asks of the tool.
struct LiveTarget {
  Eigen::Vector3d tool_mm = Eigen::Vector3d::Zero();  ///< displacement of the tool from rest, LPS
  /// The tool pulls with this, N in LPS, and goes where that leads; a rigid bar keeps its place across the hoist.
  std::optional<Eigen::Vector3d> force_N;
};

/// How the liver bears the tool.
enum class LiveOutcome {
  Borne,
  Slips,  ///< it does not bear the force asked for
  Cuts    ///< the bar cuts into it: the state is no answer
};

/// Where the tool is after a frame, and how far the liver is from rest.
struct LiveAnswer {
  Eigen::Vector3d tool_mm = Eigen::Vector3d::Zero();  ///< reached, from rest, LPS
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< of the tool on the liver, LPS
  double remaining_mm = 0.0;  ///< of the solver: estimated largest distance from the equilibrium of these very cells
  bool atRest = true;         ///< what was asked for is reached: further frames change nothing
  LiveOutcome outcome = LiveOutcome::Borne;
};

/// A liver that follows the tool, frame by frame.
class LiveRetraction {
 public:
  virtual ~LiveRetraction() = default;

  const Eigen::Vector3d& toolPoint_mm() const { return toolPoint_mm_; }  ///< of the contact at rest, LPS
  /// The force of the scene itself: size and direction of the hoist. Where the scene gives the bar its travel: the
  /// liver's weight under contact, else the force that the travel takes.
  const Eigen::Vector3d& sceneForce_N() const { return sceneForce_N_; }
  /// What the scene itself asks of the tool: its force, or its travel.
  const LiveTarget& sceneTarget() const { return sceneTarget_; }
  int points() const { return points_; }
  int dofs() const { return dofs_; }
  double cell_mm() const { return cell_mm_; }  ///< longest edge of the cells that are followed

  /// One frame towards the target.
  virtual LiveAnswer follow(const LiveTarget& target) = 0;
  /// Displacement of the watched points now, mm in LPS; 3 × points. Nothing is allocated where `u_mm` has that size.
  virtual void displacements(Eigen::Matrix3Xd& u_mm) const = 0;

 protected:
  Eigen::Vector3d toolPoint_mm_ = Eigen::Vector3d::Zero(), sceneForce_N_ = Eigen::Vector3d::Zero();
  LiveTarget sceneTarget_;
  int points_ = 0, dofs_ = 0;
  double cell_mm_ = 0.0;
};

/// How a liver follows. Contact: a rigid bar under large deformation on coarse cells, some milliseconds a frame.
/// Condensed: a linear patch of pressure, condensed to the watched points; microseconds, for thousands of them.
enum class LiveKind { Contact, Condensed };

/// Contact where the scene's retractor is a rigid bar, else condensed.
LiveKind liveKindOf(const Setup& setup);

/// The livers with both stiffnesses; atlas is null where there is no second one.
struct LiveLivers {
  std::unique_ptr<LiveRetraction> mre, atlas;
  LiveKind kind = LiveKind::Condensed;
};

/// points_mm: watched points, LPS; one outside the body moves with what is nearest. A bar without a place is placed as
/// for a run. Throws BadInput (no retractor in the scene, prescribed displacements with a patch, what the model
/// refuses), SolverFailed, Cancelled.
LiveLivers makeLive(const Model& model, const Model* atlas, const Setup& setup,
                    const std::vector<Eigen::Vector3d>& points_mm, LiveKind kind, const Progress& progress = {});

/// A frame of both livers.
struct LiveAnswers {
  LiveAnswer mre, atlas;
};
/// One frame of both, side by side where a frame takes long.
LiveAnswers followBoth(const LiveLivers& livers, const LiveTarget& mre, const LiveTarget& atlas);

/// Frames towards what the scene itself asks of the tool, until both livers are at rest there or `frames` are spent.
LiveAnswers followScene(const LiveLivers& livers, int frames, const Progress& progress = {});

}  // namespace glisson::retraction

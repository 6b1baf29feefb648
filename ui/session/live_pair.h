#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "render/overlay.h"
#include "retraction/live.h"

namespace glisson::session {

/// One moment of a retraction that follows the tool.
struct LiveFrame {
  Eigen::Matrix3Xd mre_mm, atlas_mm;  ///< displacement, LPS: vertices of the liver, of the vessels, then landmarks
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();       ///< of the tool, the same for both
  Eigen::Vector3d toolMre_mm = Eigen::Vector3d::Zero();    ///< how the contact moves with measured stiffness
  Eigen::Vector3d toolAtlas_mm = Eigen::Vector3d::Zero();  ///< and with the atlas
  double atTool_mm = 0.0;                                  ///< between the two
  double vesselMean_mm = 0.0, vesselMax_mm = 0.0;          ///< over the landmarks, 0 where there are none
  int vesselsBeyond = 0;                                   ///< landmarks at or beyond what matters clinically
};

/// The same liver with measured and with atlas stiffness, both condensed to the tool. What is drawn and what is
/// compared follow the tool by two small products. Linear, voxel finite elements, whatever the run itself used.
class LivePair {
 public:
  /// scene: file of the run; picture: its surfaces; landmarks_mm: its vessel centrelines, LPS. Throws BadInput (no
  /// comparison, no retractor), SolverFailed, Cancelled.
  LivePair(const std::filesystem::path& scene, const render::RetractionScene& picture,
           const std::vector<Eigen::Vector3d>& landmarks_mm, const Progress& progress = {});

  /// The contact under the measured stiffness is moved by this much, mm in LPS; the atlas gets the same force.
  void followTool(const Eigen::Vector3d& displacement_mm, LiveFrame& frame) const;
  /// Both under one force, N in LPS.
  void followForce(const Eigen::Vector3d& force_N, LiveFrame& frame) const;
  /// What the run itself pulled with.
  const Eigen::Vector3d& sceneForce_N() const { return mre_.sceneForce_N(); }
  const Eigen::Vector3d& toolPoint_mm() const { return mre_.toolPoint_mm(); }  ///< at rest, LPS
  Eigen::Index liverVertices() const { return liver_; }
  Eigen::Index vesselVertices() const { return vessels_; }

 private:
  struct Parts;
  explicit LivePair(const Parts& parts, const Progress& progress);
  static Parts partsOf(const std::filesystem::path& scene, const render::RetractionScene& picture,
                       const std::vector<Eigen::Vector3d>& landmarks_mm, const Progress& progress);
  Eigen::Index liver_ = 0, vessels_ = 0;
  double significant_mm_ = 5.0;
  retraction::LiveRetraction mre_, atlas_;
};

}  // namespace glisson::session

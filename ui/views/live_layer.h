// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>

#include "render/overlay.h"

class vtkRenderer;

namespace glisson::views {

/// The surfaces of a retraction that follows the tool: liver and vessels in both colours, and the bar. Only points and
/// colours change from frame to frame.
class LiveLayer {
 public:
  LiveLayer(const render::RetractionScene& scene, render::Palette palette);
  ~LiveLayer();

  void addTo(vtkRenderer* renderer);
  void setPalette(render::Palette palette);
  /// Displacements, mm in LPS: vertices of the liver, then of the vessels, in the order of the scene; further columns
  /// are not looked at. tool_mm, atlasTool_mm: how the bar moves with either stiffness; the second bar is drawn in the
  /// colour of the atlas where it lies elsewhere.
  void move(const Eigen::Matrix3Xd& mre_mm, const Eigen::Matrix3Xd& atlas_mm, const Eigen::Vector3d& tool_mm,
            const Eigen::Vector3d& atlasTool_mm);
  /// Where the contact is now, LPS.
  const Eigen::Vector3d& tool_lps() const { return tool_lps_; }

 private:
  struct Private;
  std::unique_ptr<Private> d_;
  Eigen::Vector3d rest_lps_ = Eigen::Vector3d::Zero(), tool_lps_ = Eigen::Vector3d::Zero();
};

}  // namespace glisson::views

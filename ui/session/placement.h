// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "retraction/setup.h"

namespace glisson::session {

/// What is laid by hand before a run, in the patient's own space: LPS, mm.
struct Placement {
  /// A block whose nodes are held: the vena cava, the falciform ligament.
  struct Hold {
    Eigen::Vector3d centre_lps = Eigen::Vector3d::Zero();
    double edge_mm = 20.0;
    bool operator==(const Hold&) const = default;
  };
  std::optional<Eigen::Vector3d> barAt_lps;        ///< contact of the bar; empty: under the inferior right lobe
  Eigen::Vector3d barAxis{1.0, 0.0, 0.0};          ///< unit
  Eigen::Vector3d hoistDirection{0.0, -1.0, 0.0};  ///< unit, where the hoist pulls to
  std::vector<Hold> holds;

  bool operator==(const Placement& other) const;
};

/// Length of the bar that may be set, mm.
inline constexpr double leastBar_mm = 20.0, mostBar_mm = 200.0;
/// The sine of the angle between bar and hoist is kept above this; a scene refuses less than 0.1.
inline constexpr double leastCross = 0.2;

/// Puts what was placed into a scene's loads and supports.
void apply(const Placement& placement, retraction::Setup& setup);

}  // namespace glisson::session

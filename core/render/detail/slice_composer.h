// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "anatomy/triangle_mesh.h"
#include "render/overlay.h"
#include "render/sampling.h"
#include "render/slice_plane.h"

namespace glisson::render::detail {

/// Grey window from percentiles of the liver, widened for its surroundings.
struct Window {
  float low = 0.0F, high = 1.0F;
  float operator()(float v) const { return std::clamp((v - low) / (high - low), 0.0F, 1.0F); }
};

/// One simulated state of the scene, ready to be looked up at any point of the moved patient.
struct MovedState {
  image::DisplacementField u_mm;  ///< carried on beyond the liver
  InverseMap inverse;
  std::optional<anatomy::TriangleMesh> surface;  ///< of the liver in contact with a bar, moved
  std::optional<anatomy::TriangleMesh> bar;      ///< where it ends
  MovedState(image::DisplacementField carriedOn, const image::ScalarVolume& liver, const RetractionScene& scene,
             bool atlas);
  MovedState(const MovedState&) = delete;
  MovedState& operator=(const MovedState&) = delete;
};

/// The image of a slice as both answers move it, each in its channel, with the grid, outlines, vessels and the bar.
class SliceComposer {
 public:
  /// The scene outlives it. Throws BadInput where liver and MRI do not overlap.
  explicit SliceComposer(const RetractionScene& scene);

  Picture draw(const SlicePlane& plane, const SliceOverlayOptions& options) const;

  /// Pixel box of the liver at rest and in both moved states.
  std::pair<Eigen::Vector2d, Eigen::Vector2d> liverBox(const SlicePlane& plane) const;

  bool showsBar(const SlicePlane& plane) const;

  /// Largest ‖u_mre − u_atlas‖ of the tissue that lies in the slice as it is drawn, with the own stiffness, mm; of one
  /// answer the largest ‖u‖.
  double largestSeen_mm(int k) const;

 private:
  /// Brightness 0..1 of one channel: windowed liver, dimmed surroundings, outline of the liver and the vessels. The
  /// liver is what lies within its surface in contact where there is one, else what the mask's cells hold.
  std::vector<float> channel(const SlicePlane& plane, const MovedState& state, bool outlines) const;

  /// Where the moved vessel walls cross the plane.
  void vesselCut(const SlicePlane& plane, const MovedState& state, std::vector<float>& out) const;

  const RetractionScene& scene_;
  image::ScalarVolume liver_;
  Window window_;
  std::array<image::DisplacementField, 2> fields_;  ///< on their way into the states
  MovedState mre_, atlas_;
};

}  // namespace glisson::render::detail

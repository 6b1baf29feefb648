// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mechanics/contact/triangle_surface.h"
#include "retraction/setup.h"
#include "retraction/smooth_body.h"

namespace glisson::retraction {

/// Where a rigid bar first touches the liver, coming from far behind along the hoist.
struct Pose {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< middle of the bar's axis at first touch, LPS
  Eigen::Vector3d axis{1, 0, 0};                        ///< of the bar: unit, LPS, perpendicular to the hoist
  Eigen::Vector3d hoist{0, -1, 0};                      ///< unit, LPS
  double height_mm = 0.0;     ///< of the bar's axis above the lowest point of the right lobe, across the hoist
  double covered_mm = 0.0;    ///< length of the bar with liver before it, seen along the hoist
  double thickness_mm = 0.0;  ///< of that liver along the hoist, mean over what is covered
  double slope = 0.0;         ///< of the surface under the bar, along its axis: mm along the hoist per mm
  bool wanted = true;         ///< covered, thick and level as the rule wants; false: the nearest to it that there is
};

/// What the rule asks of a place. Lengths in mm.
struct PoseRule {
  double covered_mm = 60.0;      ///< of the bar: three quarters of its length
  double thickness_mm = 75.0;    ///< less for livers below 1.55 L, in proportion to their volume; half at least
  double slope = 0.1;            ///< at most
  double lowest_mm, highest_mm;  ///< heights tried, every 5 mm
  Eigen::Vector3d inferior_mm;   ///< lowest point of the right lobe, LPS
};

/// The rule for this body and retractor.
PoseRule poseRule(const SmoothBody& body, const Retractor& retractor);

/// Places for the bar on the lower right lobe from geometry alone, in the order in which they are to be tried. At every
/// height, from 70 mm above the lowest point in steps of 5 mm to 63 mm below the top of the right lobe (where the lobe
/// is lower than 180 mm, less of both in proportion), the bar is slid sideways from where its lateral end lies at the
/// lateral margin to where the surface under it is level. Places that are covered, thick and level as wanted come
/// first, the lowest first; where the scene gives no axis and there is none, the bar is also turned, by up to 30
/// degrees. Then those that fall short, the nearest to what is wanted first. surface: of the body
/// (SmoothBody::surface). Depends on the body alone. Throws BadInput with the figures of the best place where none
/// comes near (half of the length and thickness wanted, three times the slope).
std::vector<Pose> poseCandidates(const SmoothBody& body, const mechanics::TriangleSurface& surface_lps_mm,
                                 const Retractor& retractor);

/// The bar at a point that the scene gives: through it across the hoist, along the scene's axis (its part across the
/// hoist); where the scene gives none, across the hoist from right to left, turned by at most 30 degrees towards where
/// the surface under the bar is level. Throws BadInput ("no contact") where the point is further than the bar's
/// diameter and 5 mm from a surface that looks against the hoist. Its height is above the lowest point of the surface.
Pose poseAt(const mechanics::TriangleSurface& surface_lps_mm, const Retractor& retractor, const Eigen::Vector3d& at_mm);

}  // namespace glisson::retraction

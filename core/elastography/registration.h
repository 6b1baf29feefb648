// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "base/progress.h"
#include "image/volume.h"

namespace glisson::elastography {

/// What the correction for another breath-hold may do.
enum class Motion {
  Auto,     ///< InPlane for fewer than six slices, else Rigid
  InPlane,  ///< translation within the slices of the moving image
  Rigid     ///< rotation and translation
};

/// How far, and by what motion, one image may be laid over another.
struct RegistrationOptions {
  Motion motion = Motion::Auto;
  double largest_mm = 30.0;   ///< translations beyond are not looked for
  double largest_deg = 15.0;  ///< the same for rotations
  int samples = 40000;        ///< points of the moving image, drawn once
  std::uint64_t seed = 1;
};

/// A rigid motion that lays one image over another, to be shown and to be undone.
struct Registration {
  Eigen::Isometry3d X_fixed_moving = Eigen::Isometry3d::Identity();  ///< p_fixed = X_fixed_moving * p_moving, LPS mm
  double similarityBefore = 0.0;  ///< normalised mutual information (H_f + H_m) / H_fm, 1 (none) ... 2 (the same)
  double similarityAfter = 0.0;
  double shift_mm = 0.0;  ///< how far the middle of the moving image goes
  double rotation_deg = 0.0;
  Motion motion = Motion::Rigid;  ///< as used
  bool improved = false;          ///< false: nothing better was found, X is the identity
};

/// Finds the motion of greatest normalised mutual information [studholme1999] by a pattern search from 8 to 0.05 mm
/// [hooke1961]: the images may differ in contrast. Same bits with any number of threads. Throws BadInput where the
/// images do not overlap, or one is constant there.
Registration registerRigid(const image::ScalarVolume& fixed, const image::ScalarVolume& moving,
                           const RegistrationOptions& options = {}, const Progress& progress = {});

/// The grid after the motion: voxel values stay, their places move. moved(moved(g, X), X⁻¹) is g.
image::Grid moved(const image::Grid& grid, const Eigen::Isometry3d& X);

/// One sentence for the user: motion, millimetres and degrees, similarity before and after.
std::string describe(const Registration& registration);

}  // namespace glisson::elastography

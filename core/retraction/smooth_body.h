// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <optional>

#include "image/volume.h"
#include "mechanics/contact/triangle_surface.h"

namespace glisson::retraction {

/// The smooth body behind a mask: the mask, linear between its voxel centres, smoothed by a Gaussian of 2 mm along
/// every axis, on cubes of 1.5 mm along the mask's axes. The body is where the field exceeds a level, near 1/2, chosen
/// so that the body has the volume of the mask. It depends on the mask alone, never on the cells that a model is made
/// of. Only the largest piece is kept; the rest is left out of the field. The same bits with any number of threads.
class SmoothBody {
 public:
  static constexpr double sigma_mm = 2.0;
  static constexpr double cube_mm = 1.5;

  /// Throws BadInput where the mask is empty, or so small that nothing of it is left after smoothing.
  explicit SmoothBody(const image::Mask& mask);

  /// The field at a point in mm (LPS): 0 outside to 1 deep inside, trilinear between the cubes' corners.
  double value(const Eigen::Vector3d& p_lps_mm) const;
  /// Gradient of the field, 1/mm, LPS; points inwards. Central differences over two cubes: continuous.
  Eigen::Vector3d gradient(const Eigen::Vector3d& p_lps_mm) const;
  /// The body is where value() > level().
  double level() const { return level_; }
  bool inside(const Eigen::Vector3d& p_lps_mm) const { return value(p_lps_mm) > level_; }

  /// The body on the field's own cubes.
  image::Mask mask() const;

  double volume_mm3() const { return volume_mm3_; }        ///< of the body: of the mask less leftOut_mm3
  double leftOut_mm3() const { return leftOut_mm3_; }      ///< of the pieces that were left out, about
  const image::Grid& grid() const { return field_.grid; }  ///< of the field; its axes are the mask's

  /// Covered fraction of every cell, 0 to 1, by 4 x 4 x 4 points in each. Where the body reaches beyond the grid, the
  /// result's grid is larger by as many layers of cells on every side as the body needs. Any axes and spacing. Kept for
  /// the last grid: several solves of one model ask for the same.
  image::ScalarVolume fractions(const image::Grid& cells) const;

  /// Closed surface of the body, outward oriented, vertices in mm (LPS), by marching tetrahedra on the field's cubes;
  /// walls of cavities are left out. No triangle is degenerate. Made once, when it is first asked for.
  const mechanics::TriangleSurface& surface() const;
  /// The same on cubes of another edge. Throws BadArgument where the spacing is not positive.
  mechanics::TriangleSurface surface(double spacing_mm) const;

 private:
  /// What is made when first asked for, by any thread; copies of the body share it.
  struct Made {
    std::mutex lock;
    std::optional<mechanics::TriangleSurface> surface;
    image::Grid cells;
    image::ScalarVolume fractions;  ///< of these cells; empty at first
  };

  image::ScalarVolume field_;
  std::shared_ptr<Made> made_ = std::make_shared<Made>();
  double level_ = 0.5;
  double volume_mm3_ = 0.0;
  double leftOut_mm3_ = 0.0;
};

}  // namespace glisson::retraction

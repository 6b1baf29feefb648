// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "anatomy/triangle_mesh.h"

namespace glisson::tools {

/// From where a 3-D view looks, in parallel projection: a millimetre is the same everywhere in the picture.
/// Pixels are logical ones of the view, from its upper left corner; view_px is the view's width and height.
struct SceneCamera {
  Eigen::Vector3d focus_lps = Eigen::Vector3d::Zero();  ///< shown in the middle
  Eigen::Vector3d fromEye = Eigen::Vector3d::UnitY();   ///< unit, into the picture
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();        ///< unit, of the screen, across fromEye
  double halfHeight_mm = 150.0;                         ///< of the view
  double distance_mm = 1000.0;                          ///< of the eye from the focus

  Eigen::Vector3d right() const { return fromEye.cross(up); }
  double px_per_mm(const Eigen::Vector2d& view_px) const { return 0.5 * view_px.y() / halfHeight_mm; }
  Eigen::Vector2d toPixel(const Eigen::Vector3d& p_lps, const Eigen::Vector2d& view_px) const;
  /// How far behind the focus a point lies, mm.
  double depth_mm(const Eigen::Vector3d& p_lps) const { return fromEye.dot(p_lps - focus_lps); }
  /// The point seen there, in the plane across the view through `through_lps`.
  Eigen::Vector3d toLps(const Eigen::Vector2d& p_px, const Eigen::Vector2d& view_px,
                        const Eigen::Vector3d& through_lps) const;

  /// As if the scene were a ball under the mouse.
  void turn(const Eigen::Vector2d& by_px, const Eigen::Vector2d& view_px);
  /// The scene follows the mouse.
  void pan(const Eigen::Vector2d& by_px, const Eigen::Vector2d& view_px);
  /// factor > 1 magnifies; what is at `at_px` stays there.
  void zoom(double factor, const Eigen::Vector2d& at_px, const Eigen::Vector2d& view_px);
  /// So that the box fills the view, with a margin; seen from where it is seen now.
  void fit(const Eigen::AlignedBox3d& box_lps, const Eigen::Vector2d& view_px);

  bool operator==(const SceneCamera&) const = default;
};

/// Where a straight line from `from` along `along` first meets the surface in front of it. against: only where the
/// surface (oriented outwards) looks against this direction, as a bar bears that pulls along it.
std::optional<Eigen::Vector3d> firstHit(const anatomy::TriangleMesh& mesh, const Eigen::Vector3d& from_lps,
                                        const Eigen::Vector3d& along,
                                        const std::optional<Eigen::Vector3d>& against = std::nullopt);

/// The vertex nearest to a point, of those triangles that look against a direction; nothing where there is none.
std::optional<Eigen::Vector3d> nearestVertex(const anatomy::TriangleMesh& mesh, const Eigen::Vector3d& p_lps,
                                             const std::optional<Eigen::Vector3d>& against = std::nullopt);

}  // namespace glisson::tools

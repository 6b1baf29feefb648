// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/detail/viewpoint.h"

namespace glisson::render {
namespace {

/// The eye's place on a sphere: azimuth 0 is anterior and grows towards the patient's left, elevation 90 is superior.
Camera3D cameraOf(View3D view) {
  switch (view) {
    case View3D::Anterior: return {0, 0};
    case View3D::Posterior: return {180, 0};
    case View3D::Left: return {90, 0};
    case View3D::Right: return {-90, 0};
    case View3D::Superior: return {0, 90};
    case View3D::Inferior: return {0, -90};
    case View3D::Oblique: break;
  }
  return {-30.5, 20};
}

}  // namespace

Viewpoint viewpointOf(const SceneOptions3D& options) {
  const Camera3D c = options.camera.value_or(cameraOf(options.view));
  if (!std::isfinite(c.azimuth_deg) || !(std::abs(c.elevation_deg) <= 90.0))
    throw BadArgument("a camera at azimuth " + std::to_string(c.azimuth_deg) + " and elevation " +
                      std::to_string(c.elevation_deg) + " degrees is not usable: elevation lies in -90..90");
  const double radian = 3.14159265358979323846 / 180.0;
  const double a = radian * c.azimuth_deg, e = radian * c.elevation_deg;
  // LPS: x to the patient's left, y to posterior, z to superior.
  const Eigen::Vector3d eye(std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e));
  Viewpoint v;
  v.fromEye = -eye;
  // Straight from above or below there is no superior on the screen: anterior is up, as in axial slices.
  const bool axial = std::abs(c.elevation_deg) > 89.0;
  const Eigen::Vector3d wanted = axial ? Eigen::Vector3d(-Eigen::Vector3d::UnitY()) : Eigen::Vector3d::UnitZ();
  v.right = v.fromEye.cross(wanted).normalized();
  v.up = v.right.cross(v.fromEye);
  std::vector<int> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](int p, int q) { return std::abs(v.fromEye[p]) > std::abs(v.fromEye[q]) + 1e-9; });
  for (const int axis : axes)
    // A wall seen nearly edge-on is a smear of lines; the first faces the eye, the floor gives depth.
    if (v.walls.empty() || (axis == 2 && std::abs(v.fromEye[2]) > 0.15))
      v.walls.emplace_back(axis, v.fromEye[axis] > 0);
  return v;
}

std::vector<LabelledEdge> labelledEdges(const Viewpoint& view, const Eigen::AlignedBox3d& box) {
  std::vector<LabelledEdge> edges;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(view.fromEye[axis]) > 0.95) continue;  // end-on
    const bool across = std::abs(view.right[axis]) >= std::abs(view.up[axis]);
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    double best = 0.0;
    LabelledEdge chosen;
    bool found = false;
    for (int corner = 0; corner < 4; ++corner) {
      const bool upperB = corner & 1, upperC = corner & 2;
      const bool onWall = std::any_of(view.walls.begin(), view.walls.end(), [&](const auto& wall) {
        return (wall.first == b && wall.second == upperB) || (wall.first == c && wall.second == upperC);
      });
      if (!onWall) continue;
      Eigen::Vector3d middle = box.center();
      middle[b] = upperB ? box.max()[b] : box.min()[b];
      middle[c] = upperC ? box.max()[c] : box.min()[c];
      const double score = across ? middle.dot(view.up) : middle.dot(view.right);
      if (found && score >= best - 1e-9) continue;
      found = true;
      best = score;
      chosen.axis = axis;
      chosen.low = middle;
      chosen.low[axis] = box.min()[axis];
      chosen.outward = across ? Eigen::Vector3d(-view.up) : Eigen::Vector3d(-view.right);
    }
    if (found) edges.push_back(chosen);
  }
  return edges;
}

}  // namespace glisson::render

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/scene_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson::tools {

Eigen::Vector2d SceneCamera::toPixel(const Eigen::Vector3d& p_lps, const Eigen::Vector2d& view_px) const {
  const Eigen::Vector3d d = p_lps - focus_lps;
  const double scale = px_per_mm(view_px);
  return 0.5 * view_px + scale * Eigen::Vector2d(right().dot(d), -up.dot(d));
}

Eigen::Vector3d SceneCamera::toLps(const Eigen::Vector2d& p_px, const Eigen::Vector2d& view_px,
                                   const Eigen::Vector3d& through_lps) const {
  const Eigen::Vector2d off_mm = (p_px - 0.5 * view_px) / px_per_mm(view_px);
  return focus_lps + off_mm.x() * right() - off_mm.y() * up + depth_mm(through_lps) * fromEye;
}

void SceneCamera::turn(const Eigen::Vector2d& by_px, const Eigen::Vector2d& view_px) {
  // Across the whole view is half a turn.
  const double radian = 3.14159265358979323846 / std::max(view_px.minCoeff(), 1.0);
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(-radian * by_px.x(), up) * Eigen::AngleAxisd(-radian * by_px.y(), right());
  fromEye = (q * fromEye).normalized();
  up = q * up;
  up = (up - up.dot(fromEye) * fromEye).normalized();
}

void SceneCamera::pan(const Eigen::Vector2d& by_px, const Eigen::Vector2d& view_px) {
  const Eigen::Vector2d by_mm = by_px / px_per_mm(view_px);
  focus_lps += -by_mm.x() * right() + by_mm.y() * up;
}

void SceneCamera::zoom(double factor, const Eigen::Vector2d& at_px, const Eigen::Vector2d& view_px) {
  const Eigen::Vector3d held = toLps(at_px, view_px, focus_lps);
  halfHeight_mm = std::clamp(halfHeight_mm / factor, 2.0, 2000.0);
  focus_lps += held - toLps(at_px, view_px, focus_lps);
}

void SceneCamera::fit(const Eigen::AlignedBox3d& box, const Eigen::Vector2d& view_px) {
  if (box.isEmpty() || view_px.minCoeff() <= 0.0) return;
  focus_lps = box.center();
  double across = 1.0, upwards = 1.0;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3d d = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(n)) - focus_lps;
    across = std::max(across, std::abs(d.dot(right())));
    upwards = std::max(upwards, std::abs(d.dot(up)));
  }
  halfHeight_mm = 1.12 * std::max(upwards, across * view_px.y() / view_px.x());
  distance_mm = 4.0 * box.diagonal().norm();
}

namespace {

/// As steeply as a face has to look against the hoist to bear (retraction: findContact).
bool looksAgainst(const anatomy::TriangleMesh& mesh, Eigen::Index t, const Eigen::Vector3d& direction) {
  constexpr double leastCosine = 0.3;
  const Eigen::Vector3d a = mesh.vertices_lps_mm.col(mesh.triangles(0, t));
  const Eigen::Vector3d n =
      (mesh.vertices_lps_mm.col(mesh.triangles(1, t)) - a).cross(mesh.vertices_lps_mm.col(mesh.triangles(2, t)) - a);
  return n.dot(direction) < -leastCosine * n.norm() * direction.norm();
}

}  // namespace

std::optional<Eigen::Vector3d> firstHit(const anatomy::TriangleMesh& mesh, const Eigen::Vector3d& from,
                                        const Eigen::Vector3d& along, const std::optional<Eigen::Vector3d>& against) {
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3d a = mesh.vertices_lps_mm.col(mesh.triangles(0, t));
    const Eigen::Vector3d e1 = mesh.vertices_lps_mm.col(mesh.triangles(1, t)) - a;
    const Eigen::Vector3d e2 = mesh.vertices_lps_mm.col(mesh.triangles(2, t)) - a;
    const Eigen::Vector3d n = along.cross(e2);
    const double det = e1.dot(n);
    if (std::abs(det) < 1e-12 || (against && !looksAgainst(mesh, t, *against))) continue;
    const Eigen::Vector3d s = from - a;
    const double u = s.dot(n) / det;
    if (u < 0.0 || u > 1.0) continue;
    const Eigen::Vector3d q = s.cross(e1);
    const double v = along.dot(q) / det;
    if (v < 0.0 || u + v > 1.0) continue;
    const double far = e2.dot(q) / det;
    if (far > 0.0) nearest = std::min(nearest, far);
  }
  if (!std::isfinite(nearest)) return {};
  return from + nearest * along;
}

std::optional<Eigen::Vector3d> nearestVertex(const anatomy::TriangleMesh& mesh, const Eigen::Vector3d& p_lps,
                                             const std::optional<Eigen::Vector3d>& against) {
  std::optional<Eigen::Vector3d> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    if (against && !looksAgainst(mesh, t, *against)) continue;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d v = mesh.vertices_lps_mm.col(mesh.triangles(c, t));
      if ((v - p_lps).squaredNorm() >= nearest) continue;
      nearest = (v - p_lps).squaredNorm();
      best = v;
    }
  }
  return best;
}

}  // namespace glisson::tools

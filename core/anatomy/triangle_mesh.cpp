// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

namespace glisson::anatomy {

double area_mm2(const TriangleMesh& mesh) {
  double area = 0.0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3d a = mesh.vertices_lps_mm.col(mesh.triangles(0, t));
    const Eigen::Vector3d b = mesh.vertices_lps_mm.col(mesh.triangles(1, t));
    const Eigen::Vector3d c = mesh.vertices_lps_mm.col(mesh.triangles(2, t));
    const Eigen::Vector3d u = b - a, v = c - a;
    const Eigen::Vector3d normal(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                                 u.x() * v.y() - u.y() * v.x());
    area += 0.5 * normal.norm();
  }
  return area;
}

double volume_mm3(const TriangleMesh& mesh) {
  if (mesh.vertices_lps_mm.cols() == 0) return 0.0;
  const Eigen::Vector3d origin = mesh.vertices_lps_mm.col(0);  // near the mesh: keeps digits
  double volume = 0.0;
  Eigen::Matrix3d corners;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int c = 0; c < 3; ++c) corners.col(c) = mesh.vertices_lps_mm.col(mesh.triangles(c, t)) - origin;
    volume += (corners(0, 0) * (corners(1, 1) * corners(2, 2) - corners(2, 1) * corners(1, 2)) -
               corners(0, 1) * (corners(1, 0) * corners(2, 2) - corners(2, 0) * corners(1, 2)) +
               corners(0, 2) * (corners(1, 0) * corners(2, 1) - corners(2, 0) * corners(1, 1))) /
              6.0;
  }
  return volume;
}

void moveToVolume(TriangleMesh& mesh, double wanted_mm3) {
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3Xd normal = Eigen::Matrix3Xd::Zero(3, mesh.vertices_lps_mm.cols());
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      const Eigen::Vector3i v = mesh.triangles.col(t);
      const Eigen::Vector3d a = mesh.vertices_lps_mm.col(v[0]), b = mesh.vertices_lps_mm.col(v[1]),
                            c = mesh.vertices_lps_mm.col(v[2]);
      const Eigen::Vector3d n = (b - a).cross(c - a);
      for (int i = 0; i < 3; ++i) normal.col(v[i]) += n;
    }
    const double offset_mm = (wanted_mm3 - volume_mm3(mesh)) / area_mm2(mesh);
    for (Eigen::Index v = 0; v < normal.cols(); ++v) {
      const double length = normal.col(v).norm();
      if (length > 0.0) mesh.vertices_lps_mm.col(v) += offset_mm / length * normal.col(v);
    }
  }
}

bool isClosed(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> forward, backward;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (int c = 0; c < 3; ++c) {
      const int a = mesh.triangles(c, t), b = mesh.triangles((c + 1) % 3, t);
      if (a == b) return false;
      forward.emplace_back(a, b);
      backward.emplace_back(b, a);
    }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return !forward.empty() && forward == backward && std::adjacent_find(forward.begin(), forward.end()) == forward.end();
}

}  // namespace glisson::anatomy

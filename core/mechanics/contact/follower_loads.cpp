// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/follower_loads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mechanics/contact/contact_setup.h"

namespace glisson::mechanics {

std::vector<std::pair<int, double>> sharesOf(const VoxelMesh& mesh, const Eigen::Vector3d& p_m) {
  std::vector<std::pair<int, double>> shares;
  const auto cell = carrierCell(mesh, p_m);
  if (!cell) return shares;
  const Eigen::Vector3d xi = (p_m.cwiseQuotient(mesh.h_m()) - cell->cast<double>()).cwiseMax(0.0).cwiseMin(1.0);
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3i corner(a & 1, a >> 1 & 1, a >> 2 & 1);
    double w = 1;
    for (int c = 0; c < 3; ++c) w *= corner[c] != 0 ? xi[c] : 1 - xi[c];
    const Eigen::Vector3i at = *cell + corner;
    if (w > 0) shares.emplace_back(mesh.nodeAt(at.x(), at.y(), at.z()), w);
  }
  return shares;
}

namespace {

Eigen::Matrix3d crossed(const Eigen::Vector3d& d) {
  Eigen::Matrix3d m;
  m << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  return m;
}

using Corner = std::array<int, 3>;

/// Edges of faces, and by how much the pressures on both sides differ, Pa.
std::map<std::pair<Corner, Corner>, double> pressureSteps(const VoxelMesh& mesh,
                                                          const std::vector<FollowerFace>& faces) {
  const auto cornerAt = [&](const Eigen::Vector3d& p_m) {
    const Eigen::Vector3i i = p_m.cwiseQuotient(mesh.h_m()).array().round().cast<int>();
    return Corner{i.x(), i.y(), i.z()};
  };
  std::map<std::pair<Corner, Corner>, double> steps;
  for (const FollowerFace& f : faces)
    for (std::size_t c = 0; c < 4; ++c) {
      const Corner a = cornerAt(f.corner_m[c]), b = cornerAt(f.corner_m[(c + 1) % 4]);
      steps[std::minmax(a, b)] += a < b ? f.pressure_Pa : -f.pressure_Pa;
    }
  return steps;
}

}  // namespace

std::optional<PressurePotential> potentialOf(const VoxelMesh& mesh, const std::vector<FollowerFace>& faces,
                                             const std::vector<Fixation>& fixations) {
  double largest_Pa = 0;
  PressurePotential potential;
  for (const FollowerFace& f : faces) {
    if (!f.shear_Pa.isZero(0)) return {};
    largest_Pa = std::max(largest_Pa, std::abs(f.pressure_Pa));
    potential.apex_m += f.corner_m[0] / static_cast<double>(faces.size());
  }
  std::map<int, Fixation> held;
  for (const Fixation& f : fixations) held[f.node] = f;
  const double same_m = 1e-9 * mesh.h_m().minCoeff();
  std::array<std::optional<double>, 3> plane;
  potential.weight.setOnes();
  for (const auto& [edge, step_Pa] : pressureSteps(mesh, faces)) {
    if (std::abs(step_Pa) <= 1e-12 * largest_Pa) continue;
    const auto& [a, b] = edge;
    const auto one = held.find(mesh.nodeAt(a[0], a[1], a[2])), other = held.find(mesh.nodeAt(b[0], b[1], b[2]));
    if (one == held.end() || other == held.end()) return {};
    // The planes of constant coordinates that the edge does not leave: in two of them, or clamped, it does no work.
    int planes = 0, axis = 0;
    double at_m = 0;
    bool clamped = true;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      clamped = clamped && one->second.axis[i] && other->second.axis[i];
      if (!one->second.axis[i] || !other->second.axis[i]) continue;
      const double first_m = a[i] * mesh.h_m()[c] + one->second.value_m[c];
      if (std::abs(first_m - (b[i] * mesh.h_m()[c] + other->second.value_m[c])) > same_m) continue;
      ++planes;
      axis = c;
      at_m = first_m;
    }
    if (clamped || planes > 1) continue;
    if (planes == 0) return {};
    std::optional<double>& known = plane[static_cast<std::size_t>(axis)];
    // Parallel planes cannot all pass through the apex: volume is then not counted along their normal.
    if (known && std::abs(*known - at_m) > same_m) potential.weight[axis] = 0;
    known = at_m;
    potential.apex_m[axis] = at_m;
  }
  if (potential.weight.isZero(0)) return {};
  potential.weight /= potential.weight.sum();
  return potential;
}

Eigen::Vector3d FollowerTriangle::force_N() const {
  const Eigen::Vector3d first = x_m[1] - x_m[0], second = x_m[2] - x_m[0], area = 0.5 * first.cross(second);
  Eigen::Vector3d force = -pressure_Pa * area;
  if (shear_Pa != 0) force += shear_Pa * area.norm() * (along[0] * first + along[1] * second).normalized();
  return force;
}

std::array<Eigen::Matrix3d, 3> FollowerTriangle::stiffness_N_m() const {
  const Eigen::Vector3d first = x_m[1] - x_m[0], second = x_m[2] - x_m[0], area = 0.5 * first.cross(second);
  const Eigen::Vector3d v = along[0] * first + along[1] * second;
  const bool shears = shear_Pa != 0 && area.norm() > 0 && v.norm() > 0;
  std::array<Eigen::Matrix3d, 3> stiffness;
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::Matrix3d ofArea = -0.5 * crossed(x_m[(j + 1) % 3] - x_m[(j + 2) % 3]);
    stiffness[j] = -pressure_Pa * ofArea;
    if (!shears) continue;
    const Eigen::Vector3d d = v.normalized();
    const double share = j == 0 ? -along[0] - along[1] : along[j - 1];
    stiffness[j] += shear_Pa * d * (area.normalized().transpose() * ofArea);
    stiffness[j] += shear_Pa * share * area.norm() / v.norm() * (Eigen::Matrix3d::Identity() - d * d.transpose());
  }
  return stiffness;
}

double FollowerTriangle::volume_m3(const PressurePotential& potential) const {
  const Eigen::Vector3d area = 0.5 * (x_m[1] - x_m[0]).cross(x_m[2] - x_m[0]);
  const Eigen::Vector3d middle = (x_m[0] + x_m[1] + x_m[2]) / 3 - potential.apex_m;
  return potential.weight.cwiseProduct(middle).dot(area);
}

}  // namespace glisson::mechanics

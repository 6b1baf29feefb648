// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>

#include "base/error.h"
#include "retraction/body.h"

namespace glisson::retraction {
namespace {

std::string rounded(double v) {
  return std::to_string(static_cast<int>(std::lround(v)));
}

}  // namespace

void refuseContact(const Eigen::Vector3d& at_mm, double nearest_mm) {
  throw BadInput("no contact: the retractor at (" + rounded(at_mm.x()) + ", " + rounded(at_mm.y()) + ", " +
                 rounded(at_mm.z()) + ") mm is " +
                 (std::isfinite(nearest_mm) ? rounded(nearest_mm) + " mm away from the nearest surface"
                                            : std::string("facing no surface")) +
                 " that looks against its hoist; move it onto the surface");
}

Eigen::Vector3d findHoistPoint(const Body& body, const Retractor& retractor, const Eigen::Vector3d& inferior_mm) {
  const Eigen::Vector3d hoist = retractor.direction.normalized();
  const Eigen::Vector3d axis = (retractor.patchAxis() - retractor.patchAxis().dot(hoist) * hoist).normalized();
  const Eigen::Vector3d across = hoist.cross(axis);
  const Eigen::Vector3d up = across.z() < 0 ? Eigen::Vector3d(-across) : across;
  const double step_mm = 1e3 * body.mesh().h_m().minCoeff();
  constexpr double farthest_mm = 80.0;

  double bestCover = 0.0;
  Eigen::Vector3d best = inferior_mm;
  for (double height = 0.0; height <= farthest_mm; height += step_mm) {
    const Eigen::Vector3d at = inferior_mm + height * up;
    double cover = 0.0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    for (const SurfaceFace& f : body.surface()) {
      const double seen = -f.normal.dot(hoist) * 1e6 * f.area_m2;
      const Eigen::Vector3d d = f.centre_mm - at;
      if (f.cavity || seen <= 0.0 || std::abs(d.dot(axis)) > retractor.length_mm / 2 ||
          std::abs(d.dot(across)) > retractor.diameter_mm / 2)
        continue;
      cover += seen;
      centroid += seen * f.centre_mm;
    }
    if (cover > bestCover) {
      bestCover = cover;
      best = centroid / cover;
    }
    if (cover >= 0.9 * retractor.length_mm * retractor.diameter_mm) break;
  }
  if (bestCover == 0.0)
    throw BadInput(
        "no contact: no surface near the inferior right lobe looks against the hoist; give \"at\" as a point");
  // The centroid of a curved patch may lie inside the body: the nearest face under the bar stands in.
  const SurfaceFace* nearest = nullptr;
  for (const SurfaceFace& f : body.surface())
    if (!f.cavity && f.normal.dot(hoist) < -0.3 &&
        (!nearest || (f.centre_mm - best).squaredNorm() < (nearest->centre_mm - best).squaredNorm()))
      nearest = &f;
  return nearest->centre_mm;
}

Contact findContact(const Body& body, const Retractor& retractor, const Eigen::Vector3d& at_mm) {
  const Eigen::Vector3d hoist = retractor.direction.normalized();
  const Eigen::Vector3d axis = (retractor.patchAxis() - retractor.patchAxis().dot(hoist) * hoist).normalized();
  const Eigen::Vector3d across = hoist.cross(axis);
  // Beyond three standard deviations of the spread the pressure is below 1.2 % of its peak.
  const double reach = 3.0 * retractor.spread_mm;

  // Faces under the bar, steps of the voxel staircase included; only those that look against the hoist bear the force.
  auto bears = [&](const SurfaceFace& f) { return f.normal.dot(hoist) < -0.3; };
  std::vector<const SurfaceFace*> candidates;
  const SurfaceFace* first = nullptr;
  double nearest = 0.0;
  for (const SurfaceFace& f : body.surface()) {
    if (f.cavity || f.normal.dot(hoist) > 0.3) continue;
    const Eigen::Vector3d d = f.centre_mm - at_mm;
    if (bears(f) && (!first || d.norm() < nearest)) {
      first = &f;
      nearest = d.norm();
    }
    if (std::abs(d.dot(axis)) <= retractor.length_mm / 2 + reach &&
        std::abs(d.dot(across)) <= retractor.diameter_mm / 2 + reach)
      candidates.push_back(&f);
  }
  const double cell_mm = 1e3 * body.mesh().h_m().maxCoeff();
  if (!first || nearest > retractor.diameter_mm + cell_mm)
    refuseContact(at_mm, first ? nearest : std::numeric_limits<double>::infinity());
  if (std::find(candidates.begin(), candidates.end(), first) == candidates.end()) candidates.push_back(first);

  // The connected patch around the nearest face: faces that share a node.
  std::unordered_map<int, std::vector<std::size_t>> facesOfNode;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (const int node : candidates[i]->nodes) facesOfNode[node].push_back(i);
  std::vector<bool> taken(candidates.size(), false);
  std::queue<std::size_t> todo;
  const auto start =
      static_cast<std::size_t>(std::find(candidates.begin(), candidates.end(), first) - candidates.begin());
  taken[start] = true;
  todo.push(start);
  while (!todo.empty()) {
    const std::size_t i = todo.front();
    todo.pop();
    for (const int node : candidates[i]->nodes)
      for (const std::size_t next : facesOfNode[node])
        if (!taken[next]) {
          taken[next] = true;
          todo.push(next);
        }
  }

  Contact contact;
  contact.away_mm = nearest;
  double total = 0.0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!taken[i] || !bears(*candidates[i])) continue;
    const SurfaceFace& f = *candidates[i];
    const Eigen::Vector3d d = f.centre_mm - at_mm;
    const double beyondAlong = std::max(0.0, std::abs(d.dot(axis)) - retractor.length_mm / 2);
    const double beyondAcross = std::max(0.0, std::abs(d.dot(across)) - retractor.diameter_mm / 2);
    const double square = beyondAlong * beyondAlong + beyondAcross * beyondAcross;
    double pressure = 1.0;
    if (square > 0.0 && retractor.spread_mm > 0.0)
      pressure = std::exp(-square / (2.0 * retractor.spread_mm * retractor.spread_mm));
    const double share = pressure * f.area_m2 * -f.normal.dot(hoist);
    contact.faces.push_back(&f);
    contact.share.push_back(share);
    contact.centre_mm += share * f.centre_mm;
    contact.area_mm2 += -1e6 * f.area_m2 * f.normal.dot(hoist);
    total += share;
  }
  for (double& s : contact.share) s /= total;
  contact.centre_mm /= total;
  return contact;
}

}  // namespace glisson::retraction

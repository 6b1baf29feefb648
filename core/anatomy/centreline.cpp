// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/centreline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "anatomy/detail/thinning.h"
#include "anatomy/surface_field.h"
#include "image/distance.h"
#include "image/morphology.h"
#include "image/resample.h"

namespace glisson::anatomy {
namespace {

struct Graph {
  std::vector<Eigen::Vector3i> voxels;
  std::vector<std::vector<int>> next;
};

/// Numbers voxels of a grid, over and over without clearing all of it.
class VoxelNumbers {
 public:
  explicit VoxelNumbers(const image::Grid& grid) : number_(grid, -1) {}

  Graph graphOf(const std::vector<Eigen::Vector3i>& voxels) {
    Graph g{voxels, std::vector<std::vector<int>>(voxels.size())};
    for (std::size_t v = 0; v < voxels.size(); ++v) number_.at(voxels[v]) = static_cast<std::int32_t>(v);
    for (std::size_t v = 0; v < voxels.size(); ++v)
      for (int n = 0; n < 27; ++n) {
        const Eigen::Vector3i p = voxels[v] + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        if (n != 13 && number_.grid.contains(p) && number_.at(p) >= 0) g.next[v].push_back(number_.at(p));
      }
    for (const Eigen::Vector3i& p : voxels) number_.at(p) = -1;
    return g;
  }

 private:
  image::LabelMap number_;  ///< −1 between two graphs
};

Graph graphOf(const image::Mask& line) {
  return VoxelNumbers(line.grid).graphOf(voxelsOf(line));
}

/// Cuts the shortest side branch that ends inside the tube it leaves; true where one was cut. One at a time, so that of
/// the two prongs at a blunt end the longer one stays as the end.
bool prune(image::Mask& line, std::vector<Eigen::Vector3i>& voxels, VoxelNumbers& numbers,
           const image::ScalarVolume& depth_mm) {
  const Graph g = numbers.graphOf(voxels);
  std::vector<int> shortest;
  double shortest_mm = 1e300;
  for (std::size_t end = 0; end < g.voxels.size(); ++end) {
    if (g.next[end].size() != 1) continue;
    std::vector<int> branch{static_cast<int>(end)};
    int before = static_cast<int>(end), at = g.next[end][0];
    while (g.next[static_cast<std::size_t>(at)].size() == 2) {
      branch.push_back(at);
      const auto& pair = g.next[static_cast<std::size_t>(at)];
      const int onward = pair[0] == before ? pair[1] : pair[0];
      before = at;
      at = onward;
    }
    const auto root = static_cast<std::size_t>(at);
    if (g.next[root].size() < 3) continue;  // a line of its own
    const double reach_mm = (g.voxels[root] - g.voxels[end]).cast<double>().cwiseProduct(line.grid.spacing_mm).norm();
    // The depth of a voxel solid is up to a voxel too small.
    const double radius_mm = static_cast<double>(depth_mm.at(g.voxels[root])) + line.grid.spacing_mm.minCoeff();
    if (reach_mm >= 1.5 * radius_mm || reach_mm >= shortest_mm) continue;
    shortest_mm = reach_mm;
    shortest = std::move(branch);
  }
  if (shortest.empty()) return false;
  for (const int v : shortest) line.at(g.voxels[static_cast<std::size_t>(v)]) = 0;
  std::erase_if(voxels, [&](const Eigen::Vector3i& p) { return line.at(p) == 0; });
  thin(line, voxels);  // the root may have become a corner that thinning takes away
  return true;
}

/// Ends run into a corner of a blunt tip: voxels there that are less than 0.6 times as deep as the tube within two
/// radii of the tip are taken off.
void trimEnds(image::Mask& line, const image::ScalarVolume& depth_mm) {
  const Graph g = graphOf(line);
  for (std::size_t end = 0; end < g.voxels.size(); ++end) {
    if (g.next[end].size() != 1) continue;
    std::vector<std::size_t> path{end};
    double deepest_mm = static_cast<double>(depth_mm.at(g.voxels[end])), way_mm = 0.0;
    int before = -1, at = static_cast<int>(end);
    while (way_mm < 2.0 * deepest_mm + line.grid.spacing_mm.minCoeff()) {
      const std::vector<int>& next = g.next[static_cast<std::size_t>(at)];
      if (next.size() > 2 || (at != static_cast<int>(end) && next.size() != 2)) break;
      const int onward = next[0] == before ? next.back() : next[0];
      way_mm += (g.voxels[static_cast<std::size_t>(onward)] - g.voxels[static_cast<std::size_t>(at)])
                    .cast<double>()
                    .cwiseProduct(line.grid.spacing_mm)
                    .norm();
      before = at;
      at = onward;
      path.push_back(static_cast<std::size_t>(at));
      deepest_mm = std::max(deepest_mm, static_cast<double>(depth_mm.at(g.voxels[path.back()])));
    }
    for (const std::size_t v : path) {
      if (static_cast<double>(depth_mm.at(g.voxels[v])) >= 0.6 * deepest_mm) break;
      line.at(g.voxels[v]) = 0;
    }
  }
}

/// Radius of the tube at p across the line: median over 16 rays of the way to where the mask, interpolated between
/// voxel centres, falls to one half. The depth of the voxel solid would be too small by the height of its steps.
double radiusAt(const Eigen::Vector3d& p_lps, const Eigen::Vector3d& along, const image::ScalarVolume& inside,
                double depth_mm) {
  const Eigen::Vector3d u = along.unitOrthogonal(), v = along.cross(u);
  const double step_mm = 0.25 * inside.grid.spacing_mm.minCoeff(), farthest_mm = 3.0 * depth_mm + 4.0 * step_mm;
  std::array<double, 16> way_mm{};
  for (std::size_t r = 0; r < way_mm.size(); ++r) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(r) / static_cast<double>(way_mm.size());
    const Eigen::Vector3d ray = std::cos(angle) * u + std::sin(angle) * v;
    double before = static_cast<double>(image::sampleLinear(inside, p_lps, 0.0F)), at_mm = 0.0;
    while (before > 0.5 && at_mm < farthest_mm) {
      const double next = static_cast<double>(image::sampleLinear(inside, p_lps + (at_mm + step_mm) * ray, 0.0F));
      if (next <= 0.5) {
        at_mm += step_mm * (before - 0.5) / (before - next);
        break;
      }
      at_mm += step_mm;
      before = next;
    }
    way_mm[r] = at_mm;
  }
  std::sort(way_mm.begin(), way_mm.end());
  return std::max(0.5 * inside.grid.spacing_mm.minCoeff(), 0.5 * (way_mm[7] + way_mm[8]));
}

/// Position moved across the line to where the tube is deepest, by at most one voxel.
Eigen::Vector3d centred(const Eigen::Vector3d& p_lps, const Eigen::Vector3d& along,
                        const image::ScalarVolume& depth_mm) {
  const Eigen::Vector3d u = along.unitOrthogonal(), v = along.cross(u);
  const double h_mm = depth_mm.grid.spacing_mm.minCoeff();
  // Centroid of depth squared over a disk: smooth where the deepest place is a plateau.
  const double radius_mm = std::max(h_mm, 0.8 * static_cast<double>(image::sampleLinear(depth_mm, p_lps, 0.0F)));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (int a = -4; a <= 4; ++a)
    for (int b = -4; b <= 4; ++b) {
      if (a * a + b * b > 16) continue;
      const Eigen::Vector3d offset = radius_mm / 4.0 * (a * u + b * v);
      const double d = std::max(0.0, static_cast<double>(image::sampleLinear(depth_mm, p_lps + offset, 0.0F)));
      sum += d * d * offset;
      weight += d * d;
    }
  if (weight <= 0.0) return p_lps;
  Eigen::Vector3d shift = sum / weight;
  if (shift.norm() > h_mm) shift *= h_mm / shift.norm();
  return p_lps + shift;
}

/// Within a radius of a blunt tip the skeleton bends into one of its corners: those points are put onto the straight
/// line of the five points before them.
void straightenEnds(const Graph& g, const image::ScalarVolume& depth_mm, Centreline& line) {
  constexpr std::size_t before = 5, looked = 24;
  std::vector<Eigen::Vector3d> moved = line.points_lps_mm;
  for (std::size_t end = 0; end < g.next.size(); ++end) {
    if (g.next[end].size() != 1) continue;
    std::vector<std::size_t> path{end, static_cast<std::size_t>(g.next[end][0])};
    while (path.size() < looked && g.next[path.back()].size() == 2) {
      const auto a = static_cast<std::size_t>(g.next[path.back()][0]);
      const auto b = static_cast<std::size_t>(g.next[path.back()][1]);
      path.push_back(a == path[path.size() - 2] ? b : a);
    }
    double deepest_mm = 0.0;
    for (const std::size_t v : path) deepest_mm = std::max(deepest_mm, static_cast<double>(depth_mm.at(g.voxels[v])));
    std::size_t bent = 0;
    for (double way_mm = 0.0; way_mm < deepest_mm && bent + 1 < path.size(); ++bent)
      way_mm += (line.points_lps_mm[path[bent + 1]] - line.points_lps_mm[path[bent]]).norm();
    if (bent + before >= path.size()) continue;
    const Eigen::Vector3d& from = line.points_lps_mm[path[bent]];
    const Eigen::Vector3d along = (from - line.points_lps_mm[path[bent + before]]).normalized();
    for (std::size_t i = 0; i < bent; ++i)
      moved[path[i]] = from + (line.points_lps_mm[path[i]] - from).dot(along) * along;
  }
  line.points_lps_mm = std::move(moved);
}

/// The same body on an isotropic lattice, interpolated by shape (see surface.h): thinning counts voxels, not mm.
image::Mask isotropic(const image::Mask& mask) {
  const SurfaceField field = surfaceField(mask, mask.grid.spacing_mm.minCoeff());
  image::Mask result(field.values_mm.grid);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = static_cast<double>(field.values_mm.values[i]) > field.level_mm ? 1 : 0;
  return result;
}

}  // namespace

Centreline centrelineOf(const image::Mask& original) {
  Centreline result;
  if (image::count(original) == 0) return result;
  const bool even = original.grid.spacing_mm.maxCoeff() <= 1.25 * original.grid.spacing_mm.minCoeff();
  const image::Mask mask = even ? original : isotropic(original);
  const image::ScalarVolume depth_mm = image::distanceToBoundary_mm(mask);
  image::Mask line = mask;
  std::vector<Eigen::Vector3i> voxels = voxelsOf(mask);
  thin(line, voxels);
  VoxelNumbers numbers(line.grid);
  while (prune(line, voxels, numbers, depth_mm)) {
  }
  trimEnds(line, depth_mm);
  const Graph g = graphOf(line);
  for (const Eigen::Vector3i& v : g.voxels) result.points_lps_mm.push_back(mask.grid.indexToLps(v.cast<double>()));
  for (std::size_t v = 0; v < g.next.size(); ++v)
    for (const int n : g.next[v])
      if (static_cast<int>(v) < n) result.edges.push_back({static_cast<int>(v), n});
  for (int round = 0; round < 3; ++round) {
    std::vector<Eigen::Vector3d> moved = result.points_lps_mm;
    for (std::size_t v = 0; v < moved.size(); ++v) {
      if (g.next[v].size() != 2) continue;  // ends and forks stay
      const Eigen::Vector3d &a = result.points_lps_mm[static_cast<std::size_t>(g.next[v][0])],
                            &b = result.points_lps_mm[static_cast<std::size_t>(g.next[v][1])];
      const Eigen::Vector3d middle = 0.5 * result.points_lps_mm[v] + 0.25 * (a + b);
      const Eigen::Vector3d chord = b - a;
      moved[v] = chord.norm() > 0.0 ? centred(middle, chord.normalized(), depth_mm) : middle;
    }
    result.points_lps_mm = std::move(moved);
  }
  straightenEnds(g, depth_mm, result);
  image::ScalarVolume inside(mask.grid);
  for (std::size_t i = 0; i < inside.values.size(); ++i) inside.values[i] = mask.values[i] != 0 ? 1.0F : 0.0F;
  for (std::size_t v = 0; v < result.points_lps_mm.size(); ++v) {
    const Eigen::Vector3d& p = result.points_lps_mm[v];
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    if (!g.next[v].empty())
      along = result.points_lps_mm[static_cast<std::size_t>(g.next[v].back())] -
              (g.next[v].size() > 1 ? result.points_lps_mm[static_cast<std::size_t>(g.next[v].front())] : p);
    if (along.norm() < 1e-9) along = Eigen::Vector3d::UnitZ();
    const double depth = std::max(0.0, static_cast<double>(image::sampleLinear(depth_mm, p, 0.0F)));
    result.radius_mm.push_back(radiusAt(p, along.normalized(), inside, depth));
  }
  return result;
}

}  // namespace glisson::anatomy

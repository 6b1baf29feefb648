// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/mesh_quality.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <vector>

#include "base/error.h"

namespace glisson::anatomy {
namespace {

// Faces counter-clockwise from outside; the opposite corner is the one not named.
constexpr std::array<std::array<int, 3>, 4> faces = {{{{1, 2, 3}}, {{0, 3, 2}}, {{0, 1, 3}}, {{0, 2, 1}}}};

}  // namespace

MeshQuality qualityOf(const Eigen::Matrix3Xd& points, const Eigen::Matrix4Xi& cells) {
  if (cells.cols() == 0) throw BadArgument("a mesh without cells has no quality");
  if (cells.minCoeff() < 0 || cells.maxCoeff() >= points.cols())
    throw BadArgument("a cell names a point that is not there");
  MeshQuality q;
  q.leastDihedral_deg = 180.0;
  q.shortestEdge_mm = std::numeric_limits<double>::infinity();
  for (Eigen::Index c = 0; c < cells.cols(); ++c) {
    std::array<Eigen::Vector3d, 4> x;
    for (int v = 0; v < 4; ++v) x[static_cast<std::size_t>(v)] = points.col(cells(v, c));
    double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) {
        longest = std::max(longest, (x[a] - x[b]).norm());
        shortest = std::min(shortest, (x[a] - x[b]).norm());
      }
    q.longestEdge_mm = std::max(q.longestEdge_mm, longest);
    q.shortestEdge_mm = std::min(q.shortestEdge_mm, shortest);
    Eigen::Matrix3d edges;
    edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
    const double volume = edges.determinant() / 6.0;
    q.volume_mm3 += volume;
    if (!(volume > 1e-9 * longest * longest * longest)) {
      ++q.flatOrInverted;
      q.leastDihedral_deg = 0.0;
      q.largestDihedral_deg = 180.0;
      q.worstRadiusEdge = std::numeric_limits<double>::infinity();
      continue;
    }
    // The circumcentre lies where 2 (x_i − x_0) · c = |x_i − x_0|².
    const Eigen::Vector3d centre = (2.0 * edges.transpose()).inverse() * edges.colwise().squaredNorm().transpose();
    q.worstRadiusEdge = std::max(q.worstRadiusEdge, centre.norm() / shortest);
    std::array<Eigen::Vector3d, 4> normal;
    for (std::size_t f = 0; f < 4; ++f) {
      const auto corner = [&](std::size_t i) { return x[static_cast<std::size_t>(faces[f][i])]; };
      normal[f] = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    }
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) {
        const double angle = std::numbers::pi - std::atan2(normal[a].cross(normal[b]).norm(), normal[a].dot(normal[b]));
        q.leastDihedral_deg = std::min(q.leastDihedral_deg, angle * 180.0 / std::numbers::pi);
        q.largestDihedral_deg = std::max(q.largestDihedral_deg, angle * 180.0 / std::numbers::pi);
      }
  }
  return q;
}

Eigen::Matrix3Xi boundaryOf(const Eigen::Matrix4Xi& cells) {
  std::map<std::array<int, 3>, int> times;
  const auto key = [&](Eigen::Index c, std::size_t f) {
    std::array<int, 3> k = {cells(faces[f][0], c), cells(faces[f][1], c), cells(faces[f][2], c)};
    std::sort(k.begin(), k.end());
    return k;
  };
  for (Eigen::Index c = 0; c < cells.cols(); ++c)
    for (std::size_t f = 0; f < 4; ++f)
      if (++times[key(c, f)] > 2) throw BadArgument("three cells share a triangle");
  std::vector<Eigen::Vector3i> open;
  for (Eigen::Index c = 0; c < cells.cols(); ++c)
    for (std::size_t f = 0; f < 4; ++f)
      if (times[key(c, f)] == 1) open.emplace_back(cells(faces[f][0], c), cells(faces[f][1], c), cells(faces[f][2], c));
  Eigen::Matrix3Xi result(3, static_cast<Eigen::Index>(open.size()));
  for (std::size_t t = 0; t < open.size(); ++t) result.col(static_cast<Eigen::Index>(t)) = open[t];
  return result;
}

std::string describe(const MeshQuality& q, int cells) {
  std::ostringstream text;
  text.precision(3);
  text << cells << " cells, dihedral angles " << q.leastDihedral_deg << " to " << q.largestDihedral_deg
       << " degrees, circumradius over shortest edge at most " << q.worstRadiusEdge << ", edges " << q.shortestEdge_mm
       << " to " << q.longestEdge_mm << " mm";
  return text.str();
}

}  // namespace glisson::anatomy

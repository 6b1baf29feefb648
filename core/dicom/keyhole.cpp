// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/keyhole.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace glisson::dicom {
namespace {

using Ring = Eigen::Matrix2Xd;

constexpr double planeTolerance_mm = 0.01;

/// Newell's normal, not normalised; its length is twice the area.
Eigen::Vector3d areaNormal(const Eigen::Matrix3Xd& p) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (Eigen::Index n = 0; n < p.cols(); ++n)
    normal += (p.col(n) - p.col(0)).cross(p.col((n + 1) % p.cols()) - p.col(0));
  return normal;
}

bool inside(const Ring& ring, const Eigen::Vector2d& q) {
  bool odd = false;
  for (Eigen::Index n = 0; n < ring.cols(); ++n) {
    const Eigen::Vector2d a = ring.col(n), b = ring.col((n + 1) % ring.cols());
    if ((a.y() > q.y()) != (b.y() > q.y()) && q.x() < a.x() + (q.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y()))
      odd = !odd;
  }
  return odd;
}

bool contains(const Ring& outer, const Ring& inner) {
  for (Eigen::Index n = 0; n < inner.cols(); ++n)
    if (!inside(outer, inner.col(n))) return false;
  return true;
}

/// outer up to its vertex nearest to hole, once round hole, and on.
Eigen::Matrix3Xd joined(const Eigen::Matrix3Xd& outer, Eigen::Matrix3Xd hole) {
  if (areaNormal(outer).dot(areaNormal(hole)) > 0.0) hole = hole.rowwise().reverse().eval();
  Eigen::Index from = 0, to = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index a = 0; a < outer.cols(); ++a)
    for (Eigen::Index b = 0; b < hole.cols(); ++b) {
      const double d = (outer.col(a) - hole.col(b)).squaredNorm();
      if (d < nearest) {
        nearest = d;
        from = a;
        to = b;
      }
    }
  Eigen::Matrix3Xd all(3, outer.cols() + hole.cols() + 2);
  Eigen::Index n = 0;
  for (Eigen::Index a = 0; a <= from; ++a) all.col(n++) = outer.col(a);
  for (Eigen::Index b = 0; b <= hole.cols(); ++b) all.col(n++) = hole.col((to + b) % hole.cols());
  for (Eigen::Index a = from; a < outer.cols(); ++a) all.col(n++) = outer.col(a);
  return all;
}

}  // namespace

std::vector<StructureContour> withKeyholes(const std::vector<StructureContour>& contours) {
  const std::size_t count = contours.size();
  std::vector<Eigen::Vector3d> normals;
  for (const StructureContour& c : contours) normals.push_back(areaNormal(c.points_lps_mm).normalized());
  std::vector<std::vector<std::size_t>> holders(count);  // contours around each one
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b) {
      if (a == b || !normals[a].allFinite() || std::abs(normals[a].dot(normals[b])) < 0.999) continue;
      const Eigen::Vector3d offset = contours[b].points_lps_mm.col(0) - contours[a].points_lps_mm.col(0);
      if (std::abs(offset.dot(normals[a])) > planeTolerance_mm) continue;
      Eigen::Matrix<double, 2, 3> axes;
      axes.row(0) = normals[a].unitOrthogonal().transpose();
      axes.row(1) = normals[a].cross(axes.row(0).transpose()).transpose();
      if (contains(axes * contours[a].points_lps_mm, axes * contours[b].points_lps_mm)) holders[b].push_back(a);
    }
  std::vector<StructureContour> result;
  std::vector<std::size_t> place(count, count);
  for (std::size_t n = 0; n < count; ++n)
    if (holders[n].size() % 2 == 0) {
      place[n] = result.size();
      result.push_back(contours[n]);
    }
  for (std::size_t n = 0; n < count; ++n) {
    if (holders[n].size() % 2 == 0) continue;
    // The innermost of those around it is the one with as many around itself, less one.
    std::size_t outer = count;
    for (const std::size_t h : holders[n])
      if (holders[h].size() + 1 == holders[n].size() && place[h] != count) outer = h;
    if (outer == count)
      result.push_back(contours[n]);
    else
      result[place[outer]].points_lps_mm = joined(result[place[outer]].points_lps_mm, contours[n].points_lps_mm);
  }
  return result;
}

}  // namespace glisson::dicom

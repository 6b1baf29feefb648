// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glisson::tools {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double area = cross(b - a, c - a);
  return (area > 0.0) - (area < 0.0);
}

bool between(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
}

bool segmentsMeet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  const Eigen::Vector2d& d) {
  const int abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(c, a, b)) || (abd == 0 && between(d, a, b)) || (cda == 0 && between(a, c, d)) ||
         (cdb == 0 && between(b, c, d));
}

}  // namespace

double distanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

bool inside(const Eigen::Vector2d& p, const Outline& outline) {
  bool in = false;
  const Eigen::Index n = outline.cols();
  for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
    const Eigen::Vector2d a = outline.col(i), b = outline.col(j);
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      in = !in;
  }
  return in;
}

double signedArea(const Outline& outline) {
  double twice = 0.0;
  const Eigen::Index n = outline.cols();
  for (Eigen::Index i = 0; i < n; ++i) twice += cross(outline.col(i), outline.col((i + 1) % n));
  return 0.5 * twice;
}

bool crossesItself(const Outline& outline, bool closed) {
  const Eigen::Index n = outline.cols();
  const Eigen::Index edges = closed ? n : n - 1;
  for (Eigen::Index i = 0; i < edges; ++i)
    for (Eigen::Index j = i + 2; j < edges; ++j) {
      if (closed && i == 0 && j == n - 1) continue;  // neighbours around the end
      if (segmentsMeet(outline.col(i), outline.col((i + 1) % n), outline.col(j), outline.col((j + 1) % n))) return true;
    }
  return false;
}

int distinctPoints(const Outline& outline, double tolerance) {
  int distinct = 0;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    bool seen = false;
    for (Eigen::Index j = 0; j < i && !seen; ++j) seen = (outline.col(i) - outline.col(j)).norm() <= tolerance;
    if (!seen) ++distinct;
  }
  return distinct;
}

std::vector<Eigen::Index> simplify(const Outline& line, double tolerance) {
  const Eigen::Index n = line.cols();
  std::vector<Eigen::Index> kept;
  if (n == 0) return kept;
  std::vector<char> keep(static_cast<std::size_t>(n), 0);
  keep.front() = keep.back() = 1;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double worst = tolerance;
    Eigen::Index at = -1;
    for (Eigen::Index i = first + 1; i < last; ++i) {
      const double d = distanceToSegment(line.col(i), line.col(first), line.col(last));
      if (d > worst) worst = d, at = i;
    }
    if (at < 0) continue;
    keep[static_cast<std::size_t>(at)] = 1;
    open.emplace_back(first, at);
    open.emplace_back(at, last);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    if (keep[static_cast<std::size_t>(i)]) kept.push_back(i);
  return kept;
}

}  // namespace glisson::tools

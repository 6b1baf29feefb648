// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glisson::tools {

/// Plane geometry of outlines. Points are 2 × n, any one unit; an outline is closed from its last point to its first.
using Outline = Eigen::Matrix2Xd;

/// Distance from p to the segment a-b.
double distanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Even-odd inclusion.
bool inside(const Eigen::Vector2d& p, const Outline& outline);

/// Signed area: positive where x turns towards y.
double signedArea(const Outline& outline);

/// Whether two edges that share no vertex cross or touch. closed: the edge from the last point to the first counts too.
bool crossesItself(const Outline& outline, bool closed);

/// Number of points that differ from every earlier one by more than tolerance.
int distinctPoints(const Outline& outline, double tolerance);

/// Indices of the points kept by Douglas-Peucker's rule on the open line: every point left out lies within tolerance of
/// the line that is kept. The ends stay.
std::vector<Eigen::Index> simplify(const Outline& line, double tolerance);

}  // namespace glisson::tools

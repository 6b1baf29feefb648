// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "tools/outline.h"

namespace glisson::tools {

/// Closed outlines changed as a whole. Points are 3 × n, LPS mm; indices refer to columns.

/// A vertex in the middle of every edge whose ends are both chosen. chosen: ascending order is not needed.
Eigen::Matrix3Xd withHalvedEdges(const Eigen::Matrix3Xd& points, const std::vector<Eigen::Index>& chosen);

/// The two vertices a cut runs between: exactly two chosen ones that are no neighbours. Ascending.
std::optional<std::pair<Eigen::Index, Eigen::Index>> cutBetween(Eigen::Index n,
                                                                const std::vector<Eigen::Index>& chosen);

/// Both parts of the outline on either side of the chord a–b (a < b), each with both ends of the chord.
std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> cut(const Eigen::Matrix3Xd& points, Eigen::Index a, Eigen::Index b);

/// A disc that pushes the outline away: no point and no edge stays nearer to the centre than the radius. Where the
/// outline runs within reach of the disc it is first given vertices every step, so that it bends smoothly; vertices
/// out of reach stay as they are to the last bit. All in one unit (mm in the plane).
Outline pushed(const Outline& outline, const Eigen::Vector2d& centre, double radius, double step);

}  // namespace glisson::tools
